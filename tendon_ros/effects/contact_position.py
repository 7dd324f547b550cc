"""
Contact position: what the instrument touches is elsewhere than the file says.

Equation::

    contact where q > q_file + angle

``q`` is the angle of the contact's coordinate: for a single pulley its own angle.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, angle: float) -> None:
    """Move a contact."""
    numbers['contact_position'][index] += angle


EFFECT = Effect(
    id='contact_position',
    title='Contact position',
    kinds=('contact',),
    parameters=(
        Parameter(
            name='angle',
            unit='rad',
            meaning='added to the angle at touch',
            neutral=0.0,
            low=-1.0,
            high=1.0,
            typical=0.005,
        ),
    ),
    modify=modify,
)
