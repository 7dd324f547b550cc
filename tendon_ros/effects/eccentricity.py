"""
Eccentricity: the radius of a pulley varies over the turn.

A pulley bored off its centre, or a cable that lies unevenly in its groove, winds more cable in one
part of the turn than in another. Elongation and lever of the cables both change, as virtual work
demands.

Equation::

    R(theta) = R * (1 + amplitude * cos(theta - phase))
    arc = integral of R(theta) / R - 1 from 0
        = amplitude * (sin(theta - phase) + sin(phase))

``amplitude`` is the distance between centre and axis by the radius. At theta = 0 nothing is added:
that is where the cables were mounted. All loops on the pulley see the same.

Up to a fifth of the radius the first order is good to two per cent. A wheel that were bored off by
more would, over a small turn, be a wheel of another size, and imitate whatever sits on it.

Source: geometry of a circle about another point, to first order.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter

LARGEST = 0.2  # amplitude up to which the first order is good


def eccentricity_law(theta: float, amplitude: float, phase: float) -> tuple[float, float, float]:
    """Return the angle [rad] that is added for the cables, and its first two slopes."""
    arc = amplitude * math.sin(theta - phase)
    return arc + amplitude * math.sin(phase), amplitude * math.cos(theta - phase), -arc


EFFECT = Effect(
    id='eccentricity',
    title='Eccentricity',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='amplitude',
            unit='1',
            meaning='distance between centre and axis, by the radius',
            neutral=0.0,
            low=-LARGEST,
            high=LARGEST,
            typical=0.02,
        ),
        Parameter(
            name='phase',
            unit='rad',
            meaning='angle at which the radius is largest (smallest if the amplitude is negative)',
            neutral=math.nan,
            low=-math.pi / 2,
            high=math.pi / 2,
            typical=0.0,
            search='phase',
        ),
    ),
    hook='winding',
    law=eccentricity_law,
    form=0.025,
)
