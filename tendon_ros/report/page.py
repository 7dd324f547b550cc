"""
Pages: sections of text, pictures and tables as data, made into one HTML file.

The file is self-contained: pictures are inside it, nothing is fetched, no script runs. It follows
the reader's choice of dark or light, and on a phone a row of a table becomes a card.
"""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

from jinja2 import Environment, PackageLoader, StrictUndefined

from tendon_ros.base.errors import TendonError
from tendon_ros.report.blocks import Banner, Block


class ReportError(TendonError):
    """A report that cannot be written where it should be."""


@dataclass(frozen=True)
class Prose:
    """A paragraph of plain text."""

    kind: ClassVar = 'prose'
    text: str


@dataclass(frozen=True)
class Picture:
    """
    A PNG: ``alt`` says what it shows to whom cannot see it, ``caption`` stands below it.

    ``dark`` is the same picture for readers who chose dark pages, where it was drawn.
    """

    kind: ClassVar = 'picture'
    png: bytes
    alt: str
    caption: str = ''
    dark: bytes = b''

    @property
    def uri(self) -> str:
        """The picture itself as an address."""
        return _uri(self.png)

    @property
    def dark_uri(self) -> str:
        """The dark picture as an address, empty where there is none."""
        return _uri(self.dark) if self.dark else ''


@dataclass(frozen=True)
class Table:
    """
    A table of text.

    ``marks``: one a row, or none at all; ``marked`` is the column whose text takes their colour.
    ``wraps``: whether text of the first column may break into lines.
    """

    kind: ClassVar = 'table'
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ''
    marks: tuple[Literal['good', 'bad', ''], ...] = ()
    marked: int = -1
    wraps: bool = False


@dataclass(frozen=True)
class Section:
    """A heading and what stands below it; ``anchor`` is a name for links to it."""

    title: str
    blocks: tuple[Block, ...]
    anchor: str = ''


@dataclass(frozen=True)
class Page:
    """A whole page; ``lead`` are the paragraphs at its top, ``banner`` what it has to say."""

    title: str
    lead: tuple[str, ...]
    sections: tuple[Section, ...]
    footer: str = ''
    banner: Banner | None = None


def html(page: Page) -> str:
    """
    Return a page as HTML.

    :param page: what it shows; its texts are escaped.
    :return: the text of a self-contained file.
    """
    environment = Environment(
        loader=PackageLoader('tendon_ros.report', 'templates'),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    return environment.get_template('page.html.j2').render(page=page)


def markdown(table: Table) -> str:
    """
    Return a table as Markdown.

    :param table: the table; its caption and marks are left out.
    :return: lines, ending in a newline.
    """
    lines = (table.header, ('---',) * len(table.header), *table.rows)
    cells = ([cell.replace('|', r'\|') for cell in line] for line in lines)
    return ''.join(f'| {" | ".join(line)} |\n' for line in cells)


def _uri(png: bytes) -> str:
    return f'data:image/png;base64,{b64encode(png).decode("ascii")}'


def write(path: Path, content: str | bytes) -> None:
    """
    Write a file of a report, with the folders above it.

    :param path: the file.
    :param content: text or bytes.
    :raises ReportError: where it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise ReportError(
            f'{path}: cannot be written ({error.strerror}); name a folder that can be'
        ) from None
