"""
What a friction's law may get wrong, and what of another cause looks like it.

Friction turns with the motion, and what its law gets wrong turns with it: between two reversals it
is too large or too small, or larger where the motion is fast than where it begins and ends. A
spring does neither: between two reversals it goes from one side to the other.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.fit import Problem

FloatArray = NDArray[np.float64]

#: part of its size from which on a friction has a direction
HAS = 0.3


def imitable(problem: Problem, change: FloatArray, friction: FloatArray) -> float:
    """
    Return the part of a change, as power, that errors of a friction's law can do as well.

    :param problem: the data.
    :param change: what a cause does to each sample, in noise deviations, shape (samples,).
    :param friction: what a dry friction does, shape (samples,).
    :return: 0 to 1; 1 of what does nothing.
    """
    whole = float(change @ change)
    if not whole > 0.0:
        return 1.0
    own = 0.0
    for _, _, span in problem.spans():
        for stretch in _stretches(friction[span]):
            there, rubs = change[span][stretch], friction[span][stretch]
            # too large or too small, and the more so the faster the motion
            middle = np.linspace(-1.0, 1.0, len(rubs)) ** 2
            form = np.stack([rubs, rubs * middle], axis=1)
            found, *_ = np.linalg.lstsq(form, there, rcond=None)
            own += float(np.sum((there - form @ found) ** 2))
    return 1.0 - own / whole


def _stretches(friction: FloatArray) -> list[slice]:
    """Return the stretches between reversals of what a friction does to a channel."""
    size = float(np.sqrt(np.mean(friction**2))) if friction.size else 0.0
    told = np.flatnonzero(np.abs(friction) > HAS * size)
    turned = np.flatnonzero(np.diff(np.sign(friction[told])) != 0.0)
    ends = [0, *(told[turned + 1]).tolist(), len(friction)]
    return [slice(a, b) for a, b in pairwise(ends) if b > a]
