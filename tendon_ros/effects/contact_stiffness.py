"""
Contact stiffness: what the instrument touches is softer or harder than the file says.

Equation::

    k = scale * k_file

The damping number of the file stays: with the Hunt-Crossley law it is a factor on the spring's
force, so the damping force scales along; with spring and damper it does not. Another damping is
no cause by itself: it is found where the file calls it a guess, gives it a tolerance or says
nothing of it.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float, damping: float) -> None:
    """Scale the stiffness of a contact, and add to its damping."""
    numbers['contact_stiffness'][index] *= scale
    damped = numbers['contact_damping']
    damped[index] = max(0.0, damped[index] + damping)


EFFECT = Effect(
    id='contact_stiffness',
    title='Contact stiffness',
    kinds=('contact',),
    parameters=(
        Parameter(
            name='scale',
            unit='1',
            meaning='factor on the stiffness of the file',
            neutral=1.0,
            low=1e-3,
            high=100.0,
            typical=0.5,
        ),
        Parameter(
            name='damping',
            unit='s/m',
            meaning='added to the damping of the file; with spring and damper in N s/m',
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
