"""How long a search may take: what has run out of it ends with what was found so far."""

from __future__ import annotations

from collections.abc import Sequence
import math
import time

from tendon_ros.identify.candidate import Candidate

#: [s] that a search may take: most take one or two minutes; guesses of many bodies, and loops that
#: shake, take more
USUAL = 600.0


class Patience:
    """
    Runs out after a time.

    :param seconds: from now on; endless by default.
    """

    def __init__(self, seconds: float = math.inf) -> None:
        self._seconds = seconds
        self._until = time.monotonic() + seconds
        self._cut = False

    @property
    def over(self) -> bool:
        """Whether it has run out: whoever asks leaves out then what would have come next."""
        self._cut |= time.monotonic() > self._until
        return self._cut

    def words(self, unmet: Sequence[Candidate]) -> list[str]:
        """
        Return what was left out since it had run out.

        :param unmet: causes that nobody was tried in the place of.
        :return: a sentence; none where nothing was left out.
        """
        if not self._cut:
            return []
        told = f'the search for causes was ended after {self._seconds / 60.0:.3g} min'
        if unmet:
            names = ', '.join(f'{c.effect} at {c.place}' for c in unmet)
            told += f', before others were tried in the place of {names}: not named for that'
        return [f'{told}. A longer limit (--minutes) lets it come to its end.']
