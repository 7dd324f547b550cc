"""
Torque saturation: the motor has a limit that the file does not know.

The amplifier limits the current, or the supply the voltage; the torque that is commanded and
reported does not arrive. Iron that saturates, and a voltage that falls under load, give way little
by little: that is the knee. Without it the limit sets in at once.

Equation, with u = |torque asked for| / limit, from u = 1 - knee to 1 + knee::

    |torque on the pulley| = limit (u - (u - 1 + knee)^2 / (4 knee))

Below it is u limit, beyond it limit; a lower limit of the file holds without a knee. A bias of the
motor comes on top: a drive limits what it asks for, and its current sensor's offset is not part of
that. The neutral value is a torque that no instrument comes near.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, limit: float, knee: float) -> None:
    """Lower the limit of a motor, which sets in over a knee."""
    values = numbers['motor_limit']
    if limit < values[index]:
        values[index] = limit
        numbers['motor_knee'][index] = knee


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
        Parameter(
            name='knee',
            unit='1',
            meaning='part of the limit, below and above it, over which it sets in',
            neutral=0.0,
            low=0.0,
            high=0.6,
            typical=0.05,
            search='shape',
        ),
    ),
    by_others=True,
    modify=modify,
    form=0.025,
)
