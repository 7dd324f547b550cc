"""What a run records: the truth of each tick, and what the sensors say of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.structure import Structure

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Rows:
    """
    What happened at each recorded tick, in the instrument's order and SI units.

    ``table``, shape (ticks, columns), is the kernel's record; the properties are views of it.
    ``steps`` is how many steps the integrator tried for them.
    """

    instrument: Instrument
    structure: Structure
    table: FloatArray
    steps: int

    def __len__(self) -> int:
        return len(self.table)

    @cached_property
    def _back(self) -> NDArray[np.intp]:
        """Where each pulley of the instrument stands in the kernel's order."""
        return np.argsort(np.array(self.structure.order))

    def _columns(self, start: int, count: int) -> FloatArray:
        return self.table[:, start : start + count]

    @property
    def time(self) -> FloatArray:
        """Time [s], shape (ticks,)."""
        return self.table[:, 0]

    @property
    def angle(self) -> FloatArray:
        """True angles [rad], shape (ticks, pulleys)."""
        return self._columns(1, self.structure['N'])[:, self._back]

    @property
    def velocity(self) -> FloatArray:
        """True velocities [rad/s], shape (ticks, pulleys)."""
        n = self.structure['N']
        return self._columns(1 + n, n)[:, self._back]

    @property
    def effort(self) -> FloatArray:
        """Torques that the motors report [N m], shape (ticks, motors)."""
        return self._columns(1 + 2 * self.structure['N'], self.structure['U'])

    @property
    def loop_force(self) -> FloatArray:
        """Net force of each loop [N], torque of each coupling [N m], shape (ticks, both)."""
        start = 1 + 2 * self.structure['N'] + self.structure['U']
        return self._columns(start, self.structure['M'])

    @property
    def contact_force(self) -> FloatArray:
        """Force that the instrument applies at each contact [N], shape (ticks, contacts)."""
        start = 1 + 2 * self.structure['N'] + self.structure['U'] + self.structure['M']
        return self._columns(start, self.structure['K'])

    @property
    def dry_friction(self) -> FloatArray:
        """Torque of dry friction on each motor's pulley [N m], shape (ticks, motors)."""
        return self._columns(self._dry, self.structure['U'])

    @property
    def dry_limit(self) -> FloatArray:
        """The most that it could be there [N m], shape (ticks, motors)."""
        return self._columns(self._dry + self.structure['U'], self.structure['U'])

    @property
    def _dry(self) -> int:
        at = self.structure
        return int(1 + 2 * at['N'] + at['U'] + at['M'] + at['K'])

    @property
    def reading(self) -> FloatArray:
        """What the sensors say, shape (ticks, sensors), in the instrument's order of sensors."""
        return self._columns(self.structure['READINGS'], len(self.instrument.sensors))


def joined(parts: Sequence[Rows]) -> Rows:
    """
    Join rows that follow each other.

    :param parts: of one simulation, at least one.
    :return: all of them.
    """
    first = parts[0]
    table = np.concatenate([rows.table for rows in parts])
    return Rows(first.instrument, first.structure, table, sum(rows.steps for rows in parts))
