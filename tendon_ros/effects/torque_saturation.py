"""
Torque saturation: the motor has a limit that the file does not know.

The amplifier limits the current, or the supply the voltage; the torque that is commanded and
reported does not arrive.

Equation::

    |torque on the pulley| <= min(limit of the file, limit)

The neutral value is a torque that no instrument comes near.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, limit: float) -> None:
    """Lower the limit of a motor."""
    values = numbers['motor_limit']
    values[index] = min(values[index], limit)


EFFECT = Effect(
    id='torque_saturation',
    title='Torque saturation',
    kinds=('motor',),
    parameters=(
        Parameter(
            name='limit',
            unit='N m',
            meaning='largest torque on the pulley',
            neutral=1000.0,
            low=1e-3,
            high=1000.0,
            typical=1.0,
            search='level',
        ),
    ),
    modify=modify,
    form=0.025,
)
