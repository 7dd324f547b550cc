"""
Set-points of the three recordings of a case.

Of benches the paper's profile, free motion, and both; of an axis fast tones, slow ones, and steps
with holds between them.
"""

from __future__ import annotations

from collections.abc import Callable
import math

import numpy as np
from scipy.ndimage import gaussian_filter1d

from tendon_ros.blind.rig import BEFORE, FloatArray, TICK

#: how long each recording lasts [s]
LENGTHS = {
    'contact': 18.0, 'free': 14.0, 'mixed': 16.0,
    'fast': 12.0, 'slow': 16.0, 'steps': 14.0,
}  # fmt: skip
KINDS = ('contact', 'free', 'mixed')
AXIS_KINDS = ('fast', 'slow', 'steps')

#: steps of the paper's profile: begin [s], angle [deg]
_ROUNDING = 0.04  # [s] of its corners
_STEPS = ((1.0, 5.0), (5.0, 7.0), (9.0, 5.0), (13.0, 4.0))


def setpoints(kind: str, reach: FloatArray, rng: np.random.Generator) -> FloatArray:
    """
    Return the commanded angles of motors M and L, from before the recording to its end.

    :param kind: one of :data:`KINDS` or :data:`AXIS_KINDS`.
    :param reach: factor on the angles of M and L, so that smaller wheels pull as much cable.
    :param rng: draws tones; the profile of ``contact`` is always the same.
    :return: [rad], one row a tick, shape (n, 2).
    """
    count = round((LENGTHS[kind] + BEFORE) / TICK)
    time: FloatArray = np.arange(count, dtype=np.float64) * TICK - BEFORE
    no_motion: FloatArray = np.zeros(time.size)
    if kind == 'contact':
        M, L, last = no_motion.copy(), no_motion, 0.0
        for begin, goal in _STEPS:
            M += math.radians(goal - last) * np.clip(time - begin, 0.0, 1.0)
            last = goal
        M = gaussian_filter1d(M, _ROUNDING / TICK)
    elif kind == 'free':
        M = _tones(time, rng, 4, (0.15, 1.5), lambda f: 0.12 * min(1.0, 0.9 / f))
        L = _tones(time, rng, 4, (0.15, 1.5), lambda f: 0.08 * min(1.0, 0.6 / f))
    elif kind == 'fast':
        M, L = _tones(time, rng, 4, (0.3, 3.0), lambda f: 0.4 * min(1.0, 0.8 / f)), no_motion
    elif kind == 'slow':
        M, L = _tones(time, rng, 3, (0.05, 0.4), lambda f: 0.5), no_motion
    elif kind == 'steps':
        M, L = _steps(time, rng), no_motion
    else:
        M = 0.06 * (1.0 - np.exp(-0.5 * np.maximum(time, 0.0) ** 2))
        M = M + _tones(time, rng, 1, (0.08, 0.16), lambda f: 0.04)
        M = M + _tones(time, rng, 3, (0.25, 1.4), lambda f: 0.004 / f)
        L = _tones(time, rng, 1, (0.12, 0.3), lambda f: 0.045)
        L = L + _tones(time, rng, 1, (0.3, 0.55), lambda f: 0.018)
    return np.stack([M, L], axis=1) * reach


def _steps(time: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return moves of half a second to a second to random angles, each followed by a hold."""
    total, last, begin = np.zeros(time.size), 0.0, 0.5
    while begin < time[-1]:
        goal, length = rng.uniform(-1.0, 1.0), rng.uniform(0.5, 1.0)
        total += (goal - last) * np.clip((time - begin) / length, 0.0, 1.0)
        last, begin = goal, begin + length + rng.uniform(0.3, 1.2)
    return np.asarray(gaussian_filter1d(total, _ROUNDING / TICK), dtype=np.float64)


def _tones(
    time: FloatArray,
    rng: np.random.Generator,
    count: int,
    band: tuple[float, float],
    amplitude: Callable[[float], float],
) -> FloatArray:
    """Return tones of a band [Hz], about as large as their amplitude says, faded in."""
    fade = 0.5 - 0.5 * np.cos(np.pi * np.clip(time, 0.0, 1.0))
    total = np.zeros(time.size)
    for f in rng.uniform(*band, count):
        phase = rng.uniform(0.0, 2.0 * np.pi)
        size = amplitude(f) * rng.uniform(0.7, 1.2)
        total += size * np.sin(2.0 * np.pi * f * time + phase)
    return fade * total
