"""A motor's torque limit, which sets in at once or over a knee."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def limited(torque: FloatArray, limit: float, knee: float) -> tuple[FloatArray, FloatArray]:
    """
    Return the torque that a limited motor gives, and its slope by the one that is asked for.

    :param torque: asked for [N m].
    :param limit: largest torque that is given [N m].
    :param knee: part of the limit, below and above it, over which it sets in; 0 for at once.
    :return: given torque [N m], and its derivative.
    """
    size = np.abs(torque)
    width = max(knee, 1e-9) * limit
    within = np.clip((size - (limit - width)) / (2.0 * width), 0.0, 1.0)
    given = np.minimum(size, limit - width) + 2.0 * width * (within - 0.5 * within**2)
    return np.copysign(given, torque), 1.0 - within
