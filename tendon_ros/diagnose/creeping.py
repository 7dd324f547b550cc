"""Friction that creeps while it holds: where a pulley stands then is chance; fits beside that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tendon_ros.diagnose.form import creep_profile
from tendon_ros.diagnose.further import foretells
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.worth import LEAST, LEAST_IN_ONE
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

TURNS = 3  # of doubting laws by a fit, and fitting anew


def left_to_chance(problem: Problem, start: Fit, state: Fit) -> bool:
    """
    Return whether much of what stays, stays where friction holds.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them, and with its derivatives.
    :return: whether it is more than a cause has to be worth.
    """
    if problem.by_misfit:
        return False
    holds = creep_profile(problem, start, state) > LEAST
    return problem.structured(np.where(holds, state.left, 0.0)) >= LEAST_IN_ONE


def doubting(ready: Prepared, start: Model, model: Model) -> tuple[Prepared, Fit]:
    """
    Return a fit in which samples count the less, the more laws may get wrong of them.

    Holds that were fitted by chance take numbers of the file far off, from where a descent does
    not find back: it begins from where these are likely to be as well.

    :param ready: the problem.
    :param start: without any cause.
    :param model: with causes.
    :return: the problem with these doubts, and the fit.
    """
    ready, fit = _turn(ready, start, model)
    for _ in range(TURNS - 1):
        ready, fit = _turn(ready, start, fit.model)
    return ready, fit


def beside_chance(ready: Prepared, start: Model, state: Fit) -> tuple[Prepared, Fit]:
    """
    Return a fit that does not rest on what holds leave to chance.

    Sizes that were fitted to that foretell what no fit has seen the worse.

    :param ready: the problem.
    :param start: without any cause.
    :param state: a fit.
    :return: the problem with doubts, and the fit; both as they were where holds leave little, or
        where, with these doubts, the fit foretells no more.
    """
    problem = ready.problem
    if not any(cause.dry for cause in state.model.causes):
        return ready, state
    doubted = bool(np.any(problem.doubted > 1.0))
    if not doubted and not left_to_chance(problem, problem.fitted(start, rounds=0), state):
        return ready, state
    anew, fit = doubting(ready, start, state.model)
    better = foretells(anew.held, state.model, fit.model)
    return (anew, fit) if better else (ready, state)


def _turn(ready: Prepared, start: Model, model: Model) -> tuple[Prepared, Fit]:
    """Return the problem with doubts by a model, and the better fit from there."""
    ready = ready.allowing(start, model)
    begun = (model, replace(model, moved=ready.problem.begun.moved))
    fits = [ready.problem.fitted(one, accuracy=1e-4) for one in begun]
    return ready, min(fits, key=lambda fit: fit.cost)
