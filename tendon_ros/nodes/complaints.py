"""Warnings about bad input that come five hundred times a second: said once, then counted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

#: how long complaints of a kind are only counted after one was said [s]
QUIET = 5.0


@dataclass
class _Kind:
    total: int = 0
    unsaid: int = 0
    said_at: float = float('-inf')
    last: str = ''
    fresh: bool = False


class Complaints:
    """
    Counts complaints by kind, and says each kind at most every :data:`QUIET` seconds.

    :param say: what a sentence is given to.
    """

    def __init__(self, say: Callable[[str], object]) -> None:
        self._say = say
        self._kinds: dict[str, _Kind] = {}

    def add(self, kind: str, text: str, now: float) -> None:
        """
        Take in one complaint.

        :param kind: its kind, for instance ``refused commands``.
        :param text: the sentence.
        :param now: a steady clock [s].
        """
        known = self._kinds.setdefault(kind, _Kind())
        known.total += 1
        known.last = text
        known.fresh = True
        if now - known.said_at < QUIET:
            known.unsaid += 1
            return
        more = f' ({known.unsaid} more since the last warning)' if known.unsaid else ''
        self._say(f'{text}{more}')
        known.said_at = now
        known.unsaid = 0

    def counts(self) -> Mapping[str, int]:
        """Return how many complaints of each kind there were."""
        return {kind: known.total for kind, known in self._kinds.items()}

    def recent(self) -> str:
        """Return the last complaint since this was asked before; empty for none."""
        text = ''
        for known in self._kinds.values():
            if known.fresh:
                text = known.last
            known.fresh = False
        return text
