"""The numbers of a model by name, which effects modify, and the places where effects act."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import EffectError, listed
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]


@dataclass
class Numbers:
    """The numbers of a model by name, in the instrument's order: what effects may modify."""

    instrument: Instrument
    kind: str = ''  # of the place that an effect is about to modify
    values: dict[str, FloatArray] = field(init=False)

    def __post_init__(self) -> None:
        one = self.instrument
        gear = {m.pulley: m.gear_ratio**2 * m.rotor_inertia for m in one.motors}
        self.values = {
            'inertia': np.array([p.inertia + gear.get(p.name, 0.0) for p in one.pulleys]),
            'damping': np.array([p.damping for p in one.pulleys]),
            'breakaway': np.zeros(len(one.pulleys)),
            'dither': np.zeros(len(one.pulleys)),
            'lash': np.zeros(len(one.pulleys)),
            'radius': one.routing(),
            'arm': one.routing(),
            'pretension': np.array(
                [loop.pretension for loop in one.loops] + [0.0] * len(one.couplings)
            ),
            'scale': np.ones(len(one.links)),
            'hardening': np.ones(len(one.links)),
            'loop_damping': np.array([row.damping for row in one.links]),
            'play': np.zeros(len(one.links)),
            'contact_stiffness': np.array([c.stiffness for c in one.contacts]),
            'contact_damping': np.array([c.damping for c in one.contacts]),
            'contact_position': np.array([c.position for c in one.contacts]),
            'motor_gain': np.ones(len(one.motors)),
            'motor_bias': np.zeros(len(one.motors)),
            'motor_limit': np.array([min(m.torque_limit, 1e300) for m in one.motors]),
            'motor_knee': np.zeros(len(one.motors)),
            'motor_pulley': np.array([one.index(m.pulley) for m in one.motors]),
            'sensor_gain': np.ones(len(one.sensors)),
            'sensor_offset': np.zeros(len(one.sensors)),
            'sensor_delay': np.zeros(len(one.sensors)),
            'sensor_lag': np.zeros(len(one.sensors)),
            'sensor_rectified': np.zeros(len(one.sensors)),
        }
        for k, row in enumerate(one.loops):
            for name, sign in row.torque_sign.items():
                self.values['arm'][k, one.index(name)] *= sign

    def copy(self) -> Numbers:
        """Return the same numbers, which may be modified on their own."""
        other = copy(self)
        other.values = {name: value.copy() for name, value in self.values.items()}
        return other

    def __getitem__(self, name: str) -> FloatArray:
        return self.values[name]

    def loops_on(self, pulley: int) -> Sequence[int]:
        """Return the loops and couplings that touch a pulley."""
        return [int(k) for k in np.flatnonzero(self.values['radius'][:, pulley])]


def place_index(instrument: Instrument, place: str) -> tuple[str, int]:
    """
    Return the kind of a place and its index among those of its kind.

    :param instrument: the instrument.
    :param place: a name by the contract, such as ``pulley_3`` or ``cable_L3``.
    :return: kind (pulley, cable, coupling, motor, sensor, contact) and index; couplings are
        counted after the loops.
    :raises EffectError: where there is no such place.
    """
    found = instrument.place_indices.get(place)
    if found is None:
        raise EffectError(
            f'{instrument.name}: no place {place!r}; it has {listed(instrument.places())}'
        )
    return found
