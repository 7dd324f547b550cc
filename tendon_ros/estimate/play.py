"""Play of couplings, for searches: inside it no torque changes with the angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.statics import Statics

FloatArray = NDArray[np.float64]

#: twists at which a coupling is looked at for play [rad]
TWISTS = np.geomspace(1e-4, 1.0, 60)
#: part of itself to which the end of a play is found
EXACT = 1e-6
#: couplings with play of which all combinations are tried
MOST = 4


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
        links: list[int] = []
        for k in range(len(instrument.loops), len(instrument.links)):
            row = instrument.routing()[k]
            if not row[self._free].any():
                continue
            end = _end(statics, k, row / float(row @ row))
            if end > 0.0:
                self._ends.append((row, end))
                links.append(k)
        # by how much each free pulley turns if one coupling twists and no other link gives
        self._turned = np.linalg.pinv(instrument.routing()[:, self._free])[:, links]

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

        One coupling at a time; see :meth:`corners` for several on the wrong side at once.

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

    def corners(self, angle: FloatArray) -> Iterator[FloatArray]:
        """
        Yield the angles with all couplings that have play wound up, each one way or the other.

        A torque that reverses while it is little takes all of them to their other ends.

        :param angle: [rad], shape (pulleys,).
        :return: each combination; none where there is one coupling, or too many to try all.
        """
        if not 2 <= len(self._ends) <= MOST:
            return
        for ways in product((1.0, -1.0), repeat=len(self._ends)):
            more = [
                way * end - float(row @ angle)
                for way, (row, end) in zip(ways, self._ends, strict=True)
            ]
            corner = angle.copy()
            corner[self._free] += self._turned @ np.array(more)
            yield corner


def _end(statics: Statics, k: int, unit: FloatArray) -> float:
    """Return the least twist from which on a coupling yields no further [rad]; 0 without play."""
    still = np.zeros(len(unit))

    def holds(twist: float) -> bool:
        return bool(statics.at(twist * unit, still).loop_stiffness[k] > 0.0)

    stiff = [float(twist) for twist in TWISTS if holds(twist)]
    if not stiff or stiff[0] == TWISTS[0]:
        return 0.0
    outside = stiff[0]
    inside = float(TWISTS[outside > TWISTS][-1])
    # a coupling that is wound up is hardly beyond its play: where that ends is told apart
    while outside - inside > EXACT * outside:
        middle = 0.5 * (inside + outside)
        inside, outside = (inside, middle) if holds(middle) else (middle, outside)
    return outside
