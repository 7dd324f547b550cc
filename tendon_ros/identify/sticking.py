"""Sticking: where dry friction holds a pulley, in the motion that the model finds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from tendon_ros.base.errors import EffectError, SimulationError
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import BRISTLES, Model
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

STICKS = 1.0  # [s] of rest: what only turns does not creep
BENDS = 2.0  # angles over which friction builds up that a pulley turns while it sticks


def sticking(problem: Problem, fit: Fit) -> list[BoolArray | None]:
    """
    Return where the dry friction of each cause holds its pulley.

    :param problem: the data.
    :param fit: a fitted state.
    :return: one a cause, shape (samples,); None for all but dry friction on pulleys whose motion
        the model finds, and where the model cannot be computed.
    """
    found: list[BoolArray | None] = [None] * len(fit.model.causes)
    instrument = problem.rollouts.instrument
    driven = {f'pulley_{name}' for name in instrument.driven}
    dry = [
        k for k, cause in enumerate(fit.model.causes) if cause.dry and cause.place not in driven
    ]
    if not dry:
        return found
    try:
        states = problem.rollouts.states(problem.uses(fit.model))
    except (SimulationError, EffectError):
        return found
    segments = problem.rollouts.segments
    for k in dry:
        cause = fit.model.causes[k]
        row = instrument.index(cause.place.removeprefix('pulley_'))
        travel = problem.sampled(
            [
                _travel(state.angle[:, row], segment.period)
                for state, segment in zip(states, segments, strict=True)
            ]
        )
        found[k] = travel < BENDS * _angle(fit.model, k, cause)
    return found


def _angle(model: Model, k: int, cause: Candidate) -> float:
    """Return the angle over which a cause's friction builds up [rad]."""
    if (cause.place, 'angle') in model.bristle:
        return model.beside(cause.place, 'angle')
    return model.values(k).get('angle', BRISTLES['angle'].centre)


def _travel(angle: FloatArray, period: float) -> FloatArray:
    """Return how far a pulley turns about each bin [rad]."""
    window = max(3, round(STICKS / period))
    return np.asarray(maximum_filter1d(angle, window) - minimum_filter1d(angle, window))
