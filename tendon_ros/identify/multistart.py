"""
Multistart: the places, near and far, from which fits of guessed numbers begin.

Driven by torques, a model swings as its numbers say, and a fit from a guess far off ends in a
valley nearby: with another period nothing fits at all. What a guess may be is therefore looked
over coarsely first, all numbers of a kind by one factor. Driven by motion, bodies behind cables
leave several valleys too, in which one cable is stiff where another is soft: there each number is
looked over by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from tendon_ros.identify.axis import Axis
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

FloatArray = NDArray[np.float64]

#: times as much, or as little, as a guess may be: of all of a kind, and of each by itself
FAR, EACH = 20.0, 3.0
#: combinations that are tried, and that are kept
TRIED, KEPT = 256, 6


def swings(problem: Problem) -> bool:
    """
    Return whether a torque drives the model, which then swings as its numbers say.

    :param problem: the data.
    :return: whether.
    """
    return any(d.by_torque for d in drives(problem.rollouts.instrument))


def kinds_of(problem: Problem) -> dict[int, str]:
    """
    Return which guesses move together.

    :param problem: the data.
    :return: by number of the tolerance its kind; where motion drives the model each is its own.
    """
    by_torque = swings(problem)
    return {
        n: t.quantity if by_torque else f'{t.place}.{t.quantity}'
        for n, t in enumerate(problem.tolerances)
        if t.guessed and not t.given
    }


def afar(problem: Problem, model: Model) -> list[Model]:
    """
    Return where fits of the guesses may begin.

    :param problem: the data.
    :param model: what holds.
    :return: the same with guesses moved, what leaves least first; none where all motions are known
        (what is left is then nearly linear in the guesses), or nothing is guessed.
    """
    by_torque = swings(problem)
    if not by_torque and not problem.rollouts.instrument.inner:
        return []
    names = kinds_of(problem)
    kinds = sorted(set(names.values()))
    if not kinds:
        return []
    reach = np.log(FAR if by_torque else EACH)
    if by_torque:
        points = qmc.Halton(len(kinds), scramble=False).random(TRIED)
    else:  # in many dimensions that sequence walks along diagonals
        points = np.random.default_rng(0).random((TRIED, len(kinds)))

    def moved(point: FloatArray) -> Model:
        factors = dict(zip(kinds, np.exp(reach * (2.0 * point - 1.0)).tolist(), strict=True))
        places = model.moved.copy()
        for n, name in names.items():
            places[n] = placed(problem.tolerances[n].axis, factors[name])
        return replace(model, moved=places)

    models = [moved(point) for point in points]

    def cost(n: int) -> FloatArray:
        left = problem.left(models[n])
        return np.array(left @ left)

    costs = np.array(problem.rollouts.each(cost, range(TRIED)))
    best = np.argsort(costs, kind='stable')[:KEPT].tolist()
    return [models[k] for k in best if np.isfinite(costs[k])]


def aside(problem: Problem, model: Model) -> list[Model]:
    """
    Return a model with one of its guesses moved, each by its deviation either way.

    :param problem: the data.
    :param model: where to begin.
    :return: two models for each guess that may move so far.
    """
    found = []
    for n, t in enumerate(problem.tolerances):
        if not t.guessed or t.given:
            continue
        found += shifted(problem, model, n, (-1.0, 1.0))
    return found


def shifted(problem: Problem, model: Model, n: int, steps: Sequence[float]) -> list[Model]:
    """
    Return a model with one of its numbers moved.

    :param problem: the data.
    :param model: where to begin.
    :param n: which of the tolerances.
    :param steps: on its axis, shape (steps,).
    :return: a model for each step that ends within the axis.
    """
    low, high = problem.tolerances[n].axis.ends
    places = [float(model.moved[n]) + step for step in steps]
    found = []
    for place in places:
        if low <= place <= high:
            moved = model.moved.copy()
            moved[n] = place
            found.append(replace(model, moved=moved))
    return found


def placed(axis: Axis, factor: float) -> float:
    """
    Return the place at which a number is a factor times what the file says.

    :param axis: of a guess.
    :param factor: above zero.
    :return: the place on the axis.
    """
    if axis.log:
        return axis.place(factor * axis.centre)
    # what is added to a number that must not become negative
    nominal = axis.centre - axis.low
    return axis.place(axis.centre + (factor - 1.0) * (nominal if nominal > 0.0 else axis.scale))
