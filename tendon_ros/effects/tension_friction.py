"""
Tension-proportional friction: the harder the cables press a pulley down, the more it rubs.

Both cables of every loop on a pulley press it onto its axis, also at rest, so preload alone makes
friction, and a loaded instrument has more of it. The paper adds it for its Fig. 15.

Equation::

    |tau| <= coefficient * sum over the loops on the pulley of |R| * (t_a + t_b)

``t_a`` and ``t_b`` are the tensions of a loop's two cables, ``R`` is its radius on the pulley. The
coefficient is that of a bearing as large as the pulley: for a bearing of radius r and a friction
coefficient mu it is about mu * r / R. Cables that leave on opposite sides press less; that too
is within the coefficient.

Source: the paper's Fig. 15; bearing friction by its load is textbook.
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
            meaning='friction by the load of the cables',
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
)
