"""Recordings that show nothing: too short, too slow, or without motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import median_filter

from tendon_ros.base.recording import Channel, FloatArray, Recording
from tendon_ros.diagnose.intake.step import shared_span, Sifted, sifted
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument, Sensor

SHORTEST = 1.0  # [s]
SLOWEST = 0.1  # [s] between samples: slower, nothing of a drive's motion is seen
FEWEST = 40  # samples of a motor's position
STILL = 1e-3  # [rad]
COUNTS = 5.0  # a motor that turns less than so many counts stands


def moving(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out recordings that are too short or too slow, or in which no motor moves.

    :param recordings: with every motor's position.
    :param instrument: the network.
    :return: the others, and sentences.
    """
    return sifted(recordings, lambda recording: _fault(recording, instrument))


def _fault(recording: Recording, instrument: Instrument) -> str:
    names = motor_channels(instrument)
    start, end = shared_span(recording, names)
    fewest = min(recording[name].value.size for name in names)
    if end - start < SHORTEST or fewest < FEWEST:
        return (
            f'too short: the motors are measured together for {max(end - start, 0.0):.2f} s, '
            f'{fewest} samples; record at least {SHORTEST:g} s and {FEWEST} samples, better 15 s'
        )
    between = max(float(np.median(np.diff(recording[name].time))) for name in names)
    if between > SLOWEST:
        return (
            f'too slow: the motors are measured every {between:.3g} s; record at least 50 samples '
            'a second, or say the unit of time on import, where it is not seconds'
        )
    sensors = {s.channel: s for s in instrument.sensors}
    if not any(turned(recording[name], sensors.get(name)) for name in names):
        widest, unit = max((travel(recording[n].value), recording[n].unit) for n in names)
        still = f'stay within {widest:.2g} {unit}' if widest > 0.0 else 'never change'
        return f'without motion: {", ".join(names)} {still}; move the motors while recording'
    return ''


def travel(value: FloatArray) -> float:
    """
    Return how far a signal goes, single wild samples aside.

    :param value: readings, shape (n,).
    :return: in their unit.
    """
    return float(np.ptp(median_filter(value, size=5, mode='nearest')))


def turned(channel: Channel, sensor: Sensor | None) -> bool:
    """
    Say whether a motor moved.

    :param channel: its position, or its torque where it has no encoder.
    :param sensor: what measures it, where the instrument describes one.
    :return: whether it went further than its counts and noise tell.
    """
    count = 0.0 if sensor is None else max(sensor.resolution, 2.0 * sensor.noise)
    least = STILL if channel.unit == 'rad' else 0.0
    return travel(channel.value) > max(least, COUNTS * count)
