"""What is measured: the five-pulley rig with friction, slack and wall, and chains of cables."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import (
    Contact,
    Controller,
    Curve,
    EffectUse,
    Instrument,
    Loop,
    Motor,
    Pulley,
    Sensor,
)

FloatArray = NDArray[np.float64]

RADIUS = 0.03  # [m]


def hardening(name: str = 'cable') -> Curve:
    """Return t = 7.77 x + 1.35 x^6.37 (mm, N), which gives the paper's three forces at 5 N."""
    x = np.linspace(0.0, 2.4, 97)
    tension = 7.77 * x + 1.35 * x**6.37
    return Curve(name, tuple(1e-3 * x), tuple(tension))


def five_pulleys(
    *,
    friction: float = 0.1,
    wall: str = 'spring_damper',
    continuous: bool = False,
    effects: tuple[EffectUse, ...] | None = None,
) -> Instrument:
    """
    Return the paper's network with the numbers of the practice bench.

    :param friction: tension-proportional, of pulleys 1, 2 and 3.
    :param wall: the contact's law, or '' for no contact.
    :param continuous: control without sampling.
    :param effects: instead of the friction.
    :return: the instrument.
    """
    R = RADIUS
    controller = Controller(kp=20.0, ki=150.0, kd=0.05, limit=5.0)
    inertia = {'M': 2.25e-4, 'L': 2.25e-4, '1': 2.25e-4, '2': 2.25e-4, '3': 4e-2}
    damping = {'M': 0.05, 'L': 0.05, '1': 0.02, '2': 0.02, '3': 0.9}
    if effects is None:
        effects = tuple(
            EffectUse('tension_friction', f'pulley_{name}', {'coefficient': friction})
            for name in ('1', '2', '3')
            if friction > 0.0
        )
    rub = 50.0 if wall == 'spring_damper' else 0.5
    return Instrument(
        name='five_pulleys',
        pulleys=tuple(Pulley(name, inertia[name], damping[name]) for name in inertia),
        motors=(Motor('M', 'M', controller), Motor('L', 'L', controller)),
        loops=(
            Loop('m1', {'M': R, '1': -R}, 'cable', 5.0),
            Loop('12', {'1': R, '3': -R, '2': -R}, 'cable', 5.0),
            Loop('L3', {'L': R, '3': -R}, 'cable', 5.0),
        ),
        curves=(hardening(),),
        contacts=(
            Contact('tip', {'2': 1.0}, 0.05, 2e5, rub, 0.0, wall or 'hunt_crossley', bool(wall)),
        ),
        sensors=(
            Sensor('encoder_M', 'angle', 'M', 'actuator/pulley_M/position'),
            Sensor('encoder_L', 'angle', 'L', 'actuator/pulley_L/position'),
            Sensor('torque_M', 'motor_torque', 'M', 'actuator/pulley_M/effort'),
            Sensor('torque_L', 'motor_torque', 'L', 'actuator/pulley_L/effort'),
            Sensor('load_cell', 'contact_force', 'tip', 'load_cell/force'),
        ),
        effects=effects,
        continuous_control=continuous,
    )


def press_and_swing(seconds: float = 10.0) -> FloatArray:
    """
    Return the motion that is measured: the paper's Fig. 12 at M, while L swings by 3 degrees.

    :param seconds: how long.
    :return: set-points at 1 kHz [rad], shape (samples, 2): presses, slackens, sticks, reverses.
    """
    t = 1e-3 * np.arange(round(1000 * seconds))
    knots = [0.0, 0.5, 1.0, 2.5, 3.0, 4.5, 5.0, 6.5, 7.0, 10.0]
    degrees = [0.0, 0.0, 5.0, 5.0, 7.0, 7.0, 5.0, 5.0, 4.0, 4.0]
    return np.deg2rad(np.stack([np.interp(t, knots, degrees), 3.0 * np.sin(2.0 * t)], axis=1))


def chain(loops: int, effects: tuple[EffectUse, ...] = ()) -> Instrument:
    """
    Return a motor that drives a row of pulleys, each by a cable loop from the one before.

    :param loops: how many.
    :param effects: in force.
    :return: the instrument.
    """
    names = [f'p{n}' for n in range(loops + 1)]
    return Instrument(
        name=f'chain_{loops}',
        pulleys=tuple(Pulley(name, 2.25e-4, 0.02) for name in names),
        motors=(Motor('drive', 'p0', Controller(kp=20.0, ki=150.0, kd=0.05, limit=5.0)),),
        loops=tuple(
            Loop(f'c{n}', {names[n]: RADIUS, names[n + 1]: -RADIUS}, 'cable', 5.0)
            for n in range(loops)
        ),
        curves=(hardening(),),
        sensors=(Sensor('encoder', 'angle', 'p0', 'actuator/p0/position'),),
        effects=effects,
    )
