"""
All at once: friction, play and springs wherever they can be, as a place to begin from.

Where inertia, stiffness and preload of a mechanism are guesses, the first cause that is found
drags them to where it does best alone, and whatever comes next is judged from there. Every real
transmission rubs in each of its bearings, has play in its couplings and something that pulls it
back. Begun with all of that, guesses have no reason to go astray; what is not needed goes again.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.worth import needed
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.worths import worths

#: what every real transmission has; laws that hold these are tried later, in their place
USUAL = ('coulomb_friction', 'tension_friction', 'backlash', 'joint_spring')


def everywhere(candidates: Sequence[Candidate], model: Model) -> Model:
    """
    Return a model with all that transmissions usually have, as large as is typical.

    :param candidates: all that may be named.
    :param model: where the numbers of the file are.
    :return: the model with more causes.
    """
    for candidate in candidates:
        if candidate.effect in USUAL:
            model = model.joined(candidate, {p.name: p.typical for p in candidate.parameters})
    return model


def thinned_out(steps: Steps, start: Fit, most: int) -> Fit | None:
    """
    Return what is needed of all that transmissions usually have.

    :param steps: of the search.
    :param start: without any cause.
    :param most: causes that may stay.
    :return: the fit; None where the model with all of it diverges.
    """
    problem = steps.problem
    rough = problem.fitted(everywhere(steps.candidates, problem.empty), rounds=12, accuracy=1e-2)
    if not np.isfinite(rough.cost):
        return None
    # to first order, what others do as well goes at once; what is left, one by one
    worth = np.array(worths(problem, rough))
    first = np.argsort(-worth)[:most]
    least = needed(problem, start, rough)
    idle = [k for k in range(len(worth)) if k not in first or worth[k] <= least]
    return steps.pruned(start, steps.settled(rough.model.without(*idle)))
