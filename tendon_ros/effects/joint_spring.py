"""
Joint spring: a parasitic spring between a pulley and the frame.

A bundle of cables, a wire or a flexible cover that is bent when the joint turns.

Equation::

    tau = -stiffness * (theta - rest)

Source: Hooke's law.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def joint_spring_law(
    theta: float, omega: float, t: float, stiffness: float, rest: float
) -> tuple[float, float, float]:
    """Return the torque of the spring [N m], and its slopes."""
    return -stiffness * (theta - rest), -stiffness, 0.0


EFFECT = Effect(
    id='joint_spring',
    title='Joint spring',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='stiffness',
            unit='N m/rad',
            meaning='torque by angle',
            neutral=0.0,
            low=0.0,
            high=1e6,
            typical=0.2,
        ),
        Parameter(
            name='rest',
            unit='rad',
            meaning='angle at which it is relaxed; turns away, a constant torque',
            neutral=math.nan,
            low=-30 * math.pi,
            high=30 * math.pi,
            typical=0.0,
            search='rest',
        ),
    ),
    hook='torque',
    law=joint_spring_law,
)
