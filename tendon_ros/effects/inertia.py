"""
Inertia: a pulley, with what turns with it, is heavier or lighter than the file says.

Equation::

    J = scale * J_file

The inertia of a motor behind a rigid gear counts as part of the pulley's.

Source: J of the paper's eqs. (1)-(6).
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float) -> None:
    """Scale the inertia of a pulley."""
    numbers['inertia'][index] *= scale


EFFECT = Effect(
    id='inertia',
    title='Inertia',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='scale',
            unit='1',
            meaning='factor on the inertia of the file',
            neutral=1.0,
            low=0.02,
            high=50.0,
            typical=1.5,
        ),
    ),
    modify=modify,
)
