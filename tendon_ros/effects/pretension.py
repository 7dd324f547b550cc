"""
Pretension: the preload of a loop differs from the instrument file.

Loops are tightened by hand and lose preload over their life. Less preload makes a loop softer
about its rest, lets one of its cables go slack earlier, and takes friction from its pulleys.

Equation::

    t(d0) = scale * pretension of the file,  T(delta) = t(d0 + delta) - t(d0 - delta)

Source: the two cables of a pull-pull loop, each with a curve t; 10 % less in L3 is the paper's
explanation of its Fig. 15.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float) -> None:
    """Scale the pretension of a loop."""
    numbers['pretension'][index] *= scale


EFFECT = Effect(
    id='pretension',
    title='Pretension',
    kinds=('cable',),
    parameters=(
        Parameter(
            name='scale',
            unit='1',
            meaning='factor on the pretension of the file',
            neutral=1.0,
            low=0.0,
            high=50.0,
            typical=0.7,
            search='slack',
        ),
    ),
    modify=modify,
)
