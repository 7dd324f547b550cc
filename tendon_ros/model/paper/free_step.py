"""
Fig. 10: a step of 1 degree on M, L held at 0, tip free.

Motion travels M, 1, 2, the link (3) moves though nobody asked it to, and in the end every pulley
is where rigid cables would have put it, without force.

The paper lets the motors be without error in the end and shows vibration "although B was
considered 0.9". With 0.9 N m s/rad on every pulley nothing vibrates; with the other reading of
that number, 0.9 N mm s/deg, link and end-effector do. Both are run: the first with the sampled
controllers of the file, the second with ideal motors, because those controllers feed the swing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.rig import (
    DEGREE,
    degrees,
    ringing,
    SMALL_DAMPING,
    tip_free,
    under_control,
    with_damping,
    with_ideal_motors,
)
from tendon_ros.model.paper.statement import about, at_least, at_most, Statement, Use
from tendon_ros.model.rows import Rows
from tendon_ros.model.trajectory_profiles import step

#: when the motor is told to turn [s]
START = 0.1

#: what counts as vibration: the part of the first swing of link 3 that comes back on the other
#: side; a fiftieth is what the eye can tell in a figure
VISIBLE = 0.02

FIGURE = 'Fig. 10'


@dataclass(frozen=True)
class FreeStep:
    """Rows under control, as the file has the rig, and with ideal motors and little damping."""

    rows: Rows
    swinging: Rows
    statements: tuple[Statement, ...]


def free_step(rig: Instrument) -> FreeStep:
    """
    Run the step.

    :param rig: the paper's rig.
    :return: what happened, for both readings of the damping.
    """
    free = tip_free(rig)
    turn = step(rig.motor_names, amplitude=DEGREE, start=START, duration=3.0)
    long_turn = step(rig.motor_names, amplitude=DEGREE, start=START, duration=20.0)
    rows = under_control(free, turn)
    swinging = with_ideal_motors(with_damping(free, SMALL_DAMPING), long_turn)
    return FreeStep(rows, swinging, (*_at_rest(rows), *_on_the_way(rows, swinging)))


def _at_rest(rows: Rows) -> tuple[Statement, ...]:
    # a thousandth of the step: closer than any line in a figure
    close = 1e-3
    ends = (
        ('M', 'no error', 1.0),
        ('L', 'kept at 0 deg', 0.0),
        ('1', '(rigid coupling: 1 deg)', 1.0),
        ('2', '(rigid coupling: 1 deg)', 1.0),
        ('3', '(rigid coupling: 0 deg)', 0.0),
    )
    left = float(np.max(np.abs(rows.loop_force[-1])))
    return (
        Statement(FIGURE, 'step on M', '1 deg', 1.0, 'deg', within=about(1.0, 0.0), use=Use.INPUT),
        *(
            Statement(
                FIGURE, f'pulley {name} in the end', said, float(degrees(rows, name)[-1]), 'deg',
                within=about(value, close),
            )
            for name, said, value in ends
        ),
        Statement(
            FIGURE, 'net force of any loop in the end', '(none)', left, 'N',
            within=at_most(0.01),
        ),
    )  # fmt: skip


def _on_the_way(rows: Rows, swinging: Rows) -> tuple[Statement, ...]:
    half = {name: _time_to(rows, name, 0.5) for name in ('M', '1', '2')}
    return (
        Statement(
            FIGURE, 'pulley 1 half way, after M', 'delayed', half['1'] - half['M'], 's',
            within=at_least(0.005),
        ),
        Statement(
            FIGURE, 'pulley 2 half way, after 1', 'delayed', half['2'] - half['1'], 's',
            within=at_least(0.005),
        ),
        Statement(
            FIGURE, 'largest turn of link 3', 'unexpected motion',
            float(np.max(np.abs(degrees(rows, '3')))), 'deg', within=at_least(0.01),
        ),
        Statement(
            FIGURE, 'vibration of link 3', 'vibrates', 100.0 * ringing(degrees(rows, '3')), '%',
            within=at_least(100.0 * VISIBLE),
            note='swing back by first swing; B = 0.9 N m s/rad on every pulley stifles it',
        ),
        Statement(
            FIGURE, 'the same with less damping', 'vibrates',
            100.0 * ringing(degrees(swinging, '3')), '%', within=at_least(100.0 * VISIBLE),
            note='B read as 0.9 N mm s/deg, ideal motors',
        ),
    )  # fmt: skip


def _time_to(rows: Rows, pulley: str, angle: float) -> float:
    """Return when a pulley first passes an angle [deg]."""
    return float(rows.time[np.argmax(degrees(rows, pulley) >= angle)])
