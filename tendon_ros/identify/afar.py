"""
Where fits of guessed numbers begin: from afar.

Driven by torques, a model swings as its numbers say, and a fit from a guess far off ends in a
valley nearby: with another period nothing fits at all. What a guess may be is therefore looked
over coarsely first, all numbers of a kind by one factor.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from tendon_ros.identify.axis import Axis
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

FloatArray = NDArray[np.float64]

#: times as much, or as little, as a guess may be; combinations that are tried, and that are kept
FAR, TRIED, KEPT = 20.0, 256, 4


def afar(problem: Problem, model: Model) -> list[Model]:
    """
    Return where fits of the guesses may begin.

    :param problem: the data.
    :param model: what holds.
    :return: the same with guesses moved, what leaves least first; none where motions are known
        (what is left is then nearly linear in the guesses), or nothing is guessed.
    """
    movable = [t.guessed and not t.given for t in problem.tolerances]
    kinds = sorted({t.quantity for t, far in zip(problem.tolerances, movable, strict=True) if far})
    if not kinds or not any(d.by_torque for d in drives(problem.rollouts.instrument)):
        return []
    reach = np.log(FAR)
    points = reach * (2.0 * qmc.Halton(len(kinds), scramble=False).random(TRIED) - 1.0)

    def moved(point: FloatArray) -> Model:
        factors = dict(zip(kinds, np.exp(point).tolist(), strict=True))
        places = [
            _place(t.axis, factors[t.quantity]) if far else float(z)
            for t, far, z in zip(problem.tolerances, movable, model.moved, strict=True)
        ]
        return replace(model, moved=np.array(places, dtype=np.float64))

    models = [moved(point) for point in points]
    costs = []
    for one in models:
        left = problem.left(one)
        costs.append(float(left @ left))
    best = np.argsort(costs, kind='stable')[:KEPT].tolist()
    return [models[k] for k in best if np.isfinite(costs[k])]


def _place(axis: Axis, factor: float) -> float:
    """Return the place at which a number is a factor times what the file says."""
    if axis.log:
        return axis.place(factor * axis.centre)
    # what is added to a number that must not become negative
    nominal = axis.centre - axis.low
    return axis.place(axis.centre + (factor - 1.0) * (nominal if nominal > 0.0 else axis.scale))
