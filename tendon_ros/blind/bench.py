"""
The rigs: what their instrument files say, and the same as tables for the generator.

``bench`` is the installed ``bench_rig``. ``other`` differs in radii, coupling ratios, inertias,
damping, cable curve, pretension and gains; its file is written beside the cases. ``axis`` is one
body on a motor and has no cable; its inertia and damping are guessed. ``arm`` is a weight on a
servo: its weight alone is known well, and 100 Hz and 4096 counts are all that it reports.
``guessed`` is the ``other`` rig with nothing measured but its geometry and the shape of its
cable's curve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.errors import InstrumentError, listed
from tendon_ros.blind import columns as k
from tendon_ros.blind.rig import FloatArray, Rig
from tendon_ros.model.instrument import Controller, Curve, EffectUse, Instrument
from tendon_ros.model.instrument_file import load_instrument

BENCHES = ('bench', 'other', 'axis', 'arm', 'guessed')
PULLEYS = ('M', 'L', '1', '2', '3')
LOOPS = ('m1', '12', 'L3')
MOTORS = ('M', 'L')

#: spacing of the generator's own table of the cable [m]; linear between, so fine
SPACING = 1e-6
#: a limit that no motor reaches [N m]
NO_LIMIT = 1e3


@cache
def nominal(bench: str) -> Instrument:
    """
    Return what the user knows of a bench.

    :param bench: one of :data:`BENCHES`.
    :return: the instrument.
    :raises InstrumentError: for any other name.
    """
    if bench in _MADE:
        return _MADE[bench](load_instrument('bench_rig'))
    raise InstrumentError(f'{bench}: no such bench; there are {listed(BENCHES)}')


def _other(base: Instrument) -> Instrument:
    """Return the second bench: smaller wheels, a stiffer joint, a longer and softer cable."""
    inertia = {'M': 1.4e-4, 'L': 1.6e-4, '1': 2.8e-4, '2': 1.9e-4, '3': 0.028}
    damping = {'M': 0.035, 'L': 0.04, '1': 0.012, '2': 0.025, '3': 0.6}
    routes = {
        'm1': {'M': 0.022, '1': -0.034},
        '12': {'1': 0.028, '3': -0.024, '2': -0.026},
        'L3': {'L': 0.025, '3': -0.032},
    }
    pretension = {'m1': 9.0, '12': 8.0, 'L3': 7.0}
    stretch = np.linspace(0.0, 3.0, 61)  # [mm]
    curve = Curve(
        'other',
        tuple(float(x) for x in np.round(stretch * 1e-3, 9)),
        tuple(float(t) for t in np.round(5.5 * stretch + 1.1 * stretch**4.2, 4)),
    )
    motors = tuple(
        replace(m, controller=Controller(kp=16.0, ki=120.0, kd=0.04, limit=4.0))
        for m in base.motors
    )
    contacts = tuple(replace(c, stiffness=1.2e5, damping=40.0, arm=0.06) for c in base.contacts)
    return replace(
        base,
        name='other_rig',
        description='second bench: other wheels, ratios, inertias, cable, pretension and gains',
        pulleys=tuple(
            replace(p, inertia=inertia[p.name], damping=damping[p.name]) for p in base.pulleys
        ),
        curves=(curve,),
        loops=tuple(
            replace(loop, route=routes[loop.name], curve='other', pretension=pretension[loop.name])
            for loop in base.loops
        ),
        motors=motors,
        contacts=contacts,
    )


def _axis(base: Instrument) -> Instrument:
    """Return motor M alone, on a body that nobody has weighed."""
    resolutions, noises = {'encoder_M': math.tau / 65536}, {'torque_M': 5e-3}
    return replace(
        base,
        name='axis_rig',
        description='one body on a motor, inertia and damping guessed',
        pulleys=tuple(
            replace(p, inertia=4e-3, damping=0.03) for p in base.pulleys if p.name == 'M'
        ),
        curves=(),
        loops=(),
        motors=tuple(
            replace(
                m,
                controller=Controller(kp=6.0, ki=20.0, kd=0.08, limit=4.0),
                position_limit=(-math.inf, math.inf),
            )
            for m in base.motors
            if m.name == 'M'
        ),
        contacts=(),
        sensors=tuple(
            replace(s, resolution=resolutions.get(s.name, 0.0), noise=noises.get(s.name, 0.0))
            for s in base.sensors
            if s.name in resolutions | noises
        ),
        tolerances=dict.fromkeys(('pulley_M.inertia', 'pulley_M.damping'), math.inf),
    )


def _arm(axis: Instrument) -> Instrument:
    """Return a weight on a servo, whose load is in parts of a torque that nobody knows."""
    of_sensor = {'encoder_M': (math.tau / 4096, 0.0), 'torque_M': (2.5e-3, 1e-2)}
    return replace(
        axis,
        name='arm_rig',
        description='a weight on a servo, torque in parts of what it can',
        pulleys=tuple(replace(p, inertia=7e-3, damping=0.25) for p in axis.pulleys),
        motors=tuple(
            replace(m, controller=Controller(kp=12.0, ki=0.0, kd=0.0, limit=2.5))
            for m in axis.motors
        ),
        sensors=tuple(
            replace(s, resolution=of_sensor[s.name][0], noise=of_sensor[s.name][1])
            for s in axis.sensors
        ),
        effects=(EffectUse('gravity', 'pulley_M', {'torque': 0.4, 'phase': 0.0}),),
        tolerances={
            'pulley_M.inertia': 0.3,
            'pulley_M.damping': math.inf,
            'motor_M.torque_gain': math.inf,
            'pulley_M.gravity.torque': 0.05,
            'pulley_M.gravity.phase': math.radians(1.0),
        },
    )


def _guessed(other: Instrument) -> Instrument:
    """Return a rig that nobody has weighed, and whose cables nobody has pulled."""
    of_bodies = [f'pulley_{p.name}.{of}' for p in other.pulleys for of in ('inertia', 'damping')]
    of_cables = [
        f'cable_{loop.name}.{of}' for loop in other.loops for of in ('stiffness', 'pretension')
    ]
    return replace(
        other,
        name='guessed_rig',
        description='radii and the shape of the curve are known, all else is guessed',
        tolerances=dict.fromkeys((*of_bodies, *of_cables), math.inf),
    )


#: each rig from the installed one
_MADE: dict[str, Callable[[Instrument], Instrument]] = {
    'bench': lambda base: base,
    'other': _other,
    'axis': _axis,
    'arm': lambda base: _arm(_axis(base)),
    'guessed': lambda base: _guessed(_other(base)),
}


@cache
def _table(bench: str) -> FloatArray:
    """Return the tension of one cable at multiples of :data:`SPACING`, by a spline of our own."""
    if not nominal(bench).curves:
        return np.zeros(2)
    [curve] = nominal(bench).curves
    spline = CubicSpline(curve.elongation, curve.tension, bc_type='natural')
    table: NDArray[np.float64] = spline(np.arange(0.0, curve.elongation[-1], SPACING))
    return np.maximum(table, 0.0)


def nominal_rig(bench: str) -> Rig:
    """
    Return a rig exactly as the bench's file says, for the generator.

    :param bench: its name.
    :return: a new rig, to be changed at will.
    """
    one = nominal(bench)
    pulleys = np.zeros((5, k.PULLEY_COLUMNS))
    # what a rig has not stands still
    pulleys[:, [k.INERTIA, k.DAMPING]] = 1.0
    pulleys[:, [k.STRIBECK_SPEED, k.NOTCH_WIDTH, k.WARMING_TIME, k.PUSH_LENGTH]] = 1.0
    for body in one.pulleys:
        pulleys[PULLEYS.index(body.name), [k.INERTIA, k.DAMPING]] = body.inertia, body.damping
    for weight in one.effects:
        row = PULLEYS.index(weight.place.removeprefix('pulley_'))
        pulleys[row, [k.WEIGHT, k.WEIGHT_PHASE]] = (
            weight.parameters['torque'], weight.parameters['phase'],
        )  # fmt: skip
    loops = np.zeros((3, k.LOOP_COLUMNS))
    loops[:, [k.STIFFNESS, k.FAST_TIME, k.SLOW_TIME, k.SLIP_LENGTH]] = 1.0
    routes = np.zeros((3, 5))
    for loop in one.loops:
        n = LOOPS.index(loop.name)
        loops[n, k.PRELOAD] = loop.pretension
        for pulley, radius in loop.route.items():
            routes[n, PULLEYS.index(pulley)] = radius
    motors = np.zeros((2, k.MOTOR_COLUMNS))
    motors[:, [k.GAIN, k.SCALE, k.DROP_LENGTH, k.RESOLUTION]] = 1.0
    motors[:, k.SATURATION] = NO_LIMIT
    for motor in one.motors:
        row, gains = motors[MOTORS.index(motor.name)], motor.controller or Controller()
        row[[k.KP, k.KI, k.KD, k.LIMIT]] = gains.kp, gains.ki, gains.kd, gains.limit
        row[k.RESOLUTION] = resolution(one, f'encoder_{motor.name}')
    contact = np.zeros(k.CONTACT_NUMBERS)
    for tip in one.contacts:
        contact[[k.CONTACT, k.CONTACT_DAMPING]] = tip.stiffness, tip.damping
        contact[[k.WALL, k.ARM]] = tip.position, tip.arm
    return Rig(
        routes, pulleys, loops, np.zeros((3, 5)), np.zeros((3, 5)), motors, contact, _table(bench)
    )


def resolution(instrument: Instrument, sensor: str) -> float:
    """
    Return the resolution of a sensor.

    :param instrument: that has it.
    :param sensor: its name.
    :return: in its unit.
    """
    return next(s.resolution for s in instrument.sensors if s.name == sensor)


def noise(instrument: Instrument, sensor: str) -> float:
    """
    Return the noise of a sensor.

    :param instrument: that has it.
    :param sensor: its name.
    :return: one standard deviation in its unit.
    """
    return next(s.noise for s in instrument.sensors if s.name == sensor)
