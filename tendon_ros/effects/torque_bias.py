"""
Torque bias: the motor gives a constant torque that it does not report.

An offset of the current sensor or of the amplifier.

Equation::

    torque on the pulley = reported torque + torque

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, torque: float) -> None:
    """Add to the bias of a motor."""
    numbers['motor_bias'][index] += torque


EFFECT = Effect(
    id='torque_bias',
    title='Torque bias',
    kinds=('motor',),
    parameters=(
        Parameter(
            name='torque',
            unit='N m',
            meaning='torque at a reported torque of zero',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.05,
        ),
    ),
    modify=modify,
)
