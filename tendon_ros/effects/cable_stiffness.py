"""
Cable stiffness: the tension curve of a loop differs by a factor.

Another length, strand count or batch, or anchors that give: every tension at a given elongation
is multiplied.

Equation::

    t(x) = scale * t_file(x_s + (x_e - x_s) * ((x - x_s) / (x_e - x_s))^hardening)

for both cables of the loop, x_s and x_e where the file's curve starts and ends. The pretension, a
force, is not scaled with it: see the effect ``pretension``.

A hardening other than one, or another damping, is no cause by itself: they are found where the
file calls the shape of the curve, or the damping, a guess.

Source: Hooke's law of a cable of another section or length; ropes stiffen while their strands
settle, which a power of the elongation follows.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float, hardening: float, damping: float) -> None:
    """Scale and bend the tension curve of a loop, and add to its damping."""
    numbers['scale'][index] *= scale
    numbers['hardening'][index] *= hardening
    damped = numbers['loop_damping']
    damped[index] = max(0.0, damped[index] + damping)


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
            low=0.02,
            high=50.0,
            typical=0.8,
        ),
        Parameter(
            name='hardening',
            unit='1',
            meaning='exponent on the elongation, from where the curve starts to where it ends',
            neutral=1.0,
            low=0.7,
            high=4.0,
            typical=1.5,
            search='guess',
        ),
        Parameter(
            name='damping',
            unit='N s/m',
            meaning='added to the damping of the file; of a coupling in N m s/rad',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=1.0,
            search='guess',
        ),
    ),
    modify=modify,
    form=0.025,
)
