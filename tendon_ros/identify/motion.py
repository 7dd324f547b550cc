"""Motion as encoders saw it: smoothed readings, on an even grid or in the middles of bins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Channel
from tendon_ros.identify.scatter import scatter, speed_of
from tendon_ros.identify.smoothing import smoothed
from tendon_ros.model.instrument import Sensor

FloatArray = NDArray[np.float64]

OFTEN = 1e-3  # [s] between readings that are smoothed: bins are hardly ever as short
#: part of the time between readings that stamps may be off an even beat; and how often what is
#: off a smooth motion is looked at until nothing of it bends with the stamps
EVEN, CURVED = 0.01, 3
#: times what the file says that readings scatter where they are noisier than it says: counts
#: alone, at a speed that is hardly any, make up to 1.2 of it
NOISIER = 1.5


def thinned(channel: Channel) -> Channel:
    """
    Return what is to be smoothed, read no more often than tells anything.

    :param channel: what was read.
    :return: every tenth reading of ten thousand a second.
    """
    every = max(1, round(OFTEN / channel.sampling))
    return Channel(channel.name, channel.time[::every], channel.value[::every])


def motion_of(
    channel: Channel, sensor: Sensor, start: float, sampling: float, samples: int
) -> FloatArray:
    """
    Return the smoothed motion that an encoder saw.

    :param channel: what was read.
    :param sensor: its resolution and noise.
    :param start: time of the first angle [s].
    :param sampling: time between angles [s].
    :param samples: how many.
    :return: shape (samples,).
    """
    grid: FloatArray = start + sampling * np.arange(samples, dtype=np.float64)
    nearest = np.clip(np.searchsorted(channel.time, grid), 1, len(channel.time) - 1)
    gap = np.minimum(
        np.abs(channel.time[nearest] - grid), np.abs(channel.time[nearest - 1] - grid)
    )
    reading = reading_error(channel, sensor)
    read = channel.at(grid)
    near = gap < 1.5 * sampling
    errors = reading.still, reading.count, reading.apart(read, sampling)
    found = smoothed(read, near, *errors)
    # straight between readings whose stamps scatter, the motion would bend at random: only what
    # they are off a smooth motion may go straight
    for _ in range(CURVED if np.any(gap[near] > EVEN * sampling) else 0):
        off = channel.value - CubicSpline(grid, found)(channel.time)
        found = smoothed(found + np.interp(grid, channel.time, off), near, *errors)
    return found


def motion_in_bins(
    channel: Channel, sensor: Sensor, start: float, period: float, bins: int
) -> FloatArray:
    """
    Return the smoothed motion at the middles of bins.

    :param channel: what was read.
    :param sensor: its resolution and noise.
    :param start: where the first bin begins [s].
    :param period: length of a bin [s].
    :param bins: how many.
    :return: shape (bins,).
    """
    sampling = channel.sampling
    first = float(channel.time[np.searchsorted(channel.time, start)])
    samples = round((start + bins * period - first) / sampling) + 1
    angle = motion_of(channel, sensor, first, sampling, samples)
    middles = start - first + period * (np.arange(bins) + 0.5)
    found: FloatArray = np.interp(middles, sampling * np.arange(len(angle)), angle)
    return found


@dataclass(frozen=True)
class ReadingError:
    """
    How far a reading may be off.

    ``still``: one deviation of what does not move; ``late``: of the time of a reading [s];
    ``count``: the step between readings, 0 where there is none.
    """

    still: float
    late: float
    count: float

    def apart(self, motion: FloatArray, sampling: float) -> FloatArray:
        """
        Return what the time of each reading of a motion makes of it.

        :param motion: evenly read, smooth or not, shape (n,).
        :param sampling: time between readings [s].
        :return: one deviation of each, shape (n,).
        """
        if self.late <= 0.0:
            return np.zeros(len(motion))
        time = sampling * np.arange(len(motion), dtype=np.float64)
        return self.late * np.abs(speed_of(motion, time))


def reading_error(channel: Channel, sensor: Sensor) -> ReadingError:
    """
    Return how far a reading may be off.

    :param channel: what was read.
    :param sensor: its resolution and noise, where the instrument file gives them.
    :return: in the unit of the channel; what readings scatter by in motion where that is more
        than the file says, and from the smallest step between readings where the file is silent.
    """
    if sensor.error == 0.0:
        steps = np.abs(np.diff(channel.value))
        steps = steps[steps > 0.0]
        count = float(np.quantile(steps, 0.02)) if steps.size else 0.0
        return ReadingError(count / np.sqrt(12.0), 0.0, count)
    moves = sensor.kind == 'angle'
    told = scatter(channel, max(sensor.resolution, sensor.noise)) if moves else None
    if told is None or told.usual <= NOISIER * sensor.error:
        return ReadingError(sensor.error, 0.0, sensor.resolution)
    return ReadingError(max(sensor.error, told.still), told.late, sensor.resolution)
