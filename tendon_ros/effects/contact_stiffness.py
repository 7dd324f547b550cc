"""
Contact stiffness: what the instrument touches is softer or harder than the file says.

Equation::

    k = scale * k_file

The damping number of the file stays: with the Hunt-Crossley law it is a factor on the spring's
force, so the damping force scales along; with spring and damper it does not.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, scale: float) -> None:
    """Scale the stiffness of a contact."""
    numbers['contact_stiffness'][index] *= scale


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
    ),
    modify=modify,
    form=0.025,
)
