"""
Gravity: the weight of what a pulley carries.

Equation::

    tau = -torque * sin(theta - phase)

``torque`` is weight times distance of the centre of mass from the axis; at theta = phase it hangs
straight down. A negative torque with the same phase stands upright there: so half a turn of phase
is enough for every direction.

Source: the pendulum.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def gravity_law(
    theta: float, omega: float, t: float, torque: float, phase: float
) -> tuple[float, float, float]:
    """Return the torque of the weight [N m], and its slopes."""
    return -torque * math.sin(theta - phase), -torque * math.cos(theta - phase), 0.0


EFFECT = Effect(
    id='gravity',
    title='Gravity',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='torque',
            unit='N m',
            meaning='largest torque, a quarter turn away from hanging',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.1,
        ),
        Parameter(
            name='phase',
            unit='rad',
            meaning='angle at which the weight hangs straight down',
            neutral=math.nan,
            low=-math.pi / 2,
            high=math.pi / 2,
            typical=math.pi / 4,
            search='phase',
        ),
    ),
    hook='torque',
    law=gravity_law,
)
