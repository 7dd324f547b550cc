"""
Smooth motion from encoder counts, as smooth as the counts allow and no smoother.

A stiff cable turns one count into a torque far above a torque sensor's noise, so measured motion
cannot drive a model as it is. Between samples the truth is only known to half a count; of all
motions that stay so near, the one with the least jerk is taken (Whittaker's smoother of order
three). How much it smooths all that moves is chosen by generalised cross-validation, from what the
discrepancy principle asks for at least; it is more where a motor rests, less where it starts. A
motor that rests between two counts reads now one,
now the other, and there every angle within half a count is as good: what flickers does not move.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# the penalty's exponents in steps of half a decade: from next to none, for encoders that see all
# that moves within a few samples, up to a cut-off of about 0.1 periods
_WEAKEST, _STRONGEST = -10, 24
_SEEN = 51  # samples that the strongest smoother sees
_RESTS = 201  # samples within two counts that are a rest, not a slow reversal
_EVEN = 9  # samples over which the penalty goes from one exponent to the next
_JERK = np.array([-1.0, 3.0, -3.0, 1.0])
_SETTLES = 15  # solutions until what rests has found its place within the counts
#: a quantised reading is never off by more than sqrt(3) deviations; half as much again forgives
#: the ends of a motion, where the truth turns within one count. Of ten thousand that scatter, one
#: is off by four
_FARTHEST, _RAREST = 2.6, 4.0
_TOGETHER = (4, 16)  # readings whose mean tells what one does not
_USUAL = 0.9  # deviations that the smoother leaves at least
_WAVES = 1001  # frequencies of which a mean trace is the mean
RESTING = 0.04  # [s] within which what moves has moved by a count
SHAKES = 10.0  # counts from one turn to the next, no later than that, of what does not rest


def at_rest(angle: FloatArray, error: float, period: float) -> BoolArray:
    """
    Return where a smooth motion cannot be told from rest: within a count, or where it turns.

    What soon turns again, many counts away, shakes and does not rest.

    :param angle: on uniform bins, shape (bins,).
    :param error: standard deviation of a reading.
    :param period: of the bins [s].
    :return: shape (bins,), with the bins beside.
    """
    window = max(3, round(RESTING / period))
    travel = maximum_filter1d(angle, window) - minimum_filter1d(angle, window)
    count = max(np.sqrt(12.0) * error, 1e-12)
    rests: BoolArray = travel < count
    step = np.diff(angle)
    turns = 1 + np.flatnonzero(step[1:] * step[:-1] <= 0.0)
    swings = (np.abs(np.diff(angle[turns])) > SHAKES * count) & (np.diff(turns) <= window)
    shakes = np.zeros(len(turns), dtype=np.bool_)
    shakes[1:] |= swings
    shakes[:-1] |= swings
    rests[turns[~shakes]] = True
    # what rests in the middle of a window rests in all of it; and a smooth motion knows neither
    # when rest began nor when it ended
    return maximum_filter1d(rests.astype(np.int8), window) > 0


def smoothed(
    value: FloatArray,
    known: BoolArray,
    error: float,
    count: float,
    apart: FloatArray | None = None,
) -> FloatArray:
    """
    Return the least jerky motion within the error of a sensor.

    :param value: uniformly sampled readings, shape (n,).
    :param known: which samples were measured, shape (n,); the others are bridged.
    :param error: standard deviation of a reading; zero leaves known samples as they are.
    :param count: step between readings; zero where the sensor has none.
    :param apart: standard deviation of what the time of each reading makes of it, shape (n,).
    :return: shape (n,).
    """
    apart = np.zeros(len(value)) if apart is None else apart
    weight = known.astype(np.float64)
    filled = np.interp(np.arange(len(value)), np.flatnonzero(known), value[known])
    if error <= 0.0:
        bridged = _Least(weight, np.full(len(value), 1e-3)).near(filled, filled)
        return np.where(known, value, bridged)
    travel = maximum_filter1d(filled, _RESTS) - minimum_filter1d(filled, _RESTS)
    rests: BoolArray = travel < 1.25 * count
    within: FloatArray = np.where(rests, 0.5 * count, 0.0)
    each = np.hypot(error, apart)
    weight *= (error / each) ** 2
    exponent = np.where(rests, _STRONGEST, _of_motion(filled, weight, known & ~rests, each))
    found = filled
    while True:
        found = _resting(found, filled, weight, exponent, within)
        off = _too_far(np.where(known, found - value, 0.0), error, apart) & (exponent > _WEAKEST)
        if not off.any():
            return found
        near = maximum_filter1d(off.astype(np.int8), _SEEN) > 0
        exponent = np.where(near, np.maximum(exponent - 1, _WEAKEST), exponent)


def recounted(motion: FloatArray, error: float, apart: FloatArray) -> FloatArray:
    """
    Return a smooth motion as it would be found were it read again, counts half a count elsewhere.

    :param motion: uniformly sampled, shape (n,).
    :param error: standard deviation of a reading of what does not move, above zero.
    :param apart: of what the time of each reading makes of it, shape (n,).
    :return: shape (n,); what differs is what counts and chance make of a motion.
    """
    count = error * np.sqrt(12.0)
    # the same motion is always read the same way: diagnoses are to be repeatable
    again = motion + apart * np.random.default_rng(0).normal(size=len(motion))
    counted = count * np.round(again / count + 0.5) - 0.5 * count
    known = np.ones(len(motion), dtype=np.bool_)
    return smoothed(counted, known, error, count, apart)


def _too_far(left: FloatArray, error: float, apart: FloatArray) -> BoolArray:
    """
    Return where a motion is farther off its readings than their errors make it, shape (n,).

    Where their times are what they are off by, several have a mean that is off by less than one.
    """
    off: BoolArray = np.abs(left) > _FARTHEST * error + _RAREST * apart
    by_chance = apart > error
    for n in _TOGETHER if by_chance.any() else ():
        mean = np.sqrt(uniform_filter1d(error**2 + apart**2, n) / n)
        off |= by_chance & (np.abs(uniform_filter1d(left, n)) > _RAREST * mean)
    return off


def _of_motion(value: FloatArray, weight: FloatArray, moving: BoolArray, error: FloatArray) -> int:
    """
    Return the exponent with which readings of what moves are foretold best by the others.

    No less than the largest with which it stays as near as the sensor's error: counts of what
    moves slowly are alike from reading to reading, and cross-validation takes them for motion.
    """

    def off(exponent: int) -> float:
        """Return the mean square of what moves by that of the sensor's error."""
        penalty = _penalty(np.full(len(value), exponent))
        left = (_Least(weight, penalty).near(value, value) - value)[moving]
        # what starts suddenly is dealt with where it does
        return float(np.mean(np.minimum(np.abs(left) / error[moving], _FARTHEST) ** 2))

    low, high, best = _WEAKEST, _STRONGEST, _WEAKEST
    if not moving.any():
        return best
    while low <= high:
        middle = (low + high) // 2
        if off(middle) <= _USUAL**2:
            best = middle
            low = middle + 1
        else:
            high = middle - 1
    usual = float(np.mean(weight[moving]))
    foretold = {n: off(n) / (1.0 - _follows(n, usual)) ** 2 for n in range(best, _STRONGEST + 1)}
    return min(foretold, key=lambda n: foretold[n])


def _follows(exponent: int, weight: float) -> float:
    """Return by how much a smooth motion follows one of its readings: mean trace of the hat."""
    waves = np.linspace(0.0, np.pi, _WAVES)
    penalty = 10.0 ** (0.5 * exponent - 2.0) / max(weight, 1e-12)
    return float(np.mean(1.0 / (1.0 + penalty * (2.0 - 2.0 * np.cos(waves)) ** 3)))


def _resting(
    start: FloatArray,
    value: FloatArray,
    weight: FloatArray,
    exponent: NDArray[np.int64],
    within: FloatArray,
) -> FloatArray:
    """Return the smoothed motion to which readings that are near enough are no constraint."""
    least = _Least(weight, _penalty(exponent))
    found = least.near(start, value)
    for _ in range(_SETTLES if within.any() else 0):
        inside = np.clip(found, value - within, value + within)
        # half as far again as to the nearest edge: projections come to rest sooner
        nearest = np.where(within > 0.0, found + 1.5 * (inside - found), value)
        found = least.near(found, nearest)
    return found


def _penalty(exponent: NDArray[np.int64]) -> FloatArray:
    """Return the penalty of each sample's third difference."""
    even: FloatArray = uniform_filter1d(exponent.astype(np.float64), _EVEN)
    return 10.0 ** (0.5 * even - 2.0)


class _Least:
    """
    Minimises the weighted squares of what is left plus the penalty on third differences.

    :param weight: of each sample.
    :param penalty: of each sample's third difference.
    """

    def __init__(self, weight: FloatArray, penalty: FloatArray) -> None:
        n = len(weight)
        self._weight = weight
        self._own = penalty[1 : n - 2]
        bands = np.zeros((4, n))
        for a in range(4):
            for b in range(a, 4):
                bands[3 - (b - a), b : n - 3 + b] += self._own * _JERK[a] * _JERK[b]
        bands[3] += weight + 1e-12
        self._factor = cholesky_banded(bands, overwrite_ab=True, check_finite=False)

    def near(self, start: FloatArray, value: FloatArray) -> FloatArray:
        """
        Return the motion near a value.

        :param start: solved for is the way from there, or angles far from zero would drown in
            rounding.
        :param value: what to keep near.
        :return: shape (n,).
        """
        pull = self._weight * (value - start)
        jerk = self._own * np.convolve(start, _JERK[::-1], mode='valid')
        for a in range(4):
            pull[a : len(pull) - 3 + a] -= _JERK[a] * jerk
        step: FloatArray = cho_solve_banded((self._factor, False), pull, check_finite=False)
        return start + step
