"""How far a force may have gone since the last estimate: what a measurement is weighed with."""

from __future__ import annotations

import math

#: time in which a force may change by as much as it is uncertain at best, where nothing is known
#: of it; and over which what a model gets wrong is one and the same [s]
STEADY = 0.02


class Expectation:
    """
    The deviation of a force that is not measured, from one estimate to the next.

    :param least: deviation below which no single measurement is believed [N or N m].
    :param wander: by how much the force wanders in a second, as its square root goes on
        [N or N m]; where None it is not expected to change faster than it can be told at best.
    """

    def __init__(self, least: float, wander: float | None) -> None:
        self._least = least
        self._wander = wander
        self.reset()

    def reset(self) -> None:
        """Forget what was known."""
        self._spread = math.inf  # of the last estimate
        self._known = math.inf  # the same, were errors of the model noise
        self._best = math.inf  # that a single measurement left so far

    def foreseen(self, gap: float) -> float:
        """
        Return the deviation of the force about the last estimate.

        :param gap: since then [s].
        :return: [N or N m]; infinite before the first.
        """
        if not math.isfinite(self._spread) or not gap > 0.0:
            return math.inf
        if self._wander is None:
            return math.hypot(self._spread, self._best * gap / STEADY)
        # measurements that share what the model gets wrong count as one
        return math.hypot(self._known, self._wander * math.sqrt(gap)) * self._share(gap)

    def known(self, variance: float, foreseen: float, gap: float) -> float:
        """
        Take an estimate in, and return its deviation.

        :param variance: that the measurement left of the force.
        :param foreseen: what it was weighed with.
        :param gap: since the last one [s].
        :return: [N or N m].
        """
        variance = max(variance, 1e-300)
        alone = 1.0 / max(1.0 / variance - foreseen**-2, 1e-300)
        self._best = max(self._least, min(self._best, math.sqrt(alone)))
        share = self._share(gap) if math.isfinite(foreseen) else 1.0
        self._known = math.sqrt(variance) / share
        # what a model gets wrong does not average out
        self._spread = max(math.sqrt(variance), self._best)
        return self._spread

    @staticmethod
    def _share(gap: float) -> float:
        return math.sqrt(min(1.0, gap / STEADY))
