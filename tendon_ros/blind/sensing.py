"""From a run of the rig to what its sensors say: clean, or quantised and noisy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.blind import columns as k
from tendon_ros.blind.bench import MOTORS, noise, resolution
from tendon_ros.blind.rig import BEFORE, FloatArray, Rig, TICK
from tendon_ros.model.instrument import Instrument

EPOCH_NS = 1_700_000_000_000_000_000

JOINTS = ('1', '2', '3')
CHANNEL_SETS = ('motor', 'force', 'joint')

#: coloured part of the torque noise by the white one, and its memory [s]
_COLOURED, _MEMORY = 0.5, 0.01


@dataclass(frozen=True)
class Sampling:
    """
    When rows are recorded: ``every`` so many ticks, up to ``late`` ticks later, stamped truly.

    ``lost``: the part of the rows that is not there.
    """

    every: int = 2
    late: int = 0
    lost: float = 0.0

    def rows(self, count: int, rng: np.random.Generator) -> NDArray[np.intp]:
        """
        Return which ticks are recorded.

        :param count: of ticks.
        :param rng: draws what is late, and what is lost.
        :return: their numbers.
        """
        rows = np.arange(0, count, self.every)
        if self.late:
            rows = np.minimum(rows + rng.integers(0, self.late + 1, rows.size), count - 1)
        return rows[rng.random(rows.size) >= self.lost] if self.lost else rows


@dataclass(frozen=True)
class Sensor:
    """A channel, the name of its sensor in the instrument, and the column that it comes from."""

    channel: str
    name: str
    column: int


TORQUES = tuple(
    Sensor(f'actuator/pulley_{m}/effort', f'torque_{m}', k.EFFORT + n)
    for n, m in enumerate(MOTORS)
)
ANGLES = tuple(
    Sensor(f'pulley/pulley_{j}/position', f'encoder_{j}', k.ANGLE + 2 + n)
    for n, j in enumerate(JOINTS)
)
CELL = Sensor('load_cell/force', 'load_cell', k.FORCE)


def _late(signal: FloatArray, delay: float) -> FloatArray:
    """Return what a signal was some time ago [s]."""
    if delay == 0.0:
        return signal
    ticks = np.arange(signal.size)
    late: FloatArray = np.interp(ticks - delay / TICK, ticks, signal)
    return late


def clean(rig: Rig, out: FloatArray, channels: str, *, closed: bool) -> dict[str, FloatArray]:
    """
    Return what sensors without noise and steps would say, at every tick from time zero.

    :param rig: with its sensors' faults.
    :param out: of a run.
    :param channels: ``motor``, ``force`` or ``joint``.
    :param closed: whether there is a load cell to press on.
    :return: values by channel, without the motors' angles.
    """
    result = {}
    for n, sensor in enumerate(TORQUES):
        value = _late(out[:, sensor.column], rig.torque_delay[n])
        result[sensor.channel] = np.abs(value) if rig.torque_rectified[n] else value
    if channels in {'force', 'joint'} and closed:
        gain, bias, delay, lag, curve, _ = rig.cell
        value = out[:, CELL.column]
        if lag > 0.0:
            part = TICK / (TICK + lag)
            value = lfilter([part], [1.0, part - 1.0], value)
        value = _late(value, delay)
        result[CELL.channel] = gain * value * (1.0 + curve * value) + bias
    if channels == 'joint':
        for n, sensor in enumerate(ANGLES):
            angle = out[:, sensor.column]
            angle = angle + rig.joint_cyclic[n] * np.sin(40.0 * angle)
            reading = rig.joint_gain[n] * angle + rig.joint_offset[n]
            result[sensor.channel] = _late(reading, rig.joint_delay[n])
    first = round(BEFORE / TICK)
    return {name: value[first:] for name, value in result.items()}


def recorded(
    name: str,
    values: dict[str, FloatArray],
    out: FloatArray,
    setpoint: FloatArray,
    instrument: Instrument,
    sampling: Sampling,
    rng: np.random.Generator,
) -> Recording:
    """
    Return a recording as a bag would hold it.

    :param name: of the recording.
    :param values: of :func:`clean`.
    :param out: of the same run, for the motors' angles.
    :param setpoint: commanded, one row a tick.
    :param instrument: gives resolution and noise.
    :param sampling: when.
    :param rng: of the noise.
    :return: the recording.
    """
    first = round(BEFORE / TICK)
    ticks = sampling.rows(len(out) - first, rng)
    rows = first + ticks
    time = ticks * round(TICK * 1e9) / 1e9
    channels = []
    present = {sensor.name for sensor in instrument.sensors}
    for n, m in enumerate(MOTORS):
        if f'encoder_{m}' not in present:
            continue
        step = resolution(instrument, f'encoder_{m}')
        reading = np.round(out[rows, k.READING + n] / step) * step
        channels.append(Channel(f'actuator/pulley_{m}/position', time, reading))
        channels.append(Channel(f'setpoint/pulley_{m}/position', time, setpoint[rows, n]))
    for sensor in (*TORQUES, CELL, *ANGLES):
        if sensor.channel not in values or sensor.name not in present:
            continue
        value = values[sensor.channel][ticks]
        step = resolution(instrument, sensor.name)
        if sensor not in ANGLES:
            sigma = noise(instrument, sensor.name)
            value = value + sigma * rng.standard_normal(value.size)
            if sensor in TORQUES:
                value = value + sigma * _COLOURED * _coloured(rng, value.size, sampling.every)
        if step > 0.0:
            value = np.round(value / step) * step
        channels.append(Channel(sensor.channel, time, value))
    return Recording(
        name,
        {c.name: c for c in channels},
        epoch_ns=EPOCH_NS,
        metadata={'namespace': '/instrument'},
    )


def _coloured(rng: np.random.Generator, size: int, every: int) -> FloatArray:
    """Return noise of variance one that remembers itself for a while."""
    keep = float(np.exp(-every * TICK / _MEMORY))
    white = np.sqrt(1.0 - keep**2) * rng.standard_normal(size)
    return np.asarray(lfilter([1.0], [1.0, -keep], white), dtype=np.float64)


def floors(instrument: Instrument, channels: str) -> dict[str, float]:
    """
    Return the noise floor of each channel, one standard deviation in its unit.

    :param instrument: gives resolution and noise.
    :param channels: ``motor``, ``force`` or ``joint``.
    :return: by channel.
    """
    present = {sensor.name for sensor in instrument.sensors}
    result = {
        s.channel: noise(instrument, s.name) * np.hypot(1.0, _COLOURED)
        for s in TORQUES
        if s.name in present
    }
    if channels in {'force', 'joint'}:
        result[CELL.channel] = noise(instrument, CELL.name)
    if channels == 'joint':
        for s in ANGLES:
            result[s.channel] = resolution(instrument, s.name) / np.sqrt(12.0)
    return {name: float(value) for name, value in result.items()}
