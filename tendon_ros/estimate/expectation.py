"""
What force and friction are expected to be, from one estimate to the next.

A measurement is weighed with how far the force may have gone since the last one. Dry friction of a
pulley that rests may be anything, but it stays what it is: whatever the balance of torques says of
both together is said once, and not again by every measurement of the same rest.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: time in which a force may change by as much as it is uncertain at best, where nothing is known
#: of it; and over which what a model gets wrong is one and the same [s]
STEADY = 0.02
#: times the best deviation that a force of which nothing is known has; the same alone [N or N m]
ANY, ANYWHERE = 1e4, 1e6


@dataclass(frozen=True)
class Expected:
    """
    Force and friction before a measurement: ``mean + spread @ z``, z standard normal.

    ``mean``: force [N or N m], then by how much the friction in each balance differs from the
    model's [N m], shape (1 + rows,); ``spread``: shape (1 + rows, unknowns).
    """

    mean: FloatArray
    spread: FloatArray

    @property
    def force(self) -> float:
        """Deviation of the force."""
        return float(np.linalg.norm(self.spread[0]))


class Expectation:
    """
    Force and friction from one estimate to the next.

    :param least: deviation below which no single measurement of the force is believed [N or N m].
    :param wander: by how much the force wanders in a second, as its square root goes on
        [N or N m]; where None it is not expected to change faster than it can be told at best.
    :param rows: balances of torques.
    """

    def __init__(self, least: float, wander: float | None, rows: int) -> None:
        self._least = least
        self._wander = wander
        self._rows = rows
        self.reset()

    def reset(self) -> None:
        """Forget what was known."""
        self._mean = np.zeros(1 + self._rows)
        self._covariance = np.zeros((1 + self._rows, 1 + self._rows))
        self._unsure = np.zeros(self._rows)  # friction, of the last estimate
        self._best = math.inf  # deviation of the force that a single measurement left so far
        self._begun = False

    def foreseen(self, gap: float, unsure: FloatArray, same: FloatArray) -> Expected:
        """
        Return what is expected after some time.

        :param gap: since the last estimate [s].
        :param unsure: by how much the friction in each balance is uncertain [N m], shape (rows,).
        :param same: how far its error is the one of before, 0 to 1, shape (rows,).
        :return: the expectation; any force before the first estimate.
        """
        if not self._begun or not gap > 0.0:
            spread = np.diag(np.append(ANY * self._least or ANYWHERE, unsure))
            return Expected(np.zeros(1 + self._rows), _pruned(spread))
        # friction is never more uncertain than anything that it can be
        less = np.minimum(1.0, unsure / np.maximum(self._unsure, 1e-300))
        kept = np.append(1.0, same * less)
        covariance = kept[:, None] * self._covariance * kept
        covariance[1:, 1:] += np.diag(np.maximum(unsure**2 - (kept[1:] * self._unsure) ** 2, 0.0))
        if self._wander is None:
            covariance[0, 0] += min(self._best * gap / STEADY, ANYWHERE) ** 2
        else:
            covariance[0, 0] += self._wander**2 * gap
            # measurements that share what the model gets wrong count as one
            covariance *= self._share(gap) ** 2
        return Expected(kept * self._mean, _root(covariance))

    def deviation(self, covariance: FloatArray, expected: Expected) -> float:
        """
        Return the deviation of the force of an estimate.

        :param covariance: of force and frictions, that the measurement left.
        :param expected: what it was weighed with.
        :return: [N or N m].
        """
        # what a model gets wrong does not average out
        return max(math.sqrt(_variance(covariance)), self._told(covariance, expected))

    def taken(
        self, mean: FloatArray, covariance: FloatArray, expected: Expected, unsure: FloatArray,
        gap: float,
    ) -> None:  # fmt: skip
        """
        Take an estimate in.

        :param mean: force and frictions, shape (1 + rows,).
        :param covariance: that the measurement left of them.
        :param expected: what it was weighed with.
        :param unsure: as for :meth:`foreseen`.
        :param gap: the time since the last one [s].
        """
        self._best = self._told(covariance, expected)
        self._mean, self._covariance = mean, covariance.copy()
        if self._wander is None:
            self._covariance[0, 0] = self.deviation(covariance, expected) ** 2
        elif self._begun and gap > 0.0:
            self._covariance /= self._share(gap) ** 2
        self._unsure = unsure
        self._begun = True

    def _told(self, covariance: FloatArray, expected: Expected) -> float:
        """Return the deviation that the best single measurement leaves, this one included."""
        # of a force that no torque feels nothing is ever known
        known = max(1.0 / _variance(covariance) - expected.force**-2, 1.0 / ANYWHERE**2)
        return max(self._least, min(self._best, math.sqrt(1.0 / known)))

    @staticmethod
    def _share(gap: float) -> float:
        return math.sqrt(min(1.0, gap / STEADY))


def _variance(covariance: FloatArray) -> float:
    """Return that of the force."""
    return max(float(covariance[0, 0]), 1e-300)


def _root(covariance: FloatArray) -> FloatArray:
    """Return a matrix whose square is a covariance."""
    value, vector = np.linalg.eigh(covariance)
    return _pruned(vector * np.sqrt(np.maximum(value, 0.0)))


def _pruned(spread: FloatArray) -> FloatArray:
    """Return a spread without what moves nothing."""
    size = np.linalg.norm(spread, axis=0)
    return np.asarray(spread[:, size > 1e-9 * size.max()])
