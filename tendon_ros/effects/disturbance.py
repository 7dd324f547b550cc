"""
Disturbance: an external torque on a pulley for a limited time.

Somebody leans on the instrument, or it knocks against something that the model does not have.

Equation::

    tau = torque while start <= t < start + duration, else 0

Source: definition.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect
from tendon_ros.base.parameter import Parameter


def disturbance_law(
    theta: float, omega: float, t: float, torque: float, start: float, duration: float
) -> tuple[float, float, float]:
    """Return the torque [N m] at time t."""
    return (torque if start <= t < start + duration else 0.0), 0.0, 0.0


def switches(torque: float, start: float, duration: float) -> tuple[float, ...]:
    """Return the times [s] at which the law changes."""
    return (start, start + duration)


EFFECT = Effect(
    id='disturbance',
    title='Disturbance',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='torque',
            unit='N m',
            meaning='torque while it lasts',
            neutral=0.0,
            low=-1e5,
            high=1e5,
            typical=0.2,
        ),
        Parameter(
            name='start',
            unit='s',
            meaning='when it begins, counted from the start of the recording',
            neutral=math.nan,
            low=0.0,
            high=1e6,
            typical=5.0,
            search='instant',
        ),
        Parameter(
            name='duration',
            unit='s',
            meaning='how long it lasts',
            neutral=math.nan,
            low=1e-3,
            high=1e6,
            typical=0.5,
            search='duration',
        ),
    ),
    hook='torque',
    law=disturbance_law,
    switches=switches,
    form=0.12,
)
