"""Factors by which a channel is off when its unit is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

#: relative distance from a factor that still is that factor
NEAR = 0.1
DEGREES = 180.0 / np.pi

_ANGLE = {
    DEGREES: 'in degrees instead of rad',
    1.0 / DEGREES: 'rad had been converted to rad once more',
    1e3: 'in mrad instead of rad',
    1.0 / (2.0 * np.pi): 'in turns instead of rad',
}
_TORQUE = {
    1e3: 'in mN m instead of N m',
    1e-3: 'in kN m instead of N m',
}
_FORCE = {
    1e3: 'in mN instead of N',
    1e-3: 'in kN instead of N',
}
#: by kind of sensor: a factor and what it means
FACTORS: Mapping[str, Mapping[float, str]] = MappingProxyType(
    {
        'angle': _ANGLE,
        'velocity': _ANGLE,
        'motor_torque': _TORQUE,
        'loop_torque': _TORQUE,
        'contact_torque': _TORQUE,
        'contact_force': _FORCE,
    }
)


def factor_name(factor: float, kind: str, resolution: float = 0.0) -> str:
    """
    Return what a factor between reading and truth means.

    :param factor: reading by truth, positive.
    :param kind: of the sensor.
    :param resolution: one count of it, 0 where unknown.
    :return: a phrase that follows 'as if'; empty where the factor is that of no unit.
    """
    known = dict(FACTORS[kind])
    if resolution > 0.0:
        known.setdefault(1.0 / resolution, 'in counts instead of SI units')
    for candidate, phrase in known.items():
        if abs(factor / candidate - 1.0) < NEAR:
            return phrase
    return ''
