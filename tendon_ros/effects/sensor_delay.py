"""
Sensor delay: a reading that is late.

Filters, buses and slow converters report what was, under the stamp of what is.

Equation::

    reading(t) = truth(t - time)

Source: definition.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers, SENSED
from tendon_ros.base.parameter import Parameter

#: [s] by which a sensor may be late; more is another clock
LONGEST = 0.05


def modify(numbers: Numbers, index: int, time: float) -> None:
    """Delay a sensor."""
    numbers['sensor_delay'][index] += time


EFFECT = Effect(
    id='sensor_delay',
    title='Sensor delay',
    kinds=('sensor',),
    parameters=(
        Parameter(
            name='time',
            unit='s',
            meaning='age of the reading',
            neutral=0.0,
            low=0.0,
            high=LONGEST,
            typical=0.003,
        ),
    ),
    by_others=True,
    modify=modify,
    sensors=SENSED,
)
