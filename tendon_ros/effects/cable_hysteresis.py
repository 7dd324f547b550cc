"""
Cable hysteresis: a loop in tension against elongation.

The strands of a wire rope rub on each other when it is stretched, and a cable rubs on its sheath:
the net force of the loop is higher while it is being elongated than on the way back, at any speed.

Equation, with z the used part of the force and sigma = sign(rate of delta)::

    T = T(delta) + force * z
    dz/dt = rate / elongation * (1 - sigma * z)

``force`` is half of the height of the full loop, ``elongation`` the stretch over which it builds
up after a reversal. Part of a small reversal is given back; a closed cycle never gives power.

Source: Dahl (1968) on the elongation of a cable; that instrument cables need such a term was
shown by Miyasaka and others for the RAVEN (ICRA 2016), there with the Bouc-Wen form.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def cable_hysteresis_law(
    delta: float, rate: float, z: float, t: float, force: float, elongation: float
) -> tuple[float, float, float, float, float, float, float, float]:
    """Return the force [N] that the loop adds, and the rate of its state, with their slopes."""
    way = 1.0 if rate > 0.0 else (-1.0 if rate < 0.0 else 0.0)
    left = (1.0 - way * z) / elongation
    return force * z, 0.0, 0.0, force, rate * left, 0.0, left, -abs(rate) / elongation


EFFECT = Effect(
    id='cable_hysteresis',
    title='Cable hysteresis',
    kinds=('cable',),
    parameters=(
        Parameter(
            name='force',
            unit='N',
            meaning='half of the height of the full loop',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=2.0,
        ),
        Parameter(
            name='elongation',
            unit='m',
            meaning='stretch over which it builds up after a reversal',
            neutral=math.nan,
            low=1e-6,
            high=0.01,
            typical=1e-4,
        ),
    ),
    hook='tension',
    law=cable_hysteresis_law,
    stateful=True,
    dissipative=True,
    form=0.12,
)
