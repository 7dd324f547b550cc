"""
Where fits begin if torque drives a body of which hardly anything is known: what is alike is tied.

Friction, inertia, damping, stiffness and torque constant of a body that a torque swings have to be
right together, or nothing fits at all; each on its own ends in a valley where one motor is heavy
and its twin is light. So all guesses of a kind move by one factor first, and all that rubs by
another, and how late a filter makes what is read by a third: a handful of unknowns, which can be
looked over and then fitted from the best places.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import qmc

from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.multistart import FAR, kinds_of, placed

FloatArray = NDArray[np.float64]

Ends = tuple[float, float]

#: parts of what is typical that rubs: from hardly any to all of it
RUBS: Ends = (3e-3, 1.0)
#: places that are tried, and from which fits go on
TRIED, FITTED = 256, 8
#: rounds of such a fit, and its step for derivatives, relative
ROUNDS, STEP = 15, 0.02
#: noise deviations at which one sample says no more
OUTLYING = 200.0


def tied(
    problem: Problem, of_sizes: Callable[[Sequence[float]], Model], ends: Sequence[Ends] = (RUBS,)
) -> list[Model]:
    """
    Return where fits of guesses and of all that rubs may begin.

    :param problem: the data.
    :param of_sizes: returns the model with causes of some sizes: of what rubs, the part of what is
        typical.
    :param ends: between which each of these sizes lies, all positive.
    :return: models with guesses of a kind moved alike, what leaves least first, what they cost
        counted; those that cannot be computed are left out.
    """
    names = kinds_of(problem)
    kinds = sorted(set(names.values()))
    low = np.array([*[-np.log(FAR)] * len(kinds), *(np.log(least) for least, _ in ends)])
    high = np.array([*[np.log(FAR)] * len(kinds), *(np.log(most) for _, most in ends)])
    points = qmc.scale(qmc.Halton(len(low), scramble=False).random(TRIED), low, high)

    def model(x: FloatArray) -> Model:
        factors = dict(zip(kinds, np.exp(x).tolist(), strict=False))
        begun = of_sizes(np.exp(x[len(kinds) :]).tolist())
        places = begun.moved.copy()
        for n, kind in names.items():
            places[n] = placed(problem.tolerances[n].axis, factors[kind])
        return replace(begun, moved=places)

    def left(x: FloatArray) -> FloatArray:
        found = np.nan_to_num(problem.left(model(x)), nan=OUTLYING)
        return np.clip(found, -OUTLYING, OUTLYING)

    def slope(x: FloatArray) -> FloatArray:
        here = left(x)
        return np.stack([(left(x + row) - here) / STEP for row in STEP * np.eye(len(x))], axis=1)

    def power(n: int) -> FloatArray:
        return np.array(np.sum(left(points[n]) ** 2))

    def fitted(n: int) -> FloatArray:
        fit = least_squares(left, points[n], slope, bounds=(low, high), max_nfev=ROUNDS)
        return np.asarray(fit.x)

    costs = np.array(problem.rollouts.each(power, range(TRIED)))
    best = np.argsort(costs, kind='stable')[:FITTED].tolist()
    models = [model(x) for x in problem.rollouts.each(fitted, best)]
    # of places that the data hardly tell apart, the one nearer to the file
    begun = sorted(((problem.cost(m), m) for m in models), key=lambda pair: pair[0])
    return [m for cost, m in begun if np.isfinite(cost)]
