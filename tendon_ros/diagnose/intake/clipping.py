"""
Clipped samples: a sensor at the end of its range while the truth goes on.

A flat top alone proves nothing: a rig that holds still has one, and so has a motor at its limit.
Samples count as clipped where the other channels, related to this one by what they are on the rest
of the recording, say that it should have gone on beyond the flat top.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel, FloatArray, Recording
from tendon_ros.diagnose.intake.step import compared, Sifted
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.model.instrument import Instrument, Sensor

BoolArray = NDArray[np.bool_]

RUN = 3  # samples of one value in a row
FEWEST = 8  # samples at the extreme
BELOW = 0.02  # of the range: a top must hold more samples than lie so near below it
EXPLAINED = 0.8  # share of the variance that the other channels must explain
BEYOND = 3.0  # deviations of what they leave
USELESS = 0.5  # share of clipped samples beyond which nothing is kept
WIDTH = 15  # samples of a moving mean
ROWS = 4000  # samples that the relation is taken from


def unclipped(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Take out clipped samples of torques, forces and velocities.

    :param recordings: with every motor's position.
    :param instrument: the network.
    :return: recordings, and sentences.
    """
    kept: list[Recording] = []
    sentences: list[str] = []
    for recording in recordings:
        channels = dict(recording.channels)
        for sensor in compared(recording, instrument):
            # an angle that comes to a stop has met one
            clipped = None if sensor.kind == 'angle' else _clipped(recording, sensor, instrument)
            if clipped is None:
                continue
            channel = recording[sensor.channel]
            share = float(clipped.mean())
            level = float(channel.value[np.argmax(clipped)])
            said = (
                f'{recording.name}: {channel.name} is clipped at {level:.4g} {channel.unit} in '
                f'{np.count_nonzero(clipped)} samples ({share:.0%}), first at '
                f'{channel.time[np.argmax(clipped)]:.3f} s; '
            )
            if share > USELESS:
                del channels[channel.name]
                sentences.append(f'{said}left out whole: widen the range of the sensor')
            else:
                channels[channel.name] = _kept(channel, ~_widened(clipped))
                sentences.append(f'{said}these are left out: widen the range of the sensor')
        kept.append(
            Recording(
                recording.name,
                channels,
                recording.epoch_ns,
                recording.metadata,
                recording.warnings,
            )
        )
    return tuple(kept), sentences


def _clipped(recording: Recording, sensor: Sensor, instrument: Instrument) -> BoolArray | None:
    """Mark the clipped samples of a channel; None where there are none."""
    channel = recording[sensor.channel]
    tops = [
        (top, side) for side in (1.0, -1.0) if (top := _flat_top(side * channel.value)) is not None
    ]
    tops = [(t, s) for t, s in tops if not _expected_level(channel, t, sensor, instrument)]
    if not tops:
        return None
    flat = np.any([top for top, _ in tops], axis=0)
    other = _from_the_others(recording, channel, ~_widened(flat), instrument)
    if other is None:
        return None
    expected, deviation = other
    clipped = np.zeros(flat.size, dtype=np.bool_)
    margin = max(BEYOND * deviation, BELOW * float(np.ptp(channel.value)))
    for top, side in tops:
        if np.median(side * (expected - channel.value)[top]) > margin:
            clipped |= top
    return clipped if clipped.any() else None


def _flat_top(value: FloatArray) -> BoolArray | None:
    """Mark a flat top: many samples exactly at the maximum, in runs, few just below."""
    reach = float(np.ptp(value))
    if not reach > 0.0:
        return None
    level = float(value.max())
    top = value >= level - 1e-9 * reach
    inside = np.convolve(top, np.ones(RUN), mode='same') >= RUN
    near = np.count_nonzero((value > level - BELOW * reach) & ~top)
    count = np.count_nonzero(top)
    return top if np.count_nonzero(inside) >= FEWEST and count > near else None


def _expected_level(
    channel: Channel, top: BoolArray, sensor: Sensor, instrument: Instrument
) -> bool:
    """Say whether a flat top is where one may be: at zero, or at the motor's known limit."""
    level = abs(float(channel.value[np.argmax(top)]))
    if level < BELOW * float(np.ptp(channel.value)):
        return True
    motors = {m.name: m for m in instrument.motors}
    if sensor.kind != 'motor_torque' or sensor.of not in motors:
        return False
    motor = motors[sensor.of]
    return level > 0.98 * motor.largest


def _from_the_others(
    recording: Recording, channel: Channel, good: BoolArray, instrument: Instrument
) -> tuple[FloatArray, float] | None:
    """Return what the other channels say of this one, and how well; None where they do not."""
    chosen = np.flatnonzero(good)
    if chosen.size < 10 * RUN:
        return None
    chosen = chosen[:: max(1, chosen.size // ROWS)]
    columns = [np.ones(channel.time.size)]
    for sensor in compared(recording, instrument):
        if sensor.channel != channel.name:
            columns.append(recording[sensor.channel].at(channel.time))
    for name in encoder_channels(instrument):
        angle = recording[name].at(channel.time)
        columns += [angle, np.gradient(_smooth(angle), channel.time)]
    table = np.stack(columns, axis=1)
    spread = table[chosen].std(axis=0)
    table = table[:, (spread > 0.0) | (np.arange(spread.size) == 0)]
    weights = np.linalg.lstsq(table[chosen], channel.value[chosen], rcond=1e-8)[0]
    expected = table @ weights
    left = channel.value[chosen] - expected[chosen]
    if left.var() > (1.0 - EXPLAINED) * channel.value[chosen].var():
        return None
    return expected, float(left.std())


def _smooth(value: FloatArray) -> FloatArray:
    """Return a moving mean that holds its ends."""
    padded = np.pad(value, WIDTH // 2, mode='edge')
    return np.convolve(padded, np.full(WIDTH, 1.0 / WIDTH), mode='valid')


def _widened(mask: BoolArray) -> BoolArray:
    """Mark the neighbours too: filters in front of a converter smear its corner."""
    return np.asarray(np.convolve(mask, np.ones(3), mode='same') > 0)


def _kept(channel: Channel, keep: BoolArray) -> Channel:
    return Channel(channel.name, channel.time[keep], channel.value[keep], channel.unit)
