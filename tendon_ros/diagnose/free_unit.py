"""
The unit of a torque that nothing fixes, and the fit that goes back to what the file says of it.

Where what a motor turns is only guessed, a torque constant three times as large is the same
machine three times as heavy. A fit without that constant has all else to bring down by as much,
and may end in a far valley instead.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.parsimony import as_good
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem


def without_unit(steps: Steps, found: Found) -> Fit | None:
    """
    Return the last state without a torque constant that is as good with the one of the file.

    :param steps: of the search.
    :param found: with the fits without each cause.
    :return: the state, pruned for that; None where no such constant is a cause, or it is missed.
    """
    final = found.final
    for k, without in enumerate(found.without):
        # left out, it would have less left than that, were it not for the valley
        far = without is not found.start and without.cost > found.start.cost
        if final.model.causes[k].effect == 'torque_gain' and far:
            smaller = steps.settled(_scaled(steps.problem, final.model, k))
            if as_good(steps.problem, smaller, final):
                return steps.pruned(found.start, smaller, smaller.model.causes)
    return None


def _scaled(problem: Problem, model: Model, k: int) -> Model:
    """Return a model without a torque constant, all torques and guesses smaller by as much."""
    gain = model.values(k)['gain']
    moved = [
        t.axis.place(t.axis.value(float(z)) / gain) if t.guessed else float(z)
        for t, z in zip(problem.tolerances, model.moved, strict=True)
    ]
    scaled = replace(model.without(*range(len(model.causes))), moved=np.array(moved))
    for n, cause in enumerate(model.causes):
        if n != k:
            values = model.values(n)
            torques = {p.name for p in cause.parameters if p.unit.startswith('N m')}
            scaled = scaled.joined(
                cause, {name: v / gain if name in torques else v for name, v in values.items()}
            )
    return scaled
