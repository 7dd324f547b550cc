"""
Cable slip: a sudden jump of a rest length or of a coupling angle, at a time.

A cable slips in its anchor or jumps a groove, a clamped shaft turns in its coupling. From then on
everything is as before, but with another zero.

Equation::

    T = T(delta + jump) from t = time on

A positive jump acts like more elongation: the cable that pulls at positive delta got shorter, the
other one longer. At a coupling the jump is one of its twist, in rad.

Source: definition.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def cable_slip_law(delta: float, t: float, jump: float, time: float) -> tuple[float, float]:
    """Return the elongation [m] that the slip has added."""
    return (jump if t >= time else 0.0), 0.0


def switches(jump: float, time: float) -> tuple[float, ...]:
    """Return the times [s] at which the law changes."""
    return (time,)


EFFECT = Effect(
    id='cable_slip',
    title='Cable slip',
    kinds=('cable', 'coupling'),
    parameters=(
        Parameter(
            name='jump',
            unit='m',
            meaning='elongation that is added; at a coupling a twist in rad',
            neutral=0.0,
            low=-0.1,
            high=0.1,
            typical=5e-4,
        ),
        Parameter(
            name='time',
            unit='s',
            meaning='when, counted from the start of the recording',
            neutral=math.nan,
            low=0.0,
            high=1e6,
            typical=5.0,
            search='instant',
        ),
    ),
    hook='elongation',
    law=cable_slip_law,
    switches=switches,
    form=0.1,
)
