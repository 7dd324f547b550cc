"""
Ablation: a state without one of its causes, which tells whether that one is missed.

All else is fitted again from where it is. Where what a motor turns is only guessed, that is too
far from where it has to go for one kind of cause: a torque constant three times as large is the
same machine three times as heavy, and all torques and guesses have to come down together.
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from tendon_ros.diagnose.found import Found
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem


def rest_of(problem: Problem, found: Found, k: int) -> Fit:
    """
    Return the last state of a search without one cause, everything else fitted again.

    :param problem: the data.
    :param found: what was found.
    :param k: which cause.
    :return: the fit; where the rest alone cannot be computed, the best state so far that had not
        the cause.
    """
    state = found.final
    if len(state.model.causes) == 1:
        return found.start
    fit = left_out(problem, state, k, rounds=8, accuracy=1e-3)
    if math.isfinite(fit.cost):
        return fit
    cause = state.model.causes[k]
    others = [s for s in found.states if cause not in s.model.causes]
    return min(others, key=lambda s: s.cost)


def left_out(problem: Problem, state: Fit, k: int, rounds: int, accuracy: float) -> Fit:
    """
    Return a state without one cause, everything else fitted again.

    :param problem: the data.
    :param state: with its causes.
    :param k: which cause.
    :param rounds: of the fit.
    :param accuracy: part of the cost that ends it.
    :return: the fit; its cost is infinite where the rest alone cannot be computed.
    """
    known = problem.slopes(state)
    fit = problem.fitted(state.model.without(k), known, rounds, accuracy=accuracy)
    if not sets_the_unit(problem, state.model, k):
        return fit
    scaled = problem.fitted(_scaled(problem, state.model, k), None, rounds, accuracy=accuracy)
    return min((fit, scaled), key=lambda fit: fit.cost)


def sets_the_unit(problem: Problem, model: Model, k: int) -> bool:
    """
    Return whether a cause is a torque constant beside guesses that may be scaled along with it.

    :param problem: the data.
    :param model: with its causes.
    :param k: which cause.
    :return: whether.
    """
    guessed = any(t.guessed for t in problem.tolerances)
    return guessed and model.causes[k].effect == 'torque_gain'


def _scaled(problem: Problem, model: Model, k: int) -> Model:
    """Return a model without a torque constant, all torques and guesses smaller by as much."""
    gain = model.values(k)['gain']
    moved = [
        t.axis.place(t.axis.value(float(z)) / gain) if t.guessed else float(z)
        for t, z in zip(problem.tolerances, model.moved, strict=True)
    ]
    scaled = replace(model.without(*range(len(model.causes))), moved=np.array(moved))
    for n, cause in enumerate(model.causes):
        if n != k:
            values = model.values(n)
            torques = {p.name for p in cause.parameters if p.unit.startswith('N m')}
            scaled = scaled.joined(
                cause, {name: v / gain if name in torques else v for name, v in values.items()}
            )
    return scaled
