"""In which regime the gap lies: how the motors move, and what presses on the tip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import Segment

FloatArray = NDArray[np.float64]
TextArray = NDArray[np.str_]

TURN = 0.25  # [s] about a reversal
STILL = 0.03  # part of the largest speed below which a motor holds


def regimes(segment: Segment, speed: FloatArray, force: FloatArray | None) -> TextArray:
    """
    Return the regime of each bin: how the motors move, and what presses on the tip.

    :param segment: the recording.
    :param speed: of the driven pulleys [rad/s], shape (pulleys, bins).
    :param force: predicted force of all contacts, shape (bins,); None without contacts.
    :return: texts, shape (bins,).
    """
    largest = np.abs(speed).max(axis=1, keepdims=True) + 1e-9
    relative = np.abs(speed) / largest
    leading = relative.argmax(axis=0)
    bins = np.arange(speed.shape[1])
    own = speed[leading, bins]
    moving = relative[leading, bins] > STILL
    names = np.full(len(bins), 'holding', dtype='<U40')
    names[moving & (own > 0.0)] = 'moving forward'
    names[moving & (own < 0.0)] = 'moving backward'
    width = max(1, round(TURN / segment.period))
    for row in speed:
        sign = np.sign(np.where(np.abs(row) > STILL * np.abs(row).max(), row, 0.0))
        told = sign[sign != 0.0]
        at = np.flatnonzero(sign)
        for turn in at[1:][np.diff(told) != 0.0]:
            names[max(0, turn - width) : turn + width] = 'reversal'
    if force is not None and np.abs(force).max(initial=0.0) > 0.0:
        strong = np.abs(force) > 0.5 * np.abs(force).max()
        touching = (np.abs(force) > 0.02 * np.abs(force).max()) & ~strong
        names[touching] = np.char.add(names[touching], ', contact')
        names[strong] = np.char.add(names[strong], ', high force')
    return names
