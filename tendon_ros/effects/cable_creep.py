"""
Cable creep: slow relaxation under load.

A loaded cable, its sheath and its anchors settle: at a held angle the force falls to a lower level
over seconds, and comes back after unloading.

Equation, with T the net force of the loop and s an elongation that follows the present one::

    T = share * (T(delta) - fraction * T(s)) + (1 - share) * T(delta - fraction * s)
    ds/dt = (delta - s) / time

On a linear cable this is the standard linear solid, whatever the share: the stiffness falls from
K at once to K * (1 - fraction) in the long run. On a curve that bends it matters what relaxes:
where strands and fibres yield, every tension by the same fraction (share 1); where sheath and
anchors give way, the elongation (share 0). The state is z = s / (1 mm), so that it is of order
one, and exists where the fraction is zero.

A closed cycle never gives power as long as the tension grows with elongation. With
delta = s + time * ds/dt, the tension's part takes fraction * time times the integral of
T'(s) * (ds/dt)**2 over time. With x = delta - fraction * s, and x' = s * (1 - fraction) the x at
which s would rest, the elongation's part takes fraction / time times the integral of
(T(x) - T(x')) * (x - x') over time, and both factors have the same sign.

What is left out: the preload of both cables settles too; give the pretension as it is when used.
More than one time constant; over seconds one stands for several within one to three tenths.

Source: Zener's standard linear solid; for the tension's part the quasi-linear viscoelasticity of
Fung (Biomechanics, 1981), with the elongation filtered instead of the tension.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def cable_creep_law(
    delta: float, z: float, fraction: float, time: float, share: float
) -> tuple[float, float, float, float, float, float, float]:
    """Return the elongation [m] that has settled and how it acts, with the rate of its state."""
    scale = 1e-3  # [m], so that the state is of order one
    return (
        scale * z,
        scale,
        fraction,
        share,
        (delta / scale - z) / time,
        1.0 / (scale * time),
        -1.0 / time,
    )


def soft_at_once(
    fraction: float, time: float, share: float
) -> tuple[str, dict[str, float]] | None:
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
        Parameter(
            name='share',
            unit='1',
            meaning='part of it that relaxes as tension; the rest does as elongation',
            neutral=math.nan,
            low=0.0,
            high=1.0,
            typical=0.5,
        ),
    ),
    hook='relaxation',
    law=cable_creep_law,
    stateful=True,
    dissipative=True,
    form=0.3,
    other=soft_at_once,
)
