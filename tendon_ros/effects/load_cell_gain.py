"""
Load cell gain: the measured force has another scale.

The calibration of the cell or of its amplifier has drifted, or the cell sits at another arm than
assumed.

Equation::

    reading = gain * force

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, gain: float) -> None:
    """Scale the gain of a sensor."""
    numbers['sensor_gain'][index] *= gain


EFFECT = Effect(
    id='load_cell_gain',
    title='Load cell gain',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='gain',
            unit='1',
            meaning='reading by true force',
            neutral=1.0,
            low=0.1,
            high=10.0,
            typical=1.05,
        ),
    ),
    by_others=True,
    modify=modify,
    sensors=('contact_force', 'contact_torque', 'loop_torque'),
)
