"""The channels that an experiment can have, those of sensors that are not there yet included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import channel_name
from tendon_ros.identify.driving import Drive
from tendon_ros.model.instrument import Instrument, Sensor
from tendon_ros.model.rows import Rows

FloatArray = NDArray[np.float64]

COUNTS = 16384  # of a joint encoder whose resolution is not known
PART = 1e-3  # of the largest torque: noise of a torque or force sensor that is not known
RATE = 500.0  # [Hz] of a recording
#: rows for which a count tells nothing new
PER_COUNT = 4.0


@dataclass(frozen=True)
class Sensed:
    """
    A channel of an experiment.

    ``status``: 'measured', 'silent' (the sensor is there, the channel was not recorded), or
    'missing' (a sensor that would have to be mounted). ``column``: of the instrument's sensors, -1
    for a missing one, which reads the truth.
    """

    sensor: Sensor
    status: str
    column: int

    def reading(self, rows: Rows) -> FloatArray:
        """
        Return what it says.

        :param rows: simulated or predicted.
        :return: shape (rows,).
        """
        if self.column >= 0:
            return rows.reading[:, self.column]
        one = rows.instrument
        if self.sensor.kind == 'angle':
            return rows.angle[:, one.index(self.sensor.of)]
        return rows.contact_force[:, [c.name for c in one.contacts].index(self.sensor.of)]

    @property
    def title(self) -> str:
        """What the sensor is, for a sentence."""
        if self.sensor.kind == 'angle':
            return f'an encoder on pulley {self.sensor.of}'
        if self.sensor.kind.startswith('contact'):
            return f'a load cell at {self.sensor.of}'
        return f'the sensor {self.sensor.name}'


def channels(
    instrument: Instrument, driving: Sequence[Drive], measured: Sequence[str]
) -> list[Sensed]:
    """
    Return every channel that could be compared with the model.

    :param instrument: the network.
    :param driving: what drives the model.
    :param measured: channels that the recordings have.
    :return: the channels, without those that drive the model.
    """
    drive = {d.sensor.channel for d in driving}
    found = [
        Sensed(_noisy(instrument, s), 'measured' if s.channel in measured else 'silent', n)
        for n, s in enumerate(instrument.sensors)
        if s.channel not in drive
    ]
    read = {s.of for s in instrument.sensors if s.kind == 'angle'}
    for name in instrument.inner:
        if name not in read:
            channel = channel_name('pulley', f'pulley_{name}', 'position')
            sensor = Sensor(f'encoder_{name}', 'angle', name, channel)
            found.append(Sensed(_noisy(instrument, sensor), 'missing', -1))
    if instrument.contacts and not any(s.kind.startswith('contact') for s in instrument.sensors):
        contact = instrument.contacts[0].name
        sensor = Sensor('load_cell', 'contact_force', contact, 'load_cell/force')
        found.append(Sensed(_noisy(instrument, sensor), 'missing', -1))
    return found


def row_noise(sensor: Sensor) -> float:
    """
    Return the noise of a row.

    :param sensor: the sensor; its counts are worse than white noise, since they repeat.
    :return: one standard deviation, in the sensor's unit.
    """
    return math.hypot(math.sqrt(PER_COUNT / 12.0) * sensor.resolution, sensor.noise)


def _noisy(instrument: Instrument, sensor: Sensor) -> Sensor:
    """Return a sensor with usual noise where the file says that it has none."""
    if sensor.resolution > 0.0 or sensor.noise > 0.0:
        return sensor
    if sensor.kind == 'angle':
        return replace(sensor, resolution=2.0 * math.pi / COUNTS)
    if sensor.kind == 'velocity':
        return replace(sensor, noise=2.0 * math.pi / COUNTS * RATE / 10.0)
    limits = [m.largest for m in instrument.motors]
    largest = max((limit for limit in limits if math.isfinite(limit)), default=1.0)
    if sensor.kind == 'contact_force':
        [arm] = [c.arm for c in instrument.contacts if c.name == sensor.of]
        return replace(sensor, noise=PART * largest / arm)
    return replace(sensor, noise=PART * largest)
