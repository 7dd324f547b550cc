"""
Torque gain: the motor gives another torque than it reports.

The torque constant, the gear's efficiency or the scale of the current sensor is off by a factor.

Equation::

    torque on the pulley = gain * reported torque

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, gain: float) -> None:
    """Scale the gain of a motor."""
    numbers['motor_gain'][index] *= gain


EFFECT = Effect(
    id='torque_gain',
    title='Torque gain',
    kinds=('motor',),
    parameters=(
        Parameter(
            name='gain',
            unit='1',
            meaning='torque on the pulley by reported torque',
            neutral=1.0,
            low=0.02,
            high=50.0,
            typical=0.9,
        ),
    ),
    by_others=True,
    modify=modify,
)
