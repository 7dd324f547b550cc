"""
What a law may get wrong, and what of another cause looks like it.

Friction turns with the motion, and what its law gets wrong turns with it: between two reversals it
is too large or too small, or larger where the motion is fast than where it begins and ends. A
spring does neither: between two reversals it goes from one side to the other.

A ripple comes again with every wave, and so does what its law gets wrong: the wave has another
shape. A weight does not.
"""

from __future__ import annotations

from itertools import pairwise
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bodies import turned
from tendon_ros.diagnose.form import change
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: part of its size from which on a friction has a direction
HAS = 0.3
#: times as many waves, up to which the shape of a ripple's wave is told
HARMONICS = 3


def alike(problem: Problem, final: Fit, without: Fit) -> list[float]:
    """
    Return how much of what the law of each cause gets wrong may look like causes that have gone.

    :param problem: the data.
    :param final: with all causes.
    :param without: without some of them.
    :return: of each cause of the state 0 to 1; 0 of those that have gone, and of those elsewhere.
    """
    causes = final.model.causes
    gone = set(causes) - set(without.model.causes)
    # a motor and the pulley that it turns are one place
    body = turned(problem.rollouts.instrument)
    places = {body.get(cause.place, cause.place) for cause in gone}
    # what the others make up for is none of its own
    does = final.left - without.left
    return [
        imitable(problem, final, k, does)
        if cause not in gone and body.get(cause.place, cause.place) in places
        else 0.0
        for k, cause in enumerate(causes)
    ]


def imitable(problem: Problem, state: Fit, k: int, does: FloatArray) -> float:
    """
    Return the part of what others do, as power, that errors of a cause's law can do as well.

    :param problem: the data.
    :param state: with the cause.
    :param k: which.
    :param does: what others do to each sample, in noise deviations, shape (samples,).
    :return: 0 to 1; 1 of what does nothing, and where nobody knows how a law is wrong.
    """
    cause = state.model.causes[k]
    if cause.dry:
        return by_friction(problem, does, change(problem, state, k))
    if cause.waves:
        return 1.0 - _apart(does, _waves(problem, state, k))
    return 1.0


def _waves(problem: Problem, state: Fit, k: int) -> FloatArray:
    """Return what ripples of once and several times the waves do, shape (samples, ripples)."""
    cause, values = state.model.causes[k], state.model.values(k)
    rest = state.model.without(k)
    none = problem.left(rest)
    return np.stack(
        [
            problem.left(
                rest.joined(cause, values | {'cycles': n * values['cycles'], 'phase': phase})
            )
            - none
            for n in range(1, HARMONICS + 1)
            for phase in (0.0, 0.5 * math.pi)
        ],
        axis=1,
    )


def _apart(does: FloatArray, form: FloatArray) -> float:
    """Return the part of a change, as power, that columns do not make up; 0 of nothing."""
    whole = float(does @ does)
    if not (whole > 0.0 and np.isfinite(form).all()):
        return 0.0
    found, *_ = np.linalg.lstsq(form, does, rcond=None)
    return float(np.sum((does - form @ found) ** 2)) / whole


def by_friction(problem: Problem, does: FloatArray, friction: FloatArray) -> float:
    """
    Return the part of a change, as power, that errors of a friction's law can do as well.

    :param problem: the data.
    :param does: what a cause does to each sample, in noise deviations, shape (samples,).
    :param friction: what a dry friction does, shape (samples,).
    :return: 0 to 1; 1 of what does nothing.
    """
    whole = float(does @ does)
    if not whole > 0.0:
        return 1.0
    own = 0.0
    for _, _, span in problem.spans():
        for stretch in _stretches(friction[span]):
            there, rubs = does[span][stretch], friction[span][stretch]
            # too large or too small, and the more so the faster the motion
            middle = np.linspace(-1.0, 1.0, len(rubs)) ** 2
            form = np.stack([rubs, rubs * middle], axis=1)
            found, *_ = np.linalg.lstsq(form, there, rcond=None)
            own += float(np.sum((there - form @ found) ** 2))
    return 1.0 - own / whole


def _stretches(friction: FloatArray) -> list[slice]:
    """Return the stretches between reversals of what a friction does to a channel."""
    size = float(np.sqrt(np.mean(friction**2))) if friction.size else 0.0
    told = np.flatnonzero(np.abs(friction) > HAS * size)
    turned = np.flatnonzero(np.diff(np.sign(friction[told])) != 0.0)
    ends = [0, *(told[turned + 1]).tolist(), len(friction)]
    return [slice(a, b) for a, b in pairwise(ends) if b > a]
