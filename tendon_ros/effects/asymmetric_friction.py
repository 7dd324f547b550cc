"""
Asymmetric friction: dry friction that differs with direction.

Seals, helical gears and cables that climb their groove rub more one way than the other.

Equation::

    |tau| <= forward while moving (or pushed) along +theta, backward the other way

The mean of the two acts like Coulomb friction; half of their difference acts like a torque bias
that vanishes at rest.

Source: Armstrong-Helouvry, "Control of Machines with Friction" (1991).
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def asymmetric_friction_law(
    speed: float, side: float, load: float, forward: float, backward: float
) -> tuple[float, float, float]:
    """Return the limit of the dry friction [N m], and its slopes."""
    return (forward if side > 0.0 else backward), 0.0, 0.0


def no_difference(forward: float, backward: float) -> tuple[str, dict[str, float]] | None:
    """Return the Coulomb friction that it is where both directions are within a tenth."""
    if abs(forward - backward) > 0.1 * max(forward, backward):
        return None
    return 'coulomb_friction', {'torque': 0.5 * (forward + backward)}


def two_at_once(forward: float, backward: float) -> dict[str, float]:
    """Return the Coulomb friction and the constant torque that are as much, each way."""
    return {
        'coulomb_friction': 0.5 * (forward + backward),
        'torque_bias': 0.5 * abs(forward - backward),
    }


EFFECT = Effect(
    id='asymmetric_friction',
    title='Asymmetric friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='forward',
            unit='N m',
            meaning='friction of motion along +theta',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.08,
        ),
        Parameter(
            name='backward',
            unit='N m',
            meaning='friction of motion along -theta',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.03,
        ),
    ),
    hook='budget',
    law=asymmetric_friction_law,
    dissipative=True,
    form=0.06,
    other=no_difference,
    alike=two_at_once,
    holds={'coulomb_friction': ('forward', 'backward')},
)
