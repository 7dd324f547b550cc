"""What a page is made of beside prose, pictures and tables: drawn by the browser, as real text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol

#: what something means for the reader: it colours text, bars and edges
Tone = Literal['', 'good', 'fair', 'bad', 'before', 'after', 'pale', 'level']


class Block(Protocol):
    """Anything that stands below a heading; ``kind`` tells the template what it is."""

    @property
    def kind(self) -> str:
        """Return the name of the template's part that shows it."""
        ...


@dataclass(frozen=True)
class Bar:
    """
    A bar with its label and number above it.

    ``value``, and where given ``behind`` (a paler bar behind it), ``level`` (a tick) and ``span``
    (an interval), are in one unit of the reader's choice; ``note`` stands below.
    """

    label: str
    value: float
    text: str
    note: str = ''
    tone: Tone = ''
    behind: float | None = None
    level: float | None = None
    span: tuple[float, float] | None = None


@dataclass(frozen=True)
class Bars:
    """Bars on one scale from zero to ``full``; ``legend`` names the tones that it uses."""

    kind: ClassVar = 'bars'
    title: str
    rows: tuple[Bar, ...]
    full: float
    caption: str = ''
    legend: tuple[tuple[Tone, str], ...] = ()

    def part(self, value: float) -> str:
        """Return a value as a percentage of the scale, for a style sheet."""
        return f'{100.0 * min(max(value / self.full, 0.0), 1.0):.2f}%'


@dataclass(frozen=True)
class HeatMap:
    """
    Shares as shades: rows and columns with ``values`` in 0 to 1, shape (rows, columns).

    ``texts`` of the same shape stand in the cells, ``ends`` at the end of each row.
    """

    kind: ClassVar = 'heat'
    title: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    values: tuple[tuple[float, ...], ...]
    texts: tuple[tuple[str, ...], ...]
    ends: tuple[str, ...] = ()
    caption: str = ''

    def shade(self, value: float) -> str:
        """Return how opaque a cell is: the largest value is the darkest."""
        most = max((max(row, default=0.0) for row in self.values), default=0.0)
        return f'{0.05 + 0.75 * value / most if value > 0.0 else 0.0:.3f}'


@dataclass(frozen=True)
class Columns:
    """Blocks beside each other where the screen is wide, below each other where it is not."""

    kind: ClassVar = 'columns'
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Card:
    """A frame with a heading, a ``badge`` in its corner and blocks in it."""

    kind: ClassVar = 'card'
    title: str
    badge: str
    blocks: tuple[Block, ...]
    tone: Tone = ''


@dataclass(frozen=True)
class Details:
    """Blocks that are folded away until the reader opens them."""

    kind: ClassVar = 'details'
    summary: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Listing:
    """Short texts, each on its own line."""

    kind: ClassVar = 'listing'
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Tile:
    """One answer in a few words, leading to the section with that anchor."""

    question: str
    answer: str
    text: str
    anchor: str


@dataclass(frozen=True)
class Banner:
    """What the page says, before all else."""

    label: str
    headline: str
    text: str
    tone: Tone
    tiles: Sequence[Tile] = ()
    doubts: Sequence[str] = ()
