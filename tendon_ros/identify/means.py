"""Means of a channel over bins: each belongs to the mean of its stamps, wherever they lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from tendon_ros.base.recording import Channel
from tendon_ros.model.instrument import Sensor

FloatArray = NDArray[np.float64]

#: part of the time between readings within which one is on the edge of a bin, whose stamp may
#: scatter; and the same where there are bins without any, as part of a bin
EDGE, SELDOM = 0.25, 1e-6
ALL = 1.1  # bins from one reading to the next, up to which nearly all have one


def binned(
    channel: Channel, sensor: Sensor, start: float, period: float, bins: int
) -> tuple[FloatArray, float, float]:
    """
    Return the means over bins.

    :param channel: what was read, at any stamps.
    :param sensor: its resolution and noise.
    :param start: where the first bin begins [s].
    :param period: length of a bin [s].
    :param bins: how many.
    :return: means, shape (bins,), NaN where empty, the noise that they keep, and how many
        readings are in one.
    """
    place = (channel.time - start) / period
    edge = np.round(place)
    often = channel.sampling < ALL * period
    between = np.abs(place - edge) < (EDGE * channel.sampling / period if often else SELDOM)
    # a reading on an edge belongs to both bins, whatever its stamp says: half a sample between a
    # torque and the motion that asks for it is a sixth of what shakes a hundred times a second,
    # and where readings stray across edges, one bin has two and the next one none
    alone, shared = np.flatnonzero(~between), np.flatnonzero(between)
    index = np.concatenate([np.floor(place[alone]), edge[shared] - 1.0, edge[shared]])
    inside = (index >= 0.0) & (index < bins)
    index = index[inside].astype(np.int64)
    # which readings these are, and what part of each a bin has
    which = np.concatenate([alone, shared, shared])[inside]
    part = np.where(between[which], 0.5, 1.0)

    def added(weights: FloatArray) -> FloatArray:
        return np.bincount(index, weights=weights, minlength=bins)

    count, squares = added(part), added(part**2)
    total, moment = added(part * channel.value[which]), added(part * (channel.time[which] - start))
    known = count > 0
    middles = period * (np.arange(bins) + 0.5)
    value = np.full(bins, np.nan)
    value[known] = total[known] / count[known]
    # the mean belongs to the mean of the stamps, which need not be the bin's middle
    mean = moment[known] / count[known]
    apart, first, back = np.unique(mean, return_index=True, return_inverse=True)
    if apart.size > 2:
        one = value[known][first]
        # where what was flat falls all at once, its slope would lead beyond all that was read
        low, high = minimum_filter1d(one, 3)[back], maximum_filter1d(one, 3)[back]
        moved = value[known] - np.gradient(one, apart)[back] * (mean - middles[known])
        value[known] = np.clip(moved, low, high)
    quantised = sensor.resolution / np.sqrt(12.0)
    readings = count[known] ** 2 / squares[known]
    per_bin = max(1.0, float(np.median(readings))) if known.any() else 1.0
    noise = float(np.hypot(quantised, sensor.noise / np.sqrt(per_bin)))
    return value, noise, per_bin


def averaged(value: FloatArray, readings: FloatArray) -> FloatArray:
    """
    Return what means over bins would be of a smooth signal.

    A mean of something curved is not what it is in the middle: of a bin of length T off by its
    second derivative times T^2/24, and of n readings in it by 1 - 1/n^2 of that. Between a joint
    and what turns it, a stiff cable makes of that more torque than a light joint's inertia. What
    jumps stays as it is.

    :param value: in the middles of bins, shape (channels, bins).
    :param readings: of each channel in a bin, shape (channels,).
    :return: shape (channels, bins); the two at each end as they are.
    """
    part = (1.0 - 1.0 / readings**2) / 24.0
    bend = np.diff(value, 2, axis=1)
    # a jump bends one way and at once the other: nothing is smooth there
    smooth = (bend[:, 1:-1] * bend[:, :-2] > 0.0) & (bend[:, 1:-1] * bend[:, 2:] > 0.0)
    found = value.copy()
    found[:, 2:-2] += part[:, None] * np.where(smooth, bend[:, 1:-1], 0.0)
    return found
