"""
The two benches: what their instrument files say, and the same as tables for the generator.

``bench`` is the installed ``bench_rig``. ``other`` differs in radii, coupling ratios, inertias,
damping, cable curve, pretension and gains; its file is written beside the cases.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.errors import InstrumentError, listed
from tendon_ros.blind import columns as k
from tendon_ros.blind.rig import FloatArray, Rig
from tendon_ros.model.instrument import Controller, Curve, Instrument
from tendon_ros.model.instrument_file import load_instrument

BENCHES = ('bench', 'other')
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

    :param bench: ``bench`` or ``other``.
    :return: the instrument.
    :raises InstrumentError: for any other name.
    """
    if bench == 'bench':
        return load_instrument('bench_rig')
    if bench == 'other':
        return _other(load_instrument('bench_rig'))
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


@cache
def _table(bench: str) -> FloatArray:
    """Return the tension of one cable at multiples of :data:`SPACING`, by a spline of our own."""
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
    bodies = {p.name: p for p in one.pulleys}
    for p, name in enumerate(PULLEYS):
        pulleys[p, k.INERTIA] = bodies[name].inertia
        pulleys[p, k.DAMPING] = bodies[name].damping
        pulleys[p, [k.STRIBECK_SPEED, k.NOTCH_WIDTH, k.WARMING_TIME, k.PUSH_LENGTH]] = 1.0
    loops = np.zeros((3, k.LOOP_COLUMNS))
    routes = np.zeros((3, 5))
    cables = {loop.name: loop for loop in one.loops}
    for n, name in enumerate(LOOPS):
        loops[n, k.STIFFNESS] = 1.0
        loops[n, k.PRELOAD] = cables[name].pretension
        loops[n, [k.FAST_TIME, k.SLOW_TIME, k.SLIP_LENGTH]] = 1.0
        for p, pulley in enumerate(PULLEYS):
            routes[n, p] = cables[name].route.get(pulley, 0.0)
    motors = np.zeros((2, k.MOTOR_COLUMNS))
    drives = {m.name: m for m in one.motors}
    for n, name in enumerate(MOTORS):
        gains = drives[name].controller
        motors[n, [k.KP, k.KI, k.KD]] = gains.kp, gains.ki, gains.kd
        motors[n, k.LIMIT] = gains.limit
        motors[n, [k.GAIN, k.SCALE, k.DROP_LENGTH]] = 1.0
        motors[n, k.SATURATION] = NO_LIMIT
        motors[n, k.RESOLUTION] = resolution(one, f'encoder_{name}')
    contact = np.zeros(k.CONTACT_NUMBERS)
    [tip] = one.contacts
    contact[k.CONTACT] = tip.stiffness
    contact[k.CONTACT_DAMPING] = tip.damping
    contact[k.WALL] = tip.position
    contact[k.ARM] = tip.arm
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
