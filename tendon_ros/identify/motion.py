"""Motion as encoders saw it: smoothed readings, on an even grid or in the middles of bins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Channel
from tendon_ros.identify.smoothing import smoothed
from tendon_ros.model.instrument import Sensor

FloatArray = NDArray[np.float64]

OFTEN = 1e-3  # [s] between readings that are smoothed: bins are hardly ever as short
#: part of the time between readings that stamps may be off an even beat; and how often what is
#: off a smooth motion is looked at until nothing of it bends with the stamps
EVEN, CURVED = 0.01, 3


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
    error = reading_error(channel, sensor)
    known = sensor.resolution > 0.0 or sensor.noise > 0.0
    count = sensor.resolution if known else error * np.sqrt(12.0)
    near = gap < 1.5 * sampling
    found = smoothed(channel.at(grid), near, error, count)
    # straight between readings whose stamps scatter, the motion would bend at random: only what
    # they are off a smooth motion may go straight
    for _ in range(CURVED if np.any(gap[near] > EVEN * sampling) else 0):
        off = channel.value - CubicSpline(grid, found)(channel.time)
        found = smoothed(found + np.interp(grid, channel.time, off), near, error, count)
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


def reading_error(channel: Channel, sensor: Sensor) -> float:
    """
    Return the standard deviation of one reading.

    :param channel: what was read.
    :param sensor: its resolution and noise, where the instrument file gives them.
    :return: in the unit of the channel; from the smallest step between readings where the file is
        silent.
    """
    if sensor.resolution > 0.0 or sensor.noise > 0.0:
        return float(np.hypot(sensor.resolution / np.sqrt(12.0), sensor.noise))
    steps = np.abs(np.diff(channel.value))
    steps = steps[steps > 0.0]
    if not steps.size:
        return 0.0
    return float(np.quantile(steps, 0.02) / np.sqrt(12.0))
