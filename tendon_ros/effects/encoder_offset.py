"""
Encoder offset: an angle sensor has another zero.

Homing against a stop is only as good as the stop.

Equation::

    reading = angle of the pulley + angle

A controller that reads the sensor steers to the wrong place.

Source: definition.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, angle: float) -> None:
    """Add to the offset of a sensor."""
    numbers['sensor_offset'][index] += angle


EFFECT = Effect(
    id='encoder_offset',
    title='Encoder offset',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='angle',
            unit='rad',
            meaning='reading at the true zero',
            neutral=0.0,
            low=-math.pi,
            high=math.pi,
            typical=0.01,
        ),
    ),
    modify=modify,
    sensors=('angle',),
)
