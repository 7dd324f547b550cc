"""Means of a channel over bins: each belongs to the mean of its stamps, wherever they lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel
from tendon_ros.model.instrument import Sensor

FloatArray = NDArray[np.float64]


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
    # a stamp on an edge belongs to the bin that begins there, whatever its last digit says
    index = np.floor((channel.time - start) / period + 1e-6).astype(np.int64)
    inside = (index >= 0) & (index < bins)
    count = np.bincount(index[inside], minlength=bins).astype(np.float64)
    total = np.bincount(index[inside], weights=channel.value[inside], minlength=bins)
    moment = np.bincount(index[inside], weights=channel.time[inside] - start, minlength=bins)
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
    per_bin = max(1.0, float(np.median(count[known]))) if known.any() else 1.0
    noise = float(np.hypot(quantised, sensor.noise / np.sqrt(per_bin)))
    return value, noise
