"""What a motor gives of the torque that it reports: gain, bias and a limit with a knee."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.numbers import Numbers

FloatArray = NDArray[np.float64]


def limited(torque: FloatArray, limit: float, knee: float) -> tuple[FloatArray, FloatArray]:
    """
    Return the torque that a limited motor gives, and its slope by the one that is asked for.

    The kernel has the same for one torque.

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


def given_by(
    numbers: Numbers, motor: int, reported: FloatArray, least: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """
    Return the torque that a motor gives, and its slope by the one that it reports.

    A drive limits what is asked of it; what its current sensor is off by comes on top.

    :param numbers: after the effects.
    :param motor: its index.
    :param reported: torque that it reports [N m].
    :param least: no limit is taken to be lower [N m].
    :return: given torque [N m], and its derivative.
    """
    gain, bias = numbers['motor_gain'][motor], numbers['motor_bias'][motor]
    limit, knee = max(numbers['motor_limit'][motor], least), numbers['motor_knee'][motor]
    given, slope = limited(gain * reported, float(limit), float(knee))
    return given + bias, gain * slope
