"""
The gap that a fault makes, in noise floors.

The rig runs with all faults under its controller. Then the same rig without the one fault is moved
by the same measured motor angles. What torques, force and inner angles differ by, clean of noise,
is what that fault alone explains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tendon_ros.blind import columns as k
from tendon_ros.blind.bench import nominal
from tendon_ros.blind.faults import Fault, rig_with
from tendon_ros.blind.rig import FloatArray, Rig, run, TICK
from tendon_ros.blind.sensing import clean, floors
from tendon_ros.blind.setup import Setup

#: ticks at the end of a run in which what late readings say of the motion is not known any more
_END = 50


@dataclass(frozen=True)
class Ran:
    """A run of a rig, what clean sensors said, and whether the tip had a wall."""

    out: FloatArray
    values: dict[str, FloatArray]
    closed: bool


def gap_of(
    base: Rig,
    faults: Sequence[Fault],
    which: int,
    ran: Mapping[str, Ran],
    commands: Mapping[str, FloatArray],
    setup: Setup,
) -> float:
    """
    Return the gap of one fault: the largest of its channels', RMS over all recordings.

    :param base: the rig without faults.
    :param faults: all of them.
    :param which: the index of the one.
    :param ran: the runs with all of them.
    :param commands: set-points by kind.
    :param setup: which rig, and which of its sensors there are.
    :return: in noise floors.
    """
    others = [fault for n, fault in enumerate(faults) if n != which]
    squares: dict[str, float] = {}
    counts: dict[str, int] = {}
    for kind, one in ran.items():
        rig = rig_with(base, others, kind)
        drive = drive_of(rig, one.out)
        out = run(rig, commands[kind], closed=one.closed, drive=drive)
        for name, value in clean(rig, out, setup.channels, closed=one.closed).items():
            difference = (one.values[name] - value)[:-_END]
            squares[name] = squares.get(name, 0.0) + float(difference @ difference)
            counts[name] = counts.get(name, 0) + difference.size
    floor = floors(nominal(setup.bench), setup.channels)
    return max(float(np.sqrt(squares[n] / counts[n])) / floor[n] for n in floor)


def drive_of(rig: Rig, out: FloatArray) -> FloatArray:
    """
    Return the motion of the motors that a rig's own encoders would have read as these readings.

    :param rig: whose encoders are believed.
    :param out: of a run.
    :return: angles and speeds, one row a tick and one more, shape (n + 1, 4).
    """
    ticks = np.arange(len(out) + 1)
    drive = np.zeros((len(out) + 1, 4))
    for m in range(2):
        row = rig.motors[m]
        late = np.interp(ticks + row[k.AGE] / TICK, ticks[:-1], out[:, k.READING + m])
        drive[:, m] = (late - row[k.ZERO]) / row[k.SCALE]
        drive[:, 2 + m] = np.gradient(drive[:, m], TICK)
    return drive
