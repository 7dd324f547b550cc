"""How long a search may take: what has run out of it ends with what was found so far."""

from __future__ import annotations

from collections.abc import Sequence
import math
import time

from tendon_ros.identify.candidate import Candidate

#: [s] that a diagnosis may take: most take one or two minutes; guesses of many bodies, and loops
#: that shake, take more
USUAL = 600.0
#: part of it that the search may: what it has found must be weighed, too; and in which it looks
#: for causes: a cause that nobody was tried in the place of is not named
SEARCHES, LOOKS = 0.7, 0.35
#: part of it in which it looks for what foretells more of a machine, of which little is named
FORETELLS = 0.5


class Patience:
    """
    Runs out before a diagnosis has taken its time.

    :param seconds: that the diagnosis may take from now on; endless by default.
    """

    def __init__(self, seconds: float = math.inf) -> None:
        self._seconds = seconds
        self._began = time.monotonic()
        self._cut = self._unasked = self._short = False

    @property
    def late(self) -> bool:
        """Whether no more causes are to be looked for, so that those found can be challenged."""
        self._short |= self._past(LOOKS)
        return self._short

    @property
    def half(self) -> bool:
        """Whether nothing more is to be looked for by which a machine is foretold better."""
        gone = self._past(FORETELLS)
        self._short |= gone
        return gone

    @property
    def over(self) -> bool:
        """Whether it has run out: whoever asks leaves out then what would have come next."""
        self._cut |= self._past(SEARCHES)
        return self._cut

    @property
    def ended(self) -> bool:
        """Whether all of the time is up: what has an answer keeps it, what has none stays open."""
        self._unasked |= self._past(1.0)
        return self._unasked

    def _past(self, part: float) -> bool:
        """Return whether a part of the time is up."""
        return time.monotonic() > self._began + part * self._seconds

    def words(self, unmet: Sequence[Candidate]) -> list[str]:
        """
        Return what was left out since it had run out.

        :param unmet: causes that nobody was tried in the place of.
        :return: sentences; none where nothing was left out.
        """
        minutes = self._seconds / 60.0
        unasked = [
            'what would separate the less probable of these causes from others was not looked '
            f'for, so as to take no more than {minutes:.3g} min'
        ] * self._unasked
        if not (self._cut or self._short):
            return unasked
        told = f'the search for causes was cut short, so as to take no more than {minutes:.3g} min'
        if unmet:
            names = ', '.join(f'{c.effect} at {c.place}' for c in unmet)
            told += f', before others were tried in the place of {names}: not named for that'
        return [f'{told}. A longer limit (--minutes) lets it come to its end.', *unasked]
