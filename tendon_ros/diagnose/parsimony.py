"""What parameters cost: Bayes' information criterion, on samples that are correlated."""

from __future__ import annotations

import math

from tendon_ros.diagnose.intervals import CLUSTER
from tendon_ros.identify.fit import Fit, Problem


def criterion(problem: Problem, fit: Fit) -> float:
    """
    Return Bayes' information criterion, the smaller the better.

    What is left holds together for a second or so: seconds are counted, not samples.

    :param problem: the data.
    :param fit: a state.
    :return: its criterion; only differences of states on the same data mean anything.
    """
    seconds = 1.0 + float(problem.clusters(CLUSTER).max(initial=0))
    parameters = sum(map(len, fit.model.z))
    return seconds * math.log(fit.cost / len(fit.left)) + parameters * math.log(seconds)
