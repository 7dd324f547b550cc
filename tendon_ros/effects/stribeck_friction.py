"""
Stribeck friction: static friction above the sliding one, falling with speed.

A lubricated contact holds more at rest than it rubs in motion. Where the drive is soft, the pulley
then moves in jerks.

Equation::

    |tau| <= sliding + static / (1 + (sqrt(2) - 1) (omega / speed)^2)^2

``static`` is what holding adds to sliding. Machines fall as a Gaussian in some papers, as an
exponential in others. The square of a rational fall lies between the two, comes as near to either
as to the other (2 to 3 % of ``static``), and costs no exponential in the kernel. The constant part
is the same as Coulomb friction; without ``static`` the two cannot be told apart.

Source: a rational fall is that of Hess and Soom, Journal of Tribology 112 (1990); its first power
is as near to an exponential, but ends too slowly for a Gaussian.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def stribeck_friction_law(
    omega: float, side: float, load: float, static: float, sliding: float, speed: float
) -> tuple[float, float, float]:
    """Return the limit of the dry friction [N m], and its slopes."""
    part = omega / speed
    half = math.sqrt(2.0) - 1.0
    once = 1.0 / (1.0 + half * part * part)
    held = once * once
    return sliding + static * held, -4.0 * half * static * part * once * held / speed, 0.0


def no_fall(static: float, sliding: float, speed: float) -> tuple[str, dict[str, float]] | None:
    """Return the Coulomb friction that it is where it falls by less than a tenth in sliding."""
    if static > 0.1 * (static + sliding):
        return None
    return 'coulomb_friction', {'torque': sliding + 0.5 * static}


EFFECT = Effect(
    id='stribeck_friction',
    title='Stribeck friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='static',
            unit='N m',
            meaning='what static friction adds to the sliding one',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.1,
        ),
        Parameter(
            name='sliding',
            unit='N m',
            meaning='friction that remains at high speed',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.04,
        ),
        Parameter(
            name='speed',
            unit='rad/s',
            meaning='speed at which half of the static part is gone',
            neutral=math.nan,
            low=1e-3,
            high=1e3,
            typical=0.1,
        ),
    ),
    hook='budget',
    law=stribeck_friction_law,
    dissipative=True,
    form=0.06,
    other=no_fall,
    holds={'coulomb_friction': ('sliding',)},
)
