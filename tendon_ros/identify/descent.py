"""
Steps of Levenberg and Marquardt's method between bounds.

Derivatives cost a rollout for each unknown, a step costs one: so several steps are taken with
derivatives that only follow them, by Broyden's rule.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: tries of a step with derivatives as they were taken, and of each with those that follow
TRIES = (6, 1, 1)
BACK = (1.0, 0.5, 0.25, 0.0)  # parts of the way from the file from which a model is computed
#: part of what a step has to gain that it must promise
PROMISED = 0.3


@dataclass(frozen=True)
class Place:
    """Where a descent is: unknowns, what they leave, and the squares of that and of priors."""

    x: FloatArray
    left: FloatArray
    cost: float


class Descent:
    """
    Descends from place to place.

    :param left: what unknowns leave of each sample, in noise deviations.
    :param prior: what a deviation of each unknown costs, by its square, shape (unknowns,).
    :param likely: from where deviations count, shape (unknowns,).
    :param bounds: of the unknowns, shape (unknowns, 2).
    :param still: which do not move, shape (unknowns,).
    :param within: of unknowns that no bound tells to be out of reach, the nearest ones within.
    """

    def __init__(
        self,
        left: Callable[[FloatArray], FloatArray],
        prior: FloatArray,
        likely: FloatArray,
        bounds: FloatArray,
        still: NDArray[np.bool_],
        within: Callable[[FloatArray], FloatArray] = lambda x: x,
    ) -> None:
        self._left = left
        self._prior = prior
        self._likely = likely
        self._bounds = bounds
        self._still = still
        self._within = within
        self._damping = 1e-3

    def at(self, x: FloatArray) -> Place:
        """
        Return a place.

        :param x: unknowns.
        :return: with its cost, infinite where the model cannot be computed.
        """
        return self.placed(x, self._left(x))

    def placed(self, x: FloatArray, left: FloatArray) -> Place:
        """
        Return a place of which it is known what it leaves.

        :param x: unknowns.
        :param left: what they leave, shape (samples,).
        :return: with its cost.
        """
        return Place(x, left, float(left @ left + self._prior @ (x - self._likely) ** 2))

    def step(self, place: Place, slope: FloatArray, tries: int, gain: float) -> Place:
        """
        Take a step.

        :param place: from where.
        :param slope: derivatives of what is left, shape (samples, unknowns).
        :param tries: steps that are tried, each shorter than the one before.
        :param gain: part of the cost that is worth a step.
        :return: a better place; the same one where no step promises enough or keeps what it does.
        """
        normal = slope.T @ slope + np.diag(self._prior)
        gradient = slope.T @ place.left + self._prior * (place.x - self._likely)
        scale = np.diag(np.diag(normal)) + 1e-9 * np.eye(len(place.x))
        low, high = self._bounds.T
        # unknowns pressed against a bound stay there
        free = ~self._still & unpressed(place.x, self._bounds, gradient)
        damping = self._damping
        for _ in range(tries):
            way = np.zeros(len(place.x))
            way[free] = np.linalg.solve(
                (normal + damping * scale)[np.ix_(free, free)], -gradient[free]
            )
            x = self._within(np.clip(place.x + way, low, high))
            way = x - place.x
            promise = -float(way @ (2.0 * gradient + normal @ way))
            if 0.0 <= promise < PROMISED * gain * place.cost:
                break
            # a step that bounds cut short may lead upwards
            if promise > 0.0:
                trial = self.at(x)
                if np.isfinite(trial.cost) and trial.cost < place.cost:
                    self._damping = max(0.2 * damping, 1e-7)
                    return trial
            damping *= 8.0
        return place


def follow(slope: FloatArray, columns: list[int], before: Place, after: Place) -> None:
    """
    Turn derivatives so that they tell what a step has changed, by Broyden's rule.

    :param slope: shape (samples, unknowns); it is changed.
    :param columns: those that may be wrong.
    :param before: where the step began.
    :param after: where it ended.
    """
    way = after.x - before.x
    part = way[columns]
    square = float(part @ part)
    if square > 0.0:
        missed = after.left - before.left - slope @ way
        slope[:, columns] += np.outer(missed / square, part)


def unpressed(x: FloatArray, bounds: FloatArray, gradient: FloatArray) -> NDArray[np.bool_]:
    """
    Return which unknowns are not pressed against a bound.

    :param x: unknowns.
    :param bounds: shape (unknowns, 2).
    :param gradient: half the derivative of the cost.
    :return: shape (unknowns,).
    """
    held: NDArray[np.bool_] = ((x <= bounds[:, 0]) & (gradient > 0.0)) | (
        (x >= bounds[:, 1]) & (gradient < 0.0)
    )
    return ~held


def computed(descent: Descent, x: FloatArray, own: int) -> Place:
    """
    Return a place at which the model can be computed.

    Numbers of the file that have gone far beside a cause may leave a model that diverges without
    it: they go back towards the file.

    :param descent: of the model.
    :param x: unknowns, those of the file last.
    :param own: how many of them are not of the file.
    :return: the place; the file's own numbers where nothing else can be computed, or that neither.
    """
    for part in BACK:
        place = descent.at(np.concatenate([x[:own], part * x[own:]]))
        if math.isfinite(place.cost):
            break
    return place
