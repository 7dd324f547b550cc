"""
Causes on one body: whether two of them are one, or one is two.

Which it is called is a matter of words, as long as laws are right; the simpler account is kept.
"""

from __future__ import annotations

from itertools import combinations
import math

from tendon_ros.diagnose.bodies import of_one_body
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.parsimony import as_good
from tendon_ros.diagnose.rivals import BETTER, CLOSE, CREEPING, sharpened
from tendon_ros.diagnose.steps import best_of, Steps
from tendon_ros.effects import find
from tendon_ros.identify.screening import Screen


def merge(steps: Steps, found: Found) -> bool:
    """
    Let one effect take the place of two on one body, if it does as well.

    An eccentric wheel of a motor that gives more torque than it says, for one, is an encoder that
    counts too few.

    :param steps: of the search.
    :param found: its last state is replaced.
    :return: whether it was.
    """
    problem = steps.problem
    instrument = problem.rollouts.instrument
    merged = False
    for one, two in combinations(found.final.model.causes, 2):
        causes = found.final.model.causes
        if not of_one_body(instrument, one, two) or not {one, two} <= set(causes):
            continue
        state = found.final
        model = state.model.without(causes.index(one), causes.index(two))
        smaller = problem.fitted(model, problem.slopes(state), 8, 1e-3)
        if not math.isfinite(smaller.cost):
            continue
        among = [c for c in steps.candidates if of_one_body(instrument, one, c)]
        proposals = best_of(steps.screened(Screen(problem, smaller), among=among))
        rivals = steps.fitted(smaller, proposals, smaller.cost - state.cost)
        rivals = sharpened(steps, state, smaller, rivals, CLOSE)
        if rivals and as_good(problem, rivals[0].fit, state):
            found.states[-1] = steps.settled(rivals[0].fit.model)
            merged = True
    return merged


def divide(steps: Steps, found: Found) -> bool:
    """
    Let effects that together do the same take the place of one, if they do better.

    A motor's bias beside Coulomb friction is friction that differs by direction, but while that
    builds up after a reversal.

    :param steps: of the search.
    :param found: its last state is replaced.
    :return: whether it was.
    """
    problem = steps.problem
    instrument = problem.rollouts.instrument
    divided = False
    for cause in found.final.model.causes:
        state = found.final
        causes = state.model.causes
        together = find(cause.effect).alike
        if together is None or cause.given:
            continue
        sizes = together(**state.model.values(causes.index(cause)))
        parts = [
            c
            for c in steps.candidates
            if c.effect in sizes and c not in causes and of_one_body(instrument, cause, c)
        ]
        if len(parts) != len(sizes):
            continue
        model = state.model.without(causes.index(cause))
        for part in parts:
            [parameter] = part.parameters
            model = model.joined(part, {parameter.name: sizes[part.effect]})
        two = problem.fitted(model, problem.slopes(state), CREEPING, 1e-3)
        if two.cost < BETTER * state.cost:
            found.states[-1] = two
            divided = True
    return divided
