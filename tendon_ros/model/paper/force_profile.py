"""
Figs. 12 and 13: M goes 0, 5, 7, 5, 4 degrees, L held at 0, the tip pressed to the load cell.

Without friction and with cables that remember nothing, the force at rest follows from the angles
alone: a convex energy has one minimum. So the second rest at 5 degrees *must* have the force of
the first, whatever the controllers do. What can be lower is the way there: with motors that follow
exactly round sharp corners, the force shoots over at the first arrival and under at the return.
What makes a lower force at rest is in :mod:`tendon_ros.model.paper.adjusted_rig`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.cable import elongation_at, tension_at
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.cable_test import WORKING_END
from tendon_ros.model.paper.rig import mean_between, under_control, with_ideal_motors
from tendon_ros.model.paper.statement import about, at_most, Statement, Use
from tendon_ros.model.rows import Rows
from tendon_ros.model.trajectory import Trajectory
from tendon_ros.model.trajectory_profiles import paper_fig12

FloatArray = NDArray[np.float64]

#: parts of the profile in which M has come to rest, by what it rests at [s]
RESTS = {
    'first 5 deg': (3.5, 4.5),
    '7 deg': (7.5, 8.5),
    'second 5 deg': (11.5, 12.5),
    '4 deg': (15.5, 17.5),
}

#: when M has arrived at 4 degrees, corners rounded [s]
FALLEN = 14.1

#: forces closer than that are the same in the paper's figures [N]
SAME = 0.1


@dataclass(frozen=True)
class ForceProfile:
    """
    The commanded motion and what follows from it.

    ``rows``: with the file's controllers; ``ideal``: with ideal motors round sharp corners.
    """

    trajectory: Trajectory
    rows: Rows
    ideal: Rows
    statements: tuple[Statement, ...]


def force_profile(rig: Instrument) -> ForceProfile:
    """
    Run the profile.

    :param rig: the paper's rig.
    :return: what happened.
    """
    trajectory = paper_fig12(rig.motor_names)
    rows = under_control(rig, trajectory)
    ideal = with_ideal_motors(rig, paper_fig12(rig.motor_names, rounding=0.0))
    statements = (*_setpoints(trajectory), *_forces(rows, ideal), _working_range(rig, rows))
    return ForceProfile(trajectory, rows, ideal, statements)


def rest_forces(rows: Rows) -> dict[str, float]:
    """
    Return the force at the tip at each rest of the profile.

    :param rows: a run of the profile.
    :return: mean force [N] by the keys of :data:`RESTS`.
    """
    force = rows.contact_force[:, 0]
    return {name: mean_between(rows.time, force, *part) for name, part in RESTS.items()}


def _setpoints(trajectory: Trajectory) -> tuple[Statement, ...]:
    middles = {name: 0.5 * (start + end) for name, (start, end) in RESTS.items()}
    angles = np.rad2deg(trajectory.at(np.array(list(middles.values())))[:, 0])
    return tuple(
        Statement(
            'Fig. 12', f'set-point of M at its {number} rest', f'{said} deg', float(angle), 'deg',
            within=about(said, 1e-6), use=Use.INPUT,
        )
        for number, said, angle in zip(('1st', '2nd', '3rd', '4th'), (5, 7, 5, 4), angles,
                                       strict=True)
    )  # fmt: skip


def _forces(rows: Rows, ideal: Rows) -> tuple[Statement, ...]:
    figure = 'Fig. 13'
    at, drop = rest_forces(rows), _time_to_fall(rows)
    force, time = ideal.contact_force[:, 0], ideal.time
    first_peak = float(np.max(force[time < 4.5]))
    trough = float(np.min(force[(time > 9.5) & (time < 12.5)]))
    return (
        Statement(
            figure, 'force at the first 5 deg', 'about 18 N', at['first 5 deg'], 'N',
            within=about(18.0, 0.5), use=Use.IDENTIFICATION,
        ),
        Statement(
            figure, 'force at 7 deg', 'up to 50 N', at['7 deg'], 'N', within=about(50.0, 0.5),
            use=Use.IDENTIFICATION, note='the block gives 0.006 deg, which costs 0.15 N',
        ),
        Statement(
            figure, 'return to 5 deg, at rest: change from first', 'less',
            at['second 5 deg'] - at['first 5 deg'], 'N', within=at_most(-SAME),
            note='cannot be: one angle, one force, without friction; Fig. 15 has what does it',
        ),
        Statement(
            figure, 'return to 5 deg: lowest less first peak', 'less than the initial peak',
            trough - first_peak, 'N', within=at_most(-SAME),
            note='ideal motors, sharp corners: shoots over at first, under on the return',
        ),
        Statement(
            figure, 'force at 4 deg', 'decreases', at['4 deg'], 'N', within=at_most(18.0 - SAME),
        ),
        Statement(
            figure, '95 % of that fall done, after M is told 4 deg', 'quickly', drop, 's',
            within=at_most(0.5), note='negative: before the set-point itself is there',
        ),
    )  # fmt: skip


def _time_to_fall(rows: Rows) -> float:
    """Return when 95 % of the last fall is done, after the set-point has arrived [s]."""
    at = rest_forces(rows)
    level = at['4 deg'] + 0.05 * (at['second 5 deg'] - at['4 deg'])
    late = rows.time > 12.5
    return float(rows.time[late][np.argmax(rows.contact_force[late, 0] <= level)]) - FALLEN


def _working_range(rig: Instrument, rows: Rows) -> Statement:
    routing = rig.routing()[: len(rig.loops)]
    stretch = np.max(np.abs(rows.angle @ routing.T), axis=0)
    curves = {curve.name: curve for curve in rig.curves}
    largest = 0.0
    for loop, reach in zip(rig.loops, stretch, strict=True):
        curve = curves[loop.curve]
        tension = tension_at(curve, elongation_at(curve, loop.pretension) + reach)
        largest = max(largest, float(tension))
    return Statement(
        'Fig. 13', 'largest tension of any cable', 'below 15 kgf = 147.1 N', largest, 'N',
        within=at_most(WORKING_END), use=Use.CHECK,
    )  # fmt: skip
