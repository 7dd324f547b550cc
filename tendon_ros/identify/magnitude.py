"""How large the forces and motions of an instrument are: what sizes of effects suit it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tendon_ros.base.parameter import Parameter
from tendon_ros.base.recording import Recording
from tendon_ros.model.instrument import Instrument

LARGEST = 200.0  # typical sizes that a fit tries
#: of motors, most of the time no more, that typical sizes suit: [N m], [rad/s], [rad]
TORQUE, SPEED, TRAVEL = 5.0, 1.0, 0.25
#: turns of a motor by a turn of a pulley from which on forces there are another kind: radians of a
#: carriage may be metres, and an arm hang behind a gear
GEARED = 3.0
STEP = 0.1  # [s] over which a speed is told, long against what a count makes of it


class Magnitude(NamedTuple):
    """
    How many times as large as typical what an instrument's effects do may be, by their unit.

    ``force``: torques and forces; ``damping``: torques by speed; ``stiffness``: torques by angle.
    1 where they are not larger than typical.
    """

    force: float = 1.0
    damping: float = 1.0
    stiffness: float = 1.0

    def behind(self, gear: float) -> Magnitude:
        """
        Return what the same at a motor is where that turns faster.

        :param gear: turns of the motor by a turn of the place.
        :return: of that place.
        """
        return Magnitude(self.force * gear, self.damping * gear**2, self.stiffness * gear**2)

    def sized(self, parameter: Parameter) -> Parameter:
        """
        Return a parameter as large as it may be here.

        :param parameter: of an effect.
        :return: the same, within what a fit may try, if it is a size with a force in its unit.
        """
        if not parameter.unit.startswith('N') or parameter.is_shape:
            return parameter
        times = {'N m s/rad': self.damping, 'N m/rad': self.stiffness}
        typical = times.get(parameter.unit, self.force) * parameter.typical
        reach = LARGEST * abs(typical)
        low, high = max(parameter.low, -reach), min(parameter.high, reach)
        return replace(parameter, typical=typical, low=low, high=high)


#: that of an instrument which is no larger than typical
TYPICAL = Magnitude()


def magnitudes(instrument: Instrument, magnitude: Magnitude) -> Mapping[str, Magnitude]:
    """
    Return how many times as large as typical effects at each place may be.

    :param instrument: the network.
    :param magnitude: at its motors.
    :return: by place; less than at the motors nowhere.
    """
    gears = _gears(instrument)
    return {place: magnitude.behind(gears.get(place, 1.0)) for place in instrument.places()}


def _gears(instrument: Instrument) -> dict[str, float]:
    """Return by how much motors turn faster than inner pulleys if nothing stretches, by place."""
    if not instrument.links:
        return {}
    driven = [instrument.index(pulley) for pulley in instrument.driven]
    rows = np.zeros((len(instrument.links), len(instrument.pulleys)))
    for row, link in zip(rows, instrument.links, strict=True):
        row[[instrument.index(pulley) for pulley in link.route]] = [*link.route.values()]
    rows /= np.abs(rows).max(axis=1, keepdims=True)
    found = {}
    for pulley in instrument.inner:
        own = instrument.index(pulley)
        turns = np.zeros(len(instrument.pulleys))
        others = np.arange(len(turns)) != own
        turns[others] = np.linalg.lstsq(rows[:, others], -rows[:, own])[0]
        gear = float(np.abs(turns[driven]).max(initial=0.0))
        if gear > GEARED:
            found[f'pulley_{pulley}'] = gear
    return found


def magnitude_of(recordings: Sequence[Recording], instrument: Instrument) -> Magnitude:
    """
    Return how many times as large as typical the forces of an instrument are.

    :param recordings: of it.
    :param instrument: its file.
    :return: by the largest of its motors, and the farthest and fastest of its motions.
    """
    torque, speed, travel = 0.0, 0.0, 0.0
    for sensor in instrument.sensors:
        for channel in (r[sensor.channel] for r in recordings if sensor.channel in r):
            if sensor.kind == 'motor_torque':
                torque = max(torque, float(np.quantile(np.abs(channel.value), 0.95)))
            elif sensor.kind == 'angle' and len(channel.time) > 1:
                times = np.arange(channel.time[0], channel.time[-1], STEP)
                steps = np.abs(np.diff(channel.at(times)))
                # what stands most of the time is as fast as when it moves
                speed = max(speed, float(np.quantile(steps, 0.99)) / STEP if steps.size else 0.0)
                travel = max(travel, float(np.ptp(channel.value)))
    force = max(1.0, torque / TORQUE)
    # where nothing moves, nothing tells a damping
    by_speed = torque / speed / (TORQUE / SPEED) if speed > 0.0 else 1.0
    by_angle = torque / travel / (TORQUE / TRAVEL) if travel > 0.0 else 1.0
    return Magnitude(force, max(force, by_speed), max(force, by_angle))
