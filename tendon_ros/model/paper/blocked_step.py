"""
Fig. 11: a step of 6 degrees on M, L held at 0, the tip blocked at 5 degrees.

The degree that is left over stretches the cables: three loops in series. The reaction reaches the
link and its motor L, so L must be under control here, not ideal: the file's sampled controllers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.free_step import START, VISIBLE
from tendon_ros.model.paper.rig import (
    DEGREE,
    degrees,
    ringing,
    SMALL_DAMPING,
    tip_blocked,
    under_control,
    with_damping,
    with_ideal_motors,
)
from tendon_ros.model.paper.statement import about, at_least, at_most, Statement, Use
from tendon_ros.model.rows import Rows
from tendon_ros.model.trajectory_profiles import step

FIGURE = 'Fig. 11'


@dataclass(frozen=True)
class BlockedStep:
    """Rows under control, as the file has the rig, and with ideal motors and little damping."""

    rows: Rows
    swinging: Rows
    statements: tuple[Statement, ...]


def blocked_step(rig: Instrument) -> BlockedStep:
    """
    Run the step against the stop.

    :param rig: the paper's rig.
    :return: what happened.
    """
    blocked = tip_blocked(rig, 5.0 * DEGREE)
    turn = step(rig.motor_names, amplitude=6.0 * DEGREE, start=START, duration=3.0)
    long_turn = step(rig.motor_names, amplitude=6.0 * DEGREE, start=START, duration=20.0)
    rows = under_control(blocked, turn)
    swinging = with_ideal_motors(with_damping(blocked, SMALL_DAMPING), long_turn)
    return BlockedStep(rows, swinging, _statements(rows, swinging))


def _statements(rows: Rows, swinging: Rows) -> tuple[Statement, ...]:
    force = rows.contact_force[:, 0]
    loops = np.abs(rows.loop_force[-1])
    left_over = float(degrees(rows, 'M')[-1] - degrees(rows, '2')[-1])
    third, motor = degrees(rows, '3'), degrees(rows, 'L')
    swing_of_third = 100.0 * ringing(degrees(swinging, '3'))
    return (
        Statement(FIGURE, 'step on M', '6 deg', 6.0, 'deg', within=about(6.0, 0.0), use=Use.INPUT),
        Statement(
            FIGURE, 'tip blocked at', '5 deg', float(degrees(rows, '2')[-1]), 'deg',
            within=about(5.0, 1e-3), use=Use.INPUT,
        ),
        Statement(
            FIGURE, 'left over for the force', '1 deg', left_over, 'deg', within=about(1.0, 1e-3)
        ),
        Statement(
            FIGURE, 'force at the tip, settled', '1.83 N', float(force[-1]), 'N',
            within=about(1.83, 0.005), use=Use.IDENTIFICATION,
            note='the level was fitted; that the dynamics settle there was not',
        ),
        Statement(
            FIGURE, 'loops out of equilibrium, settled', 'equilibrium',
            float(np.ptp(loops)), 'N', within=at_most(0.01),
        ),
        Statement(
            FIGURE, 'link 3, settled', 'affected', float(third[-1]), 'deg',
            within=about(1.0 / 3.0, 2e-3),
            note='a third of the degree: three equal loops in series',
        ),
        Statement(
            FIGURE, 'motor L, largest deviation', 'affected', float(np.max(np.abs(motor))),
            'deg', within=at_least(0.01),
        ),
        Statement(
            FIGURE, 'vibration of link 3', 'some vibration', 100.0 * ringing(third), '%',
            within=at_least(100.0 * VISIBLE),
            note='just: B = 0.9 N m s/rad on every pulley nearly stifles it',
        ),
        Statement(
            FIGURE, 'the same with less damping', 'some vibration', swing_of_third, '%',
            within=at_least(100.0 * VISIBLE), note='B read as 0.9 N mm s/deg, ideal motors',
        ),
    )  # fmt: skip
