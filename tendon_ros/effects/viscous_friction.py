"""
Viscous friction: damping that differs from the instrument file.

Grease, churned or cold, resists in proportion to speed. The number is added to the pulley's
damping, so it works for a file that says 0; a negative number says that the file has too much.
Damping as a whole never falls below zero, and a fit ends there.

Equation::

    B = max(0, B_file + damping),  tau = -B * omega

Source: B of the paper's eqs. (1)-(6).
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, damping: float) -> None:
    """Add to the damping of a pulley."""
    values = numbers['damping']
    values[index] = max(0.0, values[index] + damping)


EFFECT = Effect(
    id='viscous_friction',
    title='Viscous friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='damping',
            unit='N m s/rad',
            meaning='added to the damping of the file',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.05,
        ),
    ),
    modify=modify,
    dissipative=True,
    form=0.025,
)
