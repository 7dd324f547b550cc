"""
Cable creep: slow relaxation under load.

A loaded cable, its sheath and its anchors settle: at a held angle the force falls to a lower level
over seconds, and comes back after unloading.

Equation, with c the part of the elongation that no longer stretches::

    T = T(delta - c),  dc/dt = (fraction * delta - c) / time

On a linear cable this is the standard linear solid: the stiffness falls from K at once to
K * (1 - fraction) in the long run. The state is z = c / (fraction * 1 mm), so that it is of order
one, and exists where the fraction is zero.

A closed cycle never gives power as long as the tension grows with elongation: with x = delta - c,
and x' the stretch at which c would rest, it takes fraction / time times the integral of
(T(x) - T(x')) * (x - x') over time, and both factors have the same sign.

What is left out: the preload of both cables settles too; give the pretension as it is when used.

Source: Zener's standard linear solid.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def cable_creep_law(
    delta: float, rate: float, z: float, t: float, fraction: float, time: float
) -> tuple[float, float, float, float, float, float, float]:
    """Return the elongation [m] that has relaxed, and the rate of its state, with their slopes."""
    scale = 1e-3  # [m], so that the state is of order one
    return (
        -fraction * scale * z,
        0.0,
        -fraction * scale,
        (delta / scale - z) / time,
        1.0 / (scale * time),
        0.0,
        -1.0 / time,
    )


def soft_at_once(fraction: float, time: float) -> tuple[str, dict[str, float]] | None:
    """Return the softer cable that it is where it has relaxed before anyone could see it creep."""
    if time > 0.3:
        return None
    return 'cable_stiffness', {'scale': 1.0 - fraction}


EFFECT = Effect(
    id='cable_creep',
    title='Cable creep',
    kinds=('cable',),
    parameters=(
        Parameter(
            name='fraction',
            unit='1',
            meaning='part of the stiffness that relaxes in the long run',
            neutral=0.0,
            low=0.0,
            high=0.95,
            typical=0.1,
        ),
        Parameter(
            name='time',
            unit='s',
            meaning='time constant at a held elongation',
            neutral=math.nan,
            low=0.01,
            high=1e4,
            typical=5.0,
        ),
    ),
    hook='elongation',
    law=cable_creep_law,
    stateful=True,
    dissipative=True,
    form=0.4,
    other=soft_at_once,
)
