"""
Smooth motion from encoder counts, as smooth as the counts allow and no smoother.

A stiff cable turns one count into a torque far above a torque sensor's noise, so measured motion
cannot drive a model as it is. Between samples the truth is only known to half a count; of all
motions that stay so near, the one with the least jerk is taken (Whittaker's smoother of order
three, with the smoothing chosen by the discrepancy principle).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

FloatArray = NDArray[np.float64]

# the penalty's exponents in steps of half a decade, up to a cut-off of about 0.1 periods
_WEAKEST, _STRONGEST = 0, 24


def smoothed(value: FloatArray, known: NDArray[np.bool_], error: float) -> FloatArray:
    """
    Return the least jerky motion within the error of a sensor.

    :param value: uniformly sampled readings, shape (n,).
    :param known: which samples were measured, shape (n,); the others are bridged.
    :param error: standard deviation of a reading; zero leaves known samples as they are.
    :return: shape (n,).
    """
    weight = known.astype(np.float64)
    best = _penalised(value, weight, 1e-3)
    if error <= 0.0:
        return np.where(known, value, best)
    low, high = _WEAKEST, _STRONGEST
    while low <= high:
        middle = (low + high) // 2
        trial = _penalised(value, weight, 10.0 ** (0.5 * middle - 2.0))
        left = (trial - value)[known]
        # a quantised reading is never off by more than sqrt(3) deviations; half as much again
        # forgives the ends of a motion, where the truth turns within one count
        near = np.sqrt(np.mean(left**2)) <= 0.9 * error and np.abs(left).max() <= 2.6 * error
        if near:
            best = trial
            low = middle + 1
        else:
            high = middle - 1
    return best


def _penalised(value: FloatArray, weight: FloatArray, penalty: float) -> FloatArray:
    """Minimise the weighted squares of what is left plus the penalty on third differences."""
    n = len(value)
    bands = np.zeros((4, n))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for a in range(4):
        for b in range(a, 4):
            bands[3 - (b - a), b : n - 3 + b] += penalty * difference[a] * difference[b]
    bands[3] += weight + 1e-12
    solved: FloatArray = solveh_banded(bands, weight * value)
    return solved
