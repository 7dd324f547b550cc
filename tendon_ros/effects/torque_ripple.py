"""
Torque ripple: cogging of the motor, periodic over the turn.

Magnets prefer the teeth of the stator, commutation is uneven, the teeth of a gear mesh one after
the other. The motor does not report it.

Equation::

    tau = amplitude * sin(cycles * theta - phase)

Cycles are counted per turn of the driven pulley: those of a motor times the gear's ratio. Half a
turn of phase is enough, as the amplitude may be negative.

Source: first harmonic of any periodic torque.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def torque_ripple_law(
    theta: float, omega: float, t: float, amplitude: float, cycles: float, phase: float
) -> tuple[float, float, float]:
    """Return the torque of the ripple [N m], and its slopes."""
    angle = cycles * theta - phase
    return amplitude * math.sin(angle), amplitude * cycles * math.cos(angle), 0.0


EFFECT = Effect(
    id='torque_ripple',
    title='Torque ripple',
    kinds=('motor',),
    parameters=(
        Parameter(
            name='amplitude',
            unit='N m',
            meaning='largest torque of the ripple',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.02,
        ),
        Parameter(
            name='cycles',
            unit='1',
            meaning='periods in a turn of the pulley',
            neutral=math.nan,
            low=0.5,
            high=1000.0,
            typical=12.0,
            search='cycles',
        ),
        Parameter(
            name='phase',
            unit='rad',
            meaning='phase of the ripple at angle zero',
            neutral=math.nan,
            low=-math.pi / 2,
            high=math.pi / 2,
            typical=0.0,
            search='phase',
        ),
    ),
    hook='torque',
    law=torque_ripple_law,
    form=0.2,
)
