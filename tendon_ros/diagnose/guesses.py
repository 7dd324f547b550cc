"""
Guessed numbers may be far off where a search begins: which way to go with them.

Where inertia, stiffness and preload are guesses, a wrong cause with wrong guesses may leave less
at first than the right one, whose guesses have far to go.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.parsimony import criterion
from tendon_ros.diagnose.worth import open_question
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: deviations that a guess, and another number, has to have moved to be suspected of standing for
#: a cause
ASTRAY, PRESSED = 0.5, 2.0
#: times the least that a rough fit may leave to be followed where guesses are under way
ROUGH = 1.5


def astray(problem: Problem, start: Fit, grown: Fit | None) -> bool:
    """
    Return whether the numbers of the file may be far off where a search began.

    They had to do without the causes: there, no cause may help any more, or a wrong one.

    :param problem: the data.
    :param start: without any cause.
    :param grown: with the first causes, where there are any.
    :return: whether to look from the file's own numbers, too.
    """
    if far_off(problem, start):
        return True
    if not _pressed(problem, start):
        return False
    if grown is None or open_question(problem, grown):
        return True
    # one cause that leaves nothing is right wherever it was found, and so are several beside which
    # the numbers are where the file has them
    return len(grown.model.causes) > 1 and _pressed(problem, grown)


def far_off(problem: Problem, state: Fit) -> bool:
    """
    Return whether guesses of the file have moved far.

    :param problem: the data.
    :param state: where to.
    :return: whether any has moved by more than half its deviation.
    """
    return _farthest(problem, state.model.moved) > ASTRAY


def under_way(problem: Problem, state: Fit, best: Fit, others: Sequence[Fit]) -> list[Fit]:
    """
    Return the rough fits that may end below the best: guesses that have far to go are not there.

    :param problem: the data.
    :param state: where the fits began.
    :param best: the one that leaves least.
    :param others: all others.
    :return: those of them to be fitted carefully.
    """
    return [
        fit
        for fit in others
        if fit.cost < ROUGH * best.cost
        and _farthest(problem, fit.model.moved - state.model.moved) > ASTRAY
    ]


def better(problem: Problem, *fits: Fit | None) -> Fit | None:
    """
    Return the state to go on from, by Bayes' information criterion.

    :param problem: the data.
    :param fits: states with different causes.
    :return: the best of them; None where there is none.
    """
    states = [fit for fit in fits if fit is not None]
    return min(states, key=lambda fit: criterion(problem, fit), default=None)


def _pressed(problem: Problem, state: Fit) -> bool:
    """Return whether a number of the file that is no guess has moved far."""
    known = np.abs(state.model.moved)[~_guessed(problem)]
    return float(known.max(initial=0.0)) > PRESSED


def _farthest(problem: Problem, moved: FloatArray) -> float:
    """Return how many deviations the guess that moves most moves."""
    return float(np.abs(moved)[_guessed(problem)].max(initial=0.0))


def _guessed(problem: Problem) -> NDArray[np.bool_]:
    return np.array([t.guessed for t in problem.tolerances], dtype=np.bool_)
