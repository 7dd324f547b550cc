"""
How much a search may do: what has run out of it ends with what was found so far.

It is counted in steps of the model, not by the clock: the same recordings and file give the same
answer on a busy machine as on a quiet one.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import time

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.effort import Effort

#: [s] that a diagnosis may take of so many cores: most take one or two minutes; guesses of many
#: bodies, and loops that shake, take more
USUAL, CORES = 600.0, 2
#: times as long by the clock after which it ends all the same: one core takes twice as long
BY_CLOCK = 3.0
#: part of it that the search may: what it has found must be weighed, too; and in which it looks
#: for causes: a cause that nobody was tried in the place of is not named
SEARCHES, LOOKS = 0.8, 0.35
#: part of it in which it looks for what foretells more of a machine, of which little is named
FORETELLS = 0.6


class Patience:
    """
    Runs out before a diagnosis has taken its time.

    :param seconds: of two cores that the diagnosis may take from now on; endless by default.
    :param effort: that counts what it takes; the clock alone where None.
    """

    def __init__(self, seconds: float = math.inf, effort: Effort | None = None) -> None:
        self._seconds = seconds
        self._effort = effort or Effort()
        self._spent = self._effort.seconds
        self._began = time.monotonic()
        self._cut = self._unasked = self._short = self._clocked = False

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
        """Return whether a part of what it may take is spent."""
        allowed = part * self._seconds
        late = time.monotonic() > self._began + BY_CLOCK * allowed
        self._clocked |= late
        return late or self._effort.seconds - self._spent > CORES * allowed

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
        told = (
            'the search for causes was cut short after as many steps as two cores usually take in '
            f'{minutes:.3g} min'
        )
        if unmet:
            names = ', '.join(f'{c.effect} at {c.place}' for c in unmet)
            told += f', before others were tried in the place of {names}: not named for that'
        told += '. A longer limit (--minutes) lets it come to its end'
        if self._clocked:
            told += (
                '; the clock ended it, since this machine was slow or busy: another run may come '
                'further'
            )
        return [f'{told}.', *unasked]
