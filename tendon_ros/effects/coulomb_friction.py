"""
Coulomb friction: a constant torque against the motion.

Bearings and seals rub with the same torque at any speed. It opposes the motion, and a pulley that
is pushed by less than it stays where it is.

Equation::

    |tau| <= torque,  tau = -torque * sign(omega) while sliding

Source: the textbook law, as in Armstrong-Helouvry, Dupont and Canudas de Wit, "A survey of models,
analysis tools and compensation methods for the control of machines with friction", Automatica
30 (1994).
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def coulomb_friction_law(
    speed: float, side: float, load: float, torque: float
) -> tuple[float, float, float]:
    """Return the limit of the dry friction [N m], and its slopes."""
    return torque, 0.0, 0.0


EFFECT = Effect(
    id='coulomb_friction',
    title='Coulomb friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='torque',
            unit='N m',
            meaning='friction at any speed',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.05,
        ),
    ),
    hook='budget',
    law=coulomb_friction_law,
    dissipative=True,
    form=0.06,
)
