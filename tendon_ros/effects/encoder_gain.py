"""
Encoder gain: an angle sensor has another scale.

A wrong count of lines or gear ratio in the file, or a potentiometer that is out of calibration.

Equation::

    reading = gain * angle of the pulley

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, gain: float) -> None:
    """Scale the gain of a sensor."""
    numbers['sensor_gain'][index] *= gain


EFFECT = Effect(
    id='encoder_gain',
    title='Encoder gain',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='gain',
            unit='1',
            meaning='reading by true angle',
            neutral=1.0,
            low=0.2,
            high=5.0,
            typical=1.02,
        ),
    ),
    by_others=True,
    modify=modify,
    sensors=('angle',),
)
