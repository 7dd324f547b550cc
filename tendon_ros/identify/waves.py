"""How far motors turned, and which ripples that can show."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
import scipy.fft

from tendon_ros.identify.fit import Problem

FloatArray = NDArray[np.float64]

#: waves of a ripple that a motor has to pass
SEEN = 0.5
#: and how many where a turn has fewer than this, as hardly any motor (three slots and two poles
#: have six): what comes once is any torque that follows the angle
AGAIN, FEW = 2.0, 6.0
#: waves between two ripples that are looked for, over the whole of what a motor turns or, where
#: that is less, a turn
COARSE = 0.5
#: the same for a motor that turns a hundred times or more: whole numbers of waves are met exactly
FINE = 0.005


def shows(problem: Problem, place: str, cycles: float) -> bool:
    """
    Return whether a ripple can be told from any torque that follows the angle.

    :param problem: the data.
    :param place: of a motor.
    :param cycles: waves of the ripple on a turn.
    :return: whether the motor passed enough of them in any recording.
    """
    return bool(_shown(np.array([cycles]), _turns(problem, place))[0])


def _shown(cycles: FloatArray, turns: float) -> NDArray[np.bool_]:
    """Return the same of several ripples, for a motor that turned so far."""
    return np.asarray(cycles * turns >= np.where(cycles < FEW, AGAIN, SEEN))


def _turns(problem: Problem, place: str) -> float:
    """Return how many turns a motor made; one where nothing tells."""
    motors = problem.rollouts.instrument.motors
    [pulley] = [m.pulley for m in motors if f'motor_{m.name}' == place]
    far = travel(problem, pulley)
    return 1.0 if far is None else far / (2.0 * math.pi)


def ripples(problem: Problem, place: str, most: float) -> FloatArray:
    """
    Return the ripples that are looked for: as close as the motor's travel can tell apart.

    :param problem: the data.
    :param place: of a motor.
    :param most: waves on a turn up to which they are looked for.
    :return: waves on a turn, evenly spaced, shape (ripples,); without those that cannot be told
        from any torque that follows the angle.
    """
    turns = _turns(problem, place)
    spacing = max(FINE, COARSE / max(turns, 1.0))
    grid: FloatArray = spacing * np.arange(math.floor(most / spacing) + 1, dtype=np.float64)
    # slower waves that fit better are no ripple, and would stand before one that is
    return grid[(grid >= 1.0) & _shown(grid, turns)]


def powers(
    cycles: FloatArray, angle: FloatArray, moves: FloatArray, left: FloatArray, sign: FloatArray
) -> FloatArray:
    """
    Return how much of what is left evenly spaced ripples explain, each alone beside a mean.

    A bin in which half a wave or more passes tells nothing of it, and at a steady speed a fast
    ripple would look like none: such bins do not count, by octaves.

    :param cycles: waves on a turn, shape (ripples,), two or more.
    :param angle: of the motor [rad], shape (samples,).
    :param moves: how far it turns in a bin [rad], not negative, shape (samples,).
    :param left: what is left of its torque, of any unit, shape (samples,).
    :param sign: by which its reading shows a torque, 1 or -1, shape (samples,).
    :return: of squares of that unit, shape (ripples,).
    """
    spacing = float(cycles[1] - cycles[0])
    octave = np.floor(np.log2(cycles))
    found = np.zeros(len(cycles))
    for one in np.unique(octave):
        own = octave == one
        told = moves * 2.0 ** (one + 1.0) < math.pi
        if not told.any():
            continue
        part = left[told] - left[told].mean()
        does = _sums(cycles[own], spacing, angle[told], sign[told] * part)
        mean = _sums(cycles[own], spacing, angle[told], sign[told]) / len(part)
        apart = np.maximum(len(part) * (1.0 - np.abs(mean) ** 2), 1.0)
        found[own] = np.abs(does) ** 2 / apart
    return found


def _sums(
    cycles: FloatArray, spacing: float, angle: FloatArray, values: FloatArray
) -> NDArray[np.complex128]:
    """Return sums of values times exp(i cycles angle), by one transform over the angle."""
    # an angle is known to an eighth of the shortest wave; after one period all waves begin anew
    count = scipy.fft.next_fast_len(math.ceil(8.0 * float(cycles[-1]) / spacing))
    step = 2.0 * math.pi / (spacing * count)
    place = np.round(angle / step).astype(np.int64) % count
    sums = np.conj(scipy.fft.rfft(np.bincount(place, weights=values, minlength=count)))
    return np.asarray(sums[np.round(cycles / spacing).astype(np.int64)])


def travel(problem: Problem, pulley: str) -> float | None:
    """
    Return how far a driven pulley turned in any recording.

    :param problem: the data.
    :param pulley: its name.
    :return: [rad]; None where nothing tells.
    """
    travels = [
        float(np.ptp(segment.motion.value[segment.prescribed.index(pulley)]))
        for segment in problem.rollouts.segments
        if pulley in segment.prescribed
    ]
    return max(travels, default=None)
