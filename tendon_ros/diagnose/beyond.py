"""Whether more stays than laws of what was found can be wrong by: something else is there, too."""

from __future__ import annotations

from tendon_ros.diagnose.form import form_power
from tendon_ros.diagnose.worth import LEAST
from tendon_ros.identify.fit import Fit, Problem

#: times the form of the laws, and part of the gap, that may be left for a search to go on after a
#: challenge: machines leave much of their noise's power, but little of the gap
HOPELESS, MOST_LEFT = 10.0, 0.15
#: the same, for a machine of which guesses are found: there challenges only polish
MACHINE = 3.0
#: noise powers a sample that stay, from which on noise says nothing of how well channels are told
DROWNED = 10.0


def hopeless(problem: Problem, start: Fit, state: Fit) -> bool:
    """
    Return whether so much is left that none of the laws can be what is behind it.

    :param problem: the data.
    :param start: without any cause.
    :param state: with all that was found.
    :return: whether further causes would only imitate it.
    """
    if problem.structured(state.left) < MOST_LEFT * problem.structured(start.left):
        return False
    return _beyond(problem, start, state) > HOPELESS


def beyond_laws(problem: Problem, start: Fit, state: Fit) -> bool:
    """
    Return whether clearly more is left than the laws of what was found can be wrong by.

    So it is with every machine, however much of its gap is explained.

    :param problem: the data.
    :param start: without any cause.
    :param state: with all that was found.
    :return: whether.
    """
    return _beyond(problem, start, state) > MACHINE


def outweighed(problem: Problem, start: Fit, state: Fit) -> bool:
    """
    Return whether channels weigh by their noise alone where laws leave more than that.

    Whether laws may be wrong by so much or not: beside ten times the noise it is no weight.

    :param problem: the data.
    :param start: without any cause.
    :param state: with all that was found.
    :return: whether they should weigh by what stays of them.
    """
    alone = len(problem.channels()) < 2
    stays = problem.structured(state.left)
    if alone or problem.by_misfit or stays < 1.0:
        return False
    return stays > DROWNED or beyond_laws(problem, start, state)


def _beyond(problem: Problem, start: Fit, state: Fit) -> float:
    """Return times what laws can be wrong by that is left."""
    return problem.structured(state.left) / (LEAST + form_power(problem, start, state))
