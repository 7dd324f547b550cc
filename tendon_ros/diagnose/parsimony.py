"""What parameters cost: Bayes' information criterion, on samples that are correlated."""

from __future__ import annotations

import math

from tendon_ros.diagnose.form import tie
from tendon_ros.diagnose.intervals import CLUSTER
from tendon_ros.identify.fit import Fit, Problem

#: times a tie that a law is ahead which need not pay: some seconds say little of what it costs
AHEAD = 4.0


def criterion(problem: Problem, fit: Fit, *, bare: bool = False) -> float:
    """
    Return Bayes' information criterion, the smaller the better.

    What is left holds together for a second or so: seconds are counted, not samples.

    :param problem: the data.
    :param fit: a state.
    :param bare: whether it costs nothing to contradict what the file has measured.
    :return: its criterion; only differences of states on the same data mean anything.
    """
    seconds = 1.0 + float(problem.clusters(CLUSTER).max(initial=0))
    causes = fit.model.causes
    parameters = sum(len(c.parameters) if bare else c.price for c in causes)
    return seconds * math.log(fit.cost / len(fit.left)) + parameters * math.log(seconds)


def as_good(problem: Problem, simpler: Fit, state: Fit) -> bool:
    """
    Return whether a state with fewer parameters does as well.

    Where laws and machine are far apart a tie is wide: it has to be the better bet as well.

    :param problem: the data.
    :param simpler: the state.
    :param state: what it is held against.
    :return: whether.
    """
    behind = (simpler.cost - state.cost) / len(state.left)
    if behind > tie(problem, state):
        return False
    return criterion(problem, simpler) < criterion(problem, state)


def pays(problem: Problem, wider: Fit, simpler: Fit) -> bool:
    """
    Return whether a law that holds another one pays for the parameters that it has more.

    :param problem: the data.
    :param wider: with the law.
    :param simpler: with the other one in its place.
    :return: whether it is the better bet, or ahead by far more than a tie.
    """
    ahead = (simpler.cost - wider.cost) / len(wider.left)
    # what is added to a friction of the file contradicts it as well
    bet = criterion(problem, wider, bare=True) < criterion(problem, simpler, bare=True)
    return bet or ahead > AHEAD * tie(problem, wider)
