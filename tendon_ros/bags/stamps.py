"""
Header stamps: nanoseconds in a bag, seconds since an epoch in a recording.

The two conversions are exact inverses for every whole nanosecond within 2^51 ns (26 days) of the
epoch, so that a recording survives a bag bit for bit, and live and offline see one time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import FloatArray

IntArray = NDArray[np.int64]

#: seconds in a header are signed and have 32 bits: it has no stamp from January 2038 on [ns]
END = 2**31 * 10**9


def to_seconds(stamp_ns: IntArray, epoch_ns: int) -> FloatArray:
    """
    Return seconds since the epoch.

    :param stamp_ns: header stamps [ns], shape (n,).
    :param epoch_ns: header stamp of time zero [ns].
    :return: [s], shape (n,).
    """
    return (np.asarray(stamp_ns, dtype=np.int64) - epoch_ns) / 1e9


def to_stamps(time: FloatArray, epoch_ns: int) -> IntArray:
    """
    Return header stamps.

    :param time: seconds since the epoch [s], shape (n,).
    :param epoch_ns: header stamp of time zero [ns].
    :return: header stamps [ns], shape (n,).
    """
    return np.rint(np.asarray(time, dtype=np.float64) * 1e9).astype(np.int64) + epoch_ns
