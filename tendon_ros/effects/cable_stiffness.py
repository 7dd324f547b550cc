"""
Cable stiffness: the tension curve of a loop differs by a factor.

Another length, strand count or batch, or anchors that give: every tension at a given elongation
is multiplied.

Equation::

    t(x) = scale * t_file(x) for both cables of the loop

The pretension, a force, is not scaled with it: see the effect ``pretension``.

Source: Hooke's law of a cable of another section or length.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float) -> None:
    """Scale the tension curve of a loop."""
    numbers['scale'][index] *= scale


EFFECT = Effect(
    id='cable_stiffness',
    title='Cable stiffness',
    kinds=('cable', 'coupling'),
    parameters=(
        Parameter(
            name='scale',
            unit='1',
            meaning='factor on the tension curve',
            neutral=1.0,
            low=0.05,
            high=20.0,
            typical=0.8,
        ),
    ),
    modify=modify,
    form=0.025,
)
