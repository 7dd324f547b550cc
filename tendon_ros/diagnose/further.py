"""
Further causes of a machine: by which what no fit has seen is foretold better.

Where guesses are found and many causes are needed, what their laws get wrong is as large as what
the next cause explains. Blocks that were held out tell the two apart.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bent import spent
from tendon_ros.diagnose.cancelling import undoing
from tendon_ros.diagnose.found import best_of
from tendon_ros.diagnose.intervals import CLUSTER
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.worth import LEAST
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: fits of the best of them that foretell nothing better, after which no more are tried
REFUSED = 2
#: by how much one must lower the misfit where it was fitted, in noise power per sample: less than
#: elsewhere, since blocks that were held out judge it as well
SOME = 0.01
#: proposals that are fitted to see which is best
ASKED = 6


def saved(held: Problem, poorer: Model, model: Model) -> FloatArray:
    """
    Return what a model saves of what no fit has seen.

    :param held: blocks that were held out.
    :param poorer: the model that it is held against.
    :param model: the model.
    :return: of squares in noise deviations, shape (seconds,).
    """
    before, after = held.left(poorer), held.left(model)
    return np.bincount(held.clusters(CLUSTER), weights=before**2 - after**2)


def further(steps: Steps, state: Fit, held: Problem, most: int) -> Fit:
    """
    Return a state with the causes that foretell better what no fit has seen.

    :param steps: of the search.
    :param state: with causes.
    :param held: blocks that were held out.
    :param most: causes that there may be.
    :return: the state; the same where none does.
    """
    problem, patience = steps.problem, steps.patience
    tried: set[Candidate] = set()
    refused = 0
    while refused < REFUSED and len(state.model.causes) < most and not patience.half:
        # what happens once foretells nothing
        asked = best_of(steps.glanced(state, tuple(tried)))[:ASKED]
        rivals = steps.fitted(state, asked, LEAST * len(state.left))
        if not rivals:
            break
        joined = rivals[0].candidate
        tried.add(joined)
        grown = problem.fitted(rivals[0].fit.model, rounds=12, accuracy=1e-3)
        values = grown.model.values(grown.model.causes.index(joined))
        little = state.cost - grown.cost < SOME * len(state.left)
        empty = little or spent(joined, values) or undoing(problem, grown)
        if not empty and foretells(held, state.model, grown.model):
            state = grown
        else:
            refused += 1
    return state


def foretells(held: Problem, poorer: Model, model: Model) -> bool:
    """
    Return whether a model foretells what no fit has seen better, by more than chance.

    :param held: blocks that were held out.
    :param poorer: the model that it is held against.
    :param model: the model.
    :return: whether it saves more than seconds of no meaning would on average.
    """
    gain = saved(held, poorer, model)
    return float(gain.sum()) > float(np.sqrt(gain @ gain))
