"""
Causes on one body: whether two of them are one, or one is two.

Which it is called is a matter of words, as long as laws are right; the simpler account is kept.
"""

from __future__ import annotations

from itertools import combinations
import math

from tendon_ros.diagnose.bodies import of_one_body
from tendon_ros.diagnose.form import tie
from tendon_ros.diagnose.found import best_of, Found, Rival
from tendon_ros.diagnose.parsimony import as_good
from tendon_ros.diagnose.rivals import CLOSE, CREEPING, sharpened
from tendon_ros.diagnose.steps import Steps
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
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
        elif (whole := _whole(steps, state, one, two)) is not None:
            # two faults of one body at once are less likely than one
            fit = _fitted(problem, whole, state)
            if _ties(problem, fit, state):
                found.states[-1] = fit
                merged = True
    return merged


def divide(steps: Steps, found: Found) -> bool:
    """
    Let effects that together do the same take the place of one, if they do plainly better.

    A motor's bias beside Coulomb friction is friction that differs by direction, but while that
    builds up after a reversal.

    :param steps: of the search.
    :param found: its last state is replaced.
    :return: whether it was.
    """
    problem = steps.problem
    divided = False
    for cause in found.final.model.causes:
        state = found.final
        parts = _parts(steps, state, cause)
        if parts is None:
            continue
        two = _fitted(problem, parts, state)
        if not _ties(problem, state, two):
            found.states[-1] = two
            divided = True
    return divided


def _fitted(problem: Problem, model: Model, state: Fit) -> Fit:
    """Return the fit of a model that is another account of a state."""
    return problem.fitted(model, problem.slopes(state), CREEPING, 1e-3)


def _ties(problem: Problem, state: Fit, other: Fit) -> bool:
    """Return whether a state is no worse than another one, or by no more than a tie."""
    return state.cost - other.cost <= tie(problem, other) * len(other.left)


def _parts(steps: Steps, state: Fit, cause: Candidate) -> Model | None:
    """Return a state's model with what together does the same as a cause, last, in its place."""
    causes = state.model.causes
    together = find(cause.effect).alike
    if together is None or cause.given:
        return None
    sizes = together(**state.model.values(causes.index(cause)))
    parts = [
        c
        for c in steps.candidates
        if c.effect in sizes
        and c not in causes
        and of_one_body(steps.problem.rollouts.instrument, cause, c)
    ]
    if len(parts) != len(sizes):
        return None
    model = state.model.without(causes.index(cause))
    for part in parts:
        [parameter] = part.parameters
        model = model.joined(part, {parameter.name: sizes[part.effect]})
    return model


def _whole(steps: Steps, state: Fit, one: Candidate, two: Candidate) -> Model | None:
    """Return a state's model with what does the same as two causes, last, in their place."""
    causes = state.model.causes
    instrument = steps.problem.rollouts.instrument
    for whole in steps.candidates:
        effect = find(whole.effect)
        does = effect.parts == {one.effect, two.effect}
        if not does or whole in causes or not of_one_body(instrument, one, whole):
            continue
        values = dict(effect.typical)
        for part in (one, two):
            [size] = state.model.values(causes.index(part)).values()
            values |= dict.fromkeys(effect.holds.get(part.effect, ()), size)
        rest = state.model.without(causes.index(one), causes.index(two))
        return rest.joined(whole, values)
    return None


def instead(steps: Steps, state: Fit) -> dict[Candidate, list[Rival]]:
    """
    Fit one effect in the place of two on one body, and two in the place of one.

    While a body moves, friction that differs by direction is Coulomb friction and a bias of its
    motor, and nobody can tell unless it turns often enough.

    :param steps: of the search.
    :param state: with all causes.
    :return: of each cause that has such, those that take its place: the one of both, or each of
        the two beside the other.
    """
    problem = steps.problem
    found: dict[Candidate, list[Rival]] = {}

    for cause in state.model.causes:
        if (model := _parts(steps, state, cause)) is not None:
            fit = _fitted(problem, model, state)
            new = [c for c in fit.model.causes if c not in state.model.causes]
            found[cause] = [Rival(c, fit) for c in new]
    for one, two in combinations(state.model.causes, 2):
        if not of_one_body(problem.rollouts.instrument, one, two):
            continue
        if (model := _whole(steps, state, one, two)) is not None:
            rival = Rival(model.causes[-1], _fitted(problem, model, state))
            for part in (one, two):
                found.setdefault(part, []).append(rival)
    return found
