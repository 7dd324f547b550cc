"""
How far an encoder's readings are off a smooth motion.

Stamps that tell the time of a reading to some hundredths of a millisecond only, a log that has
none, a driver that is polled: in motion readings scatter beyond a count, and the more the faster
it is. Digits that were rounded away scatter as much at any speed.

What a smooth motion is off a parabola a few samples long is nothing, and noise is off as much,
however far apart the samples are. What shakes is off the more the farther they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.optimize import nnls

from tendon_ros.base.recording import Channel

FloatArray = NDArray[np.float64]

#: times as much that readings scatter at most where samples are twice as far apart
WHITE = 2.0
#: counts that three steps are at least where something moves, and how many tell anything
MOVES, ENOUGH = 6.0, 100
SPEED = 5  # readings that tell a speed
#: deviations beyond which a reading is a slip and tells of itself only, and how often parts that
#: do and do not grow with speed are told apart until neither changes
SLIP, SETTLES = 3.0, 5


@dataclass(frozen=True)
class Scatter:
    """
    One deviation of the readings of something that moves.

    ``usual``: of all of them, 0 where it shakes; ``still``: the part that speed does not change;
    ``late``: of the time at which each was read [s].
    """

    usual: float
    still: float
    late: float


def scatter(channel: Channel, count: float) -> Scatter | None:
    """
    Return how far readings of something that moves are off a smooth motion.

    :param channel: what was read, at any times.
    :param count: what is smaller is no motion.
    :return: the scatter; None where it hardly moves.
    """
    near, far = (_off(channel, apart, count) for apart in (1, 2))
    if near is None or far is None:
        return None
    off, speed = near
    usual = _deviation(off)
    if not _deviation(far[0]) < WHITE * usual:
        return Scatter(0.0, 0.0, 0.0)
    still, late = _parts(off, speed, usual)
    return Scatter(usual, still, late)


def speed_of(value: FloatArray, time: FloatArray) -> FloatArray:
    """
    Return the speed of what was read, as far as single readings do not make it.

    :param value: the readings, shape (n,).
    :param time: of each [s], shape (n,).
    :return: in the unit of the readings a second, shape (n,).
    """
    return np.gradient(uniform_filter1d(value, SPEED), uniform_filter1d(time, SPEED))


def _off(channel: Channel, apart: int, count: float) -> tuple[FloatArray, FloatArray] | None:
    """
    Return what four readings so far apart are off a parabola, and their speed; None at rest.

    Of white noise the first is one deviation, shape (n,); the second is in units a second.
    """
    last = len(channel.time) - 3 * apart
    if last < ENOUGH:
        return None
    own = [slice(n * apart, n * apart + last) for n in range(4)]
    time, value = (np.array([row[s] for s in own]) for row in (channel.time, channel.value))
    moving = np.abs(value[3] - value[0]) > MOVES * count
    if np.count_nonzero(moving) < ENOUGH:
        return None
    speed = np.abs(speed_of(channel.value, channel.time)[own[1]][moving])
    time, value = time[:, moving], value[:, moving]
    weight = np.array(
        [1.0 / np.prod(time[n] - np.delete(time, n, axis=0), axis=0) for n in range(4)]
    )
    off: FloatArray = np.sum(weight * value, axis=0) / np.sqrt(np.sum(weight**2, axis=0))
    return np.abs(off), speed


def _deviation(off: FloatArray) -> float:
    """Return one deviation: of a normal scatter 95 % are within 1.96; a slip is a few readings."""
    return float(np.quantile(off, 0.95) / 1.96)


def _parts(off: FloatArray, speed: FloatArray, usual: float) -> tuple[float, float]:
    """Return the deviation that speed does not change, and that of the time of a reading [s]."""
    columns = np.stack([np.ones_like(speed), speed**2], axis=1)
    parts = np.array([usual**2, 0.0])
    power = columns @ parts
    for _ in range(SETTLES):
        within = np.minimum(off**2, SLIP**2 * power)
        # a square scatters as much as it is
        parts, _left = nnls(columns / power[:, None], within / power)
        power = np.maximum(columns @ parts, 1e-6 * usual**2)
    return float(np.sqrt(parts[0])), float(np.sqrt(parts[1]))
