"""Play of couplings, for searches: inside it no torque changes with the angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.statics import Statics

FloatArray = NDArray[np.float64]

#: twists at which a coupling is looked at for play [rad]
TWISTS = np.geomspace(1e-4, 1.0, 60)


class Play:
    """
    The couplings with play that angles can cross which are searched for.

    A search that begins inside the play, or on the wrong side of it, ends at its edge.

    :param instrument: the network.
    :param free: pulleys whose angles are searched for.
    :param statics: of the instrument, with its effects.
    """

    def __init__(self, instrument: Instrument, free: Sequence[int], statics: Statics) -> None:
        self._free = list(free)
        self._ends: list[tuple[FloatArray, float]] = []
        for k in range(len(instrument.loops), len(instrument.links)):
            row = instrument.routing()[k]
            if not row[self._free].any():
                continue
            unit, still = row / float(row @ row), np.zeros(len(row))
            stiff = [t for t in TWISTS if statics.at(t * unit, still).loop_stiffness[k] > 0.0]
            if stiff and stiff[0] > TWISTS[0]:
                self._ends.append((row, float(stiff[0])))

    def inside(self, angle: FloatArray) -> bool:
        """
        Return whether any of the couplings is within its play.

        :param angle: [rad], shape (pulleys,).
        :return: whether.
        """
        return any(abs(float(row @ angle)) < end for row, end in self._ends)

    def sides(self, angle: FloatArray) -> list[FloatArray]:
        """
        Return the angles with each coupling that has play wound up one way, and the other.

        One coupling at a time: where several are on the wrong side at once, none may help.

        :param angle: [rad], shape (pulleys,).
        :return: twice as many angles as there are such couplings.
        """
        found = []
        for row, end in self._ends:
            free = row[self._free]
            for wound in (end, -end):
                side = angle.copy()
                more = wound - float(row @ angle)
                side[self._free] += more * free / float(free @ free)
                found.append(side)
        return found
