"""The paper's rig, in the variants that its experiments take, and two ways of driving it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.effect_use import checked_use
from tendon_ros.model.instrument import Curve, Instrument
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.rows import Rows
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict, Simulation
from tendon_ros.model.trajectory import Trajectory

FloatArray = NDArray[np.float64]

DEGREE = math.pi / 180.0

#: the paper's B = 0.9 has no unit; the file takes N m s/rad, this is the other plausible reading,
#: N mm s/deg, in N m s/rad
SMALL_DAMPING = 0.9e-3 / DEGREE

#: tables of a cable in the paper's unit of force [N]
KILOGRAM_FORCE = 9.80665


def paper_rig(*, printed: bool = False) -> Instrument:
    """
    Return the rig as the package's file has it.

    :param printed: with equation (6) as printed instead of the energy-consistent one.
    :return: the instrument.
    """
    return load_instrument('paper_rig_printed' if printed else 'paper_rig')


def tip_free(rig: Instrument) -> Instrument:
    """
    Return the rig with nothing in the way of the tip.

    :param rig: the instrument.
    :return: the same without contact.
    """
    return replace(rig, contacts=tuple(replace(c, enabled=False) for c in rig.contacts))


def tip_blocked(rig: Instrument, angle: float) -> Instrument:
    """
    Return the rig with the tip's stop elsewhere.

    :param rig: the instrument.
    :param angle: where the stop stands [rad].
    :return: the same with its contact there.
    """
    return replace(rig, contacts=tuple(replace(c, position=angle) for c in rig.contacts))


def with_damping(rig: Instrument, damping: float) -> Instrument:
    """
    Return the rig with the same viscous damping on every pulley.

    :param rig: the instrument.
    :param damping: [N m s/rad].
    :return: the same with that damping.
    """
    return replace(rig, pulleys=tuple(replace(p, damping=damping) for p in rig.pulleys))


def with_linear_cables(rig: Instrument, stiffness: float) -> Instrument:
    """
    Return the rig with loops that are linear springs as far as any experiment stretches them.

    :param rig: the instrument.
    :param stiffness: of the net force of each loop [N/m].
    :return: the same with those cables.
    """
    longest, preload = 0.1, 0.02  # [m]: far beyond a millimetre of work
    curve = Curve('linear', (0.0, longest), (0.0, 0.5 * stiffness * longest))
    loops = (
        replace(loop, curve='linear', pretension=0.5 * stiffness * preload) for loop in rig.loops
    )
    return replace(rig, loops=tuple(loops), curves=(curve,))


def with_effects(
    rig: Instrument, uses: Iterable[tuple[str, str, Mapping[str, float]]]
) -> Instrument:
    """
    Return the rig with effects in force.

    :param rig: the instrument.
    :param uses: effect, place and parameters in SI units.
    :return: the same with those effects only.
    """
    return replace(rig, effects=tuple(checked_use(rig, *use) for use in uses))


def under_control(rig: Instrument, trajectory: Trajectory) -> Rows:
    """
    Run the rig with the sampled position controllers of its file.

    :param rig: the instrument.
    :param trajectory: what the controllers are told.
    :return: a row each controller period.
    """
    return Simulation(rig).run(trajectory.sample(rig.control_period))


def with_ideal_motors(rig: Instrument, trajectory: Trajectory) -> Rows:
    """
    Run the rig with motors that are exactly where they should be: no controller, no error.

    :param rig: the instrument.
    :param trajectory: where the motors are.
    :return: a row each controller period.
    """
    wished = trajectory.sample(rig.control_period)
    motion = Signals.through(0.0, rig.control_period, wished.T)
    return predict(rig, motion, rig.driven, len(wished) - 1)


def degrees(rows: Rows, pulley: str) -> FloatArray:
    """
    Return the angle of a pulley in the paper's unit.

    :param rows: what happened.
    :param pulley: its name.
    :return: [deg], shape (rows,).
    """
    angle: FloatArray = np.rad2deg(rows.angle[:, rows.instrument.index(pulley)])
    return angle


def mean_between(time: FloatArray, value: FloatArray, start: float, end: float) -> float:
    """
    Return the mean of a signal over a part of its time.

    :param time: [s], shape (n,).
    :param value: shape (n,).
    :param start: [s].
    :param end: [s].
    :return: the mean, in the signal's unit.
    """
    return float(np.mean(value[(time >= start) & (time < end)]))


def ringing(value: FloatArray) -> float:
    """
    Return how much of a first swing comes back on the other side of where it ends.

    :param value: a signal that swings out and comes to rest, shape (n,).
    :return: largest deviation to the other side after the peak, relative to the peak; 0 where the
        signal only returns.
    """
    away = value - value[-1]
    peak = int(np.argmax(np.abs(away)))
    back = float(np.max(-np.sign(away[peak]) * away[peak:]))
    return max(back, 0.0) / float(abs(away[peak]))
