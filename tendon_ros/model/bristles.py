"""
The pre-sliding friction of pulleys whose motion is known: how far their bristles are bent.

Dahl's law, see :mod:`tendon_ros.effects.presliding_friction`, solved for a straight motion. Who
searches for an angle has to know how friction changes on the way there: on the first milliradians
after a reversal it is stiffer than the cables are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.layout import Arrays

FloatArray = NDArray[np.float64]

#: the shortest way that divides others [rad]
LEAST = 1e-12


@dataclass(frozen=True)
class Bristles:
    """
    The bristles of an instrument, in the order of its pulleys.

    ``pulley``: who has some; ``place``: theirs in the kernel's state; ``span``: the angle in which
    they bend [rad]; ``dither``: the speed of a trembling that lets them go [rad/s].
    """

    pulley: NDArray[np.intp]
    place: NDArray[np.intp]
    span: FloatArray
    dither: FloatArray

    @staticmethod
    def of(arrays: Arrays) -> Bristles:
        """
        Return the bristles that some numbers give pulleys.

        :param arrays: of an instrument with its effects.
        :return: one for each pulley that has some.
        """
        at = arrays.structure
        count = at['N']
        which = arrays.d[at['BRISTLE'] : at['BRISTLE'] + count]
        rows = np.flatnonzero(which >= 0)
        return Bristles(
            pulley=np.array(at.order, dtype=np.intp)[rows],
            place=(2 * count + which[rows]).astype(np.intp),
            span=np.asarray(arrays.m[at['BREAKAWAY'] + rows], dtype=np.float64),
            dither=np.asarray(arrays.m[at['DITHER'] + rows], dtype=np.float64),
        )

    def bent(
        self, begun: FloatArray, way: FloatArray, gap: float
    ) -> tuple[FloatArray, FloatArray]:
        """
        Return how far bristles are bent after a motion.

        :param begun: the part of the friction that acted before, shape (bristles,).
        :param way: by how much their pulleys turned, at an even speed [rad], shape (bristles,).
        :param gap: in how much time [s].
        :return: the part that acts then, and its derivative by the way [1/rad].
        """
        shaken = self.dither * gap
        whole = np.maximum(np.abs(way) + shaken, LEAST)
        left = np.exp(-whole / self.span)
        end = way / whole
        side = np.where(way > 0.0, 1.0, -1.0)
        slope = shaken / whole**2 * (1.0 - left) + side * (end - begun) * left / self.span
        return end + (begun - end) * left, slope
