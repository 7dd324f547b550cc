"""
Tension-proportional friction: the harder a pulley is loaded, the more it rubs.

Both cables of every loop on a pulley press it onto its axis, also at rest, so preload alone makes
friction, and a loaded instrument has more of it. The paper adds it for its Fig. 15. Gears and
bearings without cables rub with the torque that passes through them instead: an arm on a geared
servo rubs most where its weight is farthest out.

Equation::

    |tau| <= coefficient * load

    load = sum over the loops on the pulley of |R| * (t_a + t_b)           with cables
    load = |tau_outside| + sum over its couplings of |tau_coupling|        without

``t_a`` and ``t_b`` are the tensions of a loop's two cables, ``R`` is its radius on the pulley.
``tau_outside`` is what contacts, gravity, springs and disturbances do to a pulley without cables,
``tau_coupling`` what a coupling transmits to it. With cables the coefficient is that of a bearing
as large as the pulley: for a bearing of radius r and a friction coefficient mu it is about
mu * r / R. Cables that leave on opposite sides press less; that too is within the coefficient.
Without, it is the part of the torque that is lost: 0.2 is a gear of 80 % efficiency.

What is left out: a gear that accelerates an inertia rubs by that torque as well.

Source: the paper's Fig. 15; bearing friction by its load and losses of gears are textbook.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def tension_friction_law(
    speed: float, side: float, load: float, coefficient: float
) -> tuple[float, float, float]:
    """Return the limit of the dry friction [N m], and its slopes."""
    return coefficient * load, 0.0, coefficient


EFFECT = Effect(
    id='tension_friction',
    title='Tension-proportional friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='coefficient',
            unit='1',
            meaning='friction by the load',
            neutral=0.0,
            low=0.0,
            high=1.0,
            typical=0.1,
        ),
    ),
    hook='budget',
    law=tension_friction_law,
    dissipative=True,
    form=0.06,
    by_others=True,
)
