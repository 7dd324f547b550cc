"""
Sensor delay: a reading that is late.

Filters, buses and slow converters report what was, under the stamp of what is.

Equation::

    lag ds/dt = f(truth(t - (1 - filtered) time)) - s,  reading(t) = s(t),  lag = filtered time

where f is what else the sensor does (its gain and zero, a lost sign): a pulse counter counts, and
its counts are smoothed. Nothing is filtered where ``filtered`` is zero: f(truth(t - time)) is
read. To slow motion both are the same; only for a sensor of speed does a diagnosis tell them
apart, since only that reads what jumps.

Source: definition.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect, Numbers, SENSED
from tendon_ros.base.parameter import Parameter

#: [s] by which a sensor may be late; more is another clock
LONGEST = 0.05


def modify(numbers: Numbers, index: int, time: float, filtered: float) -> None:
    """Delay a sensor."""
    numbers['sensor_delay'][index] += (1.0 - filtered) * time
    numbers['sensor_lag'][index] += filtered * time


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
        Parameter(
            name='filtered',
            unit='1',
            meaning='part of that age which is the time constant of a low-pass filter',
            neutral=math.nan,
            low=0.0,
            high=1.0,
            typical=0.0,
            search='share',
            sensors=('velocity',),
        ),
    ),
    by_others=True,
    modify=modify,
    sensors=SENSED,
)
