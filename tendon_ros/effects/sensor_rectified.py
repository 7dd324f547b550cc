"""
Rectified sensor: a reading without its sign.

Some current sensors and amplifiers measure the size only.

Equation::

    reading = |truth| if rectified >= 0.5, else truth

It is a yes or no: values between 0 and 1 have no meaning of their own.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, rectified: float) -> None:
    """Take the sign from a sensor."""
    if rectified >= 0.5:
        numbers['sensor_rectified'][index] = 1


EFFECT = Effect(
    id='sensor_rectified',
    title='Rectified sensor',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='rectified',
            unit='1',
            meaning='1: the sign is lost, 0: it is not',
            neutral=0.0,
            low=0.0,
            high=1.0,
            typical=1.0,
            search='switch',
        ),
    ),
    modify=modify,
    sensors=('velocity', 'motor_torque', 'contact_force', 'contact_torque', 'loop_torque'),
)
