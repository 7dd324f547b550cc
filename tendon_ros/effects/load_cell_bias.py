"""
Load cell bias: the measured force has another zero.

The cell was tared under load, or drifts with temperature.

Equation::

    reading = true force + force

Where the cell measures a torque, the number is one in N m.

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, force: float) -> None:
    """Add to the offset of a sensor."""
    numbers['sensor_offset'][index] += force


EFFECT = Effect(
    id='load_cell_bias',
    title='Load cell bias',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='force',
            unit='N',
            meaning='reading without load; in N m where a torque is measured',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.3,
            of_reading=True,
        ),
    ),
    modify=modify,
    sensors=('contact_force', 'contact_torque', 'loop_torque'),
)
