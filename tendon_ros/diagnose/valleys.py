"""
Valleys in which fits of guessed numbers and of ripples end, and ways out of them.

A fit goes downhill from where it begins. Numbers that were only guessed are far off, and from
there the way may end in a valley that is not the deepest; so may that of a ripple, whose number of
waves has a valley for each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.worth import open_question
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.multistart import afar, aside, shifted
from tendon_ros.identify.residuals import FEW
from tendon_ros.identify.screening import Screen

FloatArray = NDArray[np.float64]

#: part of what numbers fitted from the file's own leave beyond noise that others, far from them,
#: may leave; and how many of these are fitted to their end
FARTHER, ENDED = 0.8, 2
#: noise power a sample from which on it is more than misplaced guesses that is wrong
SETTLED = 1.0
#: [rad] by which a guessed position of a contact is moved: a fit does not feel how far off a wall
#: is that it does not touch, and of one that it does hardly whether it is too soft or too far
ASIDE = (3e-3, 1e-2, 3e-2)
#: how often guesses are moved aside, and part of the cost that has to stay for it to have helped
NUDGES, NUDGED = 3, 0.98


def started(steps: Steps) -> Fit:
    """
    Fit the numbers of the file without any cause.

    :param steps: of the search.
    :return: the fit from the file's own numbers, or from far off where that leaves much less.
    """
    problem = steps.problem
    near = touched(steps, steps.settled(problem.begun))
    steps.report('looking over what is guessed from afar', 0.01)
    far = from_afar(steps, problem.begun)
    if far is None:
        return near
    steps.report('moving what is guessed aside', 0.02)
    # what neighbouring bins share is what a better place would take away
    shared = problem.structured(near.left) * len(near.left)
    return nudged(steps, far if near.cost - far.cost > (1.0 - FARTHER) * shared else near)


def touched(steps: Steps, state: Fit) -> Fit:
    """
    Return a state with contacts whose positions are guessed where they leave least.

    :param steps: of the search.
    :param state: with all its causes.
    :return: the better one; the same where it leaves nothing.
    """
    problem = steps.problem
    for n, t in enumerate(problem.tolerances):
        if not (t.guessed and t.quantity == 'position' and open_question(problem, state)):
            continue
        offs = [way * by / t.axis.scale for by in ASIDE for way in (-1.0, 1.0)]
        rough = _rough(steps, problem, shifted(problem, state.model, n, offs), rounds=8)
        ended = _ended(steps, rough, steps.settled)
        if ended is not None and ended.cost < NUDGED * state.cost:
            state = ended
    return state


def nudged(steps: Steps, state: Fit) -> Fit:
    """
    Return a state out of the valley in which its guesses were, if there is a deeper one.

    Where one cable is too stiff another is too soft, and no small step mends both.

    :param steps: of the search.
    :param state: with all its causes.
    :return: the better one; the same where it leaves nothing, or more than guesses are for.
    """
    problem = steps.problem
    for _ in range(NUDGES):
        little = problem.structured(state.left) < SETTLED
        begun = aside(problem, state.model)
        if not (begun and little and open_question(problem, state)):
            break
        rough = _rough(steps, problem, begun, rounds=6, known=problem.slopes(state))
        # what has come back leaves the very same, however far numbers are that nothing tells
        least = (1.0 - NUDGED) * state.cost
        away = [fit for fit in rough if float(np.sum((fit.left - state.left) ** 2)) > least]
        ended = _ended(steps, away, lambda model: problem.fitted(model, rounds=12))
        if ended is None or not ended.cost < NUDGED * state.cost:
            break
        state = ended
    return state


def waved(steps: Steps, state: Fit, k: int, without: Fit) -> Fit:
    """
    Return a state with a ripple of as many waves as are to be seen beside the other causes.

    Beside fewer causes another number seemed best, and no fit leads from one to the next.

    :param steps: of the search.
    :param state: with its causes.
    :param k: which of them may be a ripple.
    :param without: without it.
    :return: the better one; the same where no other number of waves leaves clearly less.
    """
    problem, cause = steps.problem, state.model.causes[k]
    if all(p.search != 'cycles' for p in cause.parameters):
        return state
    found = Screen(problem, without).proposals(cause)
    begun = [without.model.joined(p.candidate, p.values) for p in found if p.gain > 0.0]
    ended = _ended(steps, _rough(steps, problem, begun, rounds=12), steps.settled)
    return state if ended is None or ended.cost > NUDGED * state.cost else ended


def from_afar(steps: Steps, model: Model) -> Fit | None:
    """
    Fit with guesses that begin far from the file's own.

    :param steps: of the search.
    :param model: causes.
    :return: the best fit; None where guesses need not be looked for from afar.
    """
    problem = steps.problem
    # which way to go is told by a few of many recordings
    glance = problem.rougher() if len(problem.rollouts.segments) > FEW else problem
    return _ended(steps, _rough(steps, glance, afar(glance, model), rounds=12), steps.settled)


def _rough(
    steps: Steps,
    problem: Problem,
    begun: Sequence[Model],
    rounds: int,
    known: Mapping[str, FloatArray] | None = None,
) -> list[Fit]:
    """Return rough fits from several beginnings."""
    return list(steps.pool.map(lambda m: problem.fitted(m, known, rounds, accuracy=1e-2), begun))


def _ended(steps: Steps, rough: Sequence[Fit], end: Callable[[Model], Fit]) -> Fit | None:
    """Return the best of rough fits once they are fitted to their end; None where none is."""
    best = sorted(rough, key=lambda fit: fit.cost)[:ENDED]
    ended = steps.pool.map(lambda fit: end(fit.model), best)
    return min(ended, key=lambda fit: fit.cost, default=None)
