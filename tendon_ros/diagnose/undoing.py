"""
Causes that undo each other: together they imitate something that is none of them.

What unrelated causes do to the channels adds up like squares. Where a fit lacks the true cause, it
makes one up from large effects of opposite sign whose small difference looks like it; each is then
missed badly when it alone is left out, and none of them is there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from tendon_ros.diagnose.form import change
from tendon_ros.identify.fit import Fit, Problem

#: cosine of what two causes do below which they are opposed
OPPOSED = -0.5
#: times the power of what they do together that opposed causes do each alone, all added up
UNDONE = 3.0


def undoing(problem: Problem, state: Fit) -> frozenset[int]:
    """
    Return the causes of a state that mostly undo each other.

    :param problem: the data.
    :param state: with causes.
    :return: which causes.
    """
    count = len(state.model.causes)
    if count < 2:
        return frozenset()
    changes = np.array([change(problem, state, k) for k in range(count)])
    return undone(np.where(np.isfinite(changes), changes, 0.0))


def undone(changes: NDArray[np.float64]) -> frozenset[int]:
    """
    Return which of several changes mostly undo each other.

    :param changes: what each cause does to each sample, shape (causes, samples).
    :return: the rows of changes that are opposed to others of them, where little of them stays.
    """
    product = changes @ changes.T
    power = np.diag(product)
    size = np.sqrt(np.maximum(power, 1e-300))
    opposed = product / np.outer(size, size) < OPPOSED
    _, label = connected_components(opposed, directed=False)
    found: set[int] = set()
    for one in np.unique(label):
        members = np.flatnonzero(label == one)
        if power[members].sum() > UNDONE * product[np.ix_(members, members)].sum():
            found.update(members.tolist())
    return frozenset(found)
