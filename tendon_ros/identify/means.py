"""Means of a channel over bins: each belongs to the mean of its stamps, wherever they lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel
from tendon_ros.model.instrument import Sensor

FloatArray = NDArray[np.float64]

EDGE = 1e-6  # part of a bin within which a stamp is on its edge


def binned(
    channel: Channel, sensor: Sensor, start: float, period: float, bins: int
) -> tuple[FloatArray, float]:
    """
    Return the means over bins.

    :param channel: what was read, at any stamps.
    :param sensor: its resolution and noise.
    :param start: where the first bin begins [s].
    :param period: length of a bin [s].
    :param bins: how many.
    :return: means, shape (bins,), NaN where empty, and the noise that they keep.
    """
    place = (channel.time - start) / period
    edge = np.round(place)
    between = np.abs(place - edge) < EDGE
    # a reading on an edge belongs to both bins, whatever the last digit of its stamp says: half a
    # sample between a torque and the motion that asks for it is a sixth of what shakes a hundred
    # times a second
    index = np.concatenate([np.floor(place[~between]), edge[between] - 1.0, edge[between]])
    part = np.where(np.arange(len(index)) < np.count_nonzero(~between), 1.0, 0.5)
    inside = (index >= 0.0) & (index < bins)

    def added(weight: FloatArray, what: FloatArray) -> FloatArray:
        rows = np.concatenate([what[~between], what[between], what[between]])
        return np.bincount(
            index[inside].astype(np.int64), weights=(weight * rows)[inside], minlength=bins
        )

    one = np.ones_like(channel.time)
    count, squares = added(part, one), added(part**2, one)
    total, moment = added(part, channel.value), added(part, channel.time - start)
    with np.errstate(invalid='ignore', divide='ignore'):
        value = total / count
        late = moment / count - period * (np.arange(bins) + 0.5)
    known = count > 0
    if known.sum() > 2:
        # the mean belongs to the mean of the stamps, which need not be the bin's middle
        slope = np.gradient(
            np.where(
                known, value, np.interp(np.arange(bins), np.flatnonzero(known), value[known])
            ),
            period,
        )
        value = np.where(known, value - slope * late, np.nan)
    quantised = sensor.resolution / np.sqrt(12.0)
    shared = count[known] ** 2 / squares[known]
    per_bin = max(1.0, float(np.median(shared))) if known.any() else 1.0
    noise = float(np.hypot(quantised, sensor.noise / np.sqrt(per_bin)))
    return value, noise
