"""A rig of the generator: tables of numbers, and running them."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import SimulationError
from tendon_ros.blind import columns as k
from tendon_ros.model.engine import engine_of

FloatArray = NDArray[np.float64]

TICK = 1e-3  # [s] of the controllers
SUBSTEPS = 20  # integration steps in a tick
#: the rig has been under control for a while when recording begins [s]
BEFORE = 1.0

_NO_DRIVE = np.zeros((0, 4))
_HERE = Path(__file__).parent
_FILES = tuple(_HERE / f'{part}.py' for part in ('columns', 'forces', 'kernel'))


@dataclass
class Rig:
    """
    The tables that :mod:`tendon_ros.blind.kernel` runs, and what the other sensors do.

    ``joint_offset``, ``joint_gain``, ``joint_delay``, ``joint_cyclic``: of the encoders on pulleys
    1, 2 and 3; ``cell``: gain, bias [N], delay [s], lag [s], curvature [1/N], rectified;
    ``torque_delay`` [s] and ``torque_rectified`` of the motors' torque readings.
    """

    routes: FloatArray
    pulleys: FloatArray
    loops: FloatArray
    slips: FloatArray
    yields: FloatArray
    motors: FloatArray
    contact: FloatArray
    table: FloatArray
    joint_offset: FloatArray = field(default_factory=lambda: np.zeros(3))
    joint_gain: FloatArray = field(default_factory=lambda: np.ones(3))
    joint_delay: FloatArray = field(default_factory=lambda: np.zeros(3))
    joint_cyclic: FloatArray = field(default_factory=lambda: np.zeros(3))
    torque_delay: FloatArray = field(default_factory=lambda: np.zeros(2))
    torque_rectified: FloatArray = field(default_factory=lambda: np.zeros(2))
    cell: FloatArray = field(default_factory=lambda: np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]))

    def copy(self) -> Rig:
        """Return a rig that can be changed without changing this one."""
        return Rig(**{name: np.copy(value) for name, value in vars(self).items()})

    def preload(self, loop: int) -> float:
        """Return the tension of a loop's cables at rest [N]."""
        return float(self.loops[loop, k.PRELOAD])

    def load(self, pulley: int) -> float:
        """Return the load of the cables on a pulley at rest [N m]; of its weight without any."""
        cables = float(2.0 * np.abs(self.routes[:, pulley]) @ self.loops[:, k.PRELOAD])
        return cables or float(self.pulleys[pulley, k.WEIGHT])


def run(
    rig: Rig,
    setpoint: FloatArray,
    *,
    closed: bool,
    drive: FloatArray | None = None,
    start: float = -BEFORE,
) -> FloatArray:
    """
    Run a rig.

    :param rig: the rig.
    :param setpoint: of the motors [rad], one row a tick, shape (n, 2).
    :param closed: whether the tip's wall is there.
    :param drive: angles and speeds of both motors, shape (n + 1, 4), where they are moved.
    :param start: time of the first tick [s].
    :return: one row a tick, columns as in the kernel.
    :raises SimulationError: where the rig diverges.
    """
    spacing = 1e-6
    stretch = np.arange(rig.table.size) * spacing
    loops = rig.loops.copy()
    for row in loops:
        row[k.PRELOAD_STRETCH] = np.interp(row[k.PRELOAD] / row[k.STIFFNESS], rig.table, stretch)
    contact = rig.contact.copy()
    contact[k.CLOSED] = float(closed)
    out = np.zeros((len(setpoint), k.OUT_COLUMNS))
    fault = engine_of(_FILES).module.run(
        TICK / SUBSTEPS,
        SUBSTEPS,
        start,
        np.ascontiguousarray(setpoint),
        _NO_DRIVE if drive is None else np.ascontiguousarray(drive),
        rig.routes,
        rig.pulleys,
        loops,
        rig.slips,
        rig.yields,
        rig.motors,
        contact,
        rig.table,
        spacing,
        out,
    )
    if fault or np.abs(out[:, k.ANGLE : k.ANGLE + 5]).max() > 10.0:
        raise SimulationError(f'blind rig: diverged after tick {fault}; draw a smaller effect')
    return out
