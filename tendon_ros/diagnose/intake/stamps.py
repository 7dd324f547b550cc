"""
Stamps that scatter about an even sampling which the motion itself does not share.

A logger stamps what a driver read on time, some hundredths of a millisecond late and each time by
something else. Taken for the time of the reading, that is an acceleration: at 0.2 m/s and 1 kHz
20 us make 4 um, and an inertia that was guessed goes to a quarter to have less of it.

Whether a reading is as late as its stamp, the encoder tells: what an angle is off the mean of its
neighbours grows with speed and scatter if it is, and does not if it is not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.quantity import written
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.intake.step import Sifted
from tendon_ros.identify.motion import reading_error
from tendon_ros.model.instrument import Instrument, Sensor

FloatArray = NDArray[np.float64]

#: samples without a gap that tell how even they are
RUN = 100
#: part of the time between samples that a stamp may be off, and below which it is even
FAR, EVEN = 0.45, 1e-4
#: part of it that a longer step is off a whole number of them, from which on it is a pause
OUT = 0.25
#: part of the scatter that readings follow at most, and how well that must be known
FOLLOWS, KNOWN = 0.5, 0.1


def as_sampled(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Return recordings with the times at which encoders were read, not those of their stamps.

    :param recordings: of one rig.
    :param instrument: its file.
    :return: the recordings, and a sentence on those whose stamps scatter and whose motion does
        not: one on all of which it is the same.
    """
    evened = [_evened(recording, instrument) for recording in recordings]
    alike: dict[str, list[str]] = {}
    for recording, sentences in evened:
        for said in sentences:
            alike.setdefault(said, []).append(recording.name)
    words = [f'{", ".join(names)}: {said}' for said, names in alike.items()]
    return tuple(r for r, _ in evened), words


def _evened(recording: Recording, instrument: Instrument) -> tuple[Recording, list[str]]:
    """Return a recording with even stamps where its encoders tell that sampling was even."""
    said: list[str] = []
    for time, sensors in _clocks(recording, instrument):
        even = even_times(time)
        if even is None:
            continue
        channels = [
            (recording[s.channel], reading_error(recording[s.channel], s).still) for s in sensors
        ]
        follows, known = followed(time, even, channels)
        if known > KNOWN or follows > FOLLOWS:
            continue
        same = [
            replace(c, time=even)
            for c in recording.channels.values()
            if np.array_equal(c.time, time)
        ]
        # as finely as several recordings with one logger agree
        scatter = float(f'{np.std(time - even):.1g}')
        period = float(f'{np.median(np.diff(even)):.3g}')
        recording = recording.with_channels(same)
        said.append(
            f'stamps scatter by {written(scatter, "s")} about an even '
            f'{written(period, "s")}, and the motion of '
            f'{", ".join(s.name for s in sensors)} does not: it is taken for sampled evenly'
        )
    return recording, said


def _clocks(
    recording: Recording, instrument: Instrument
) -> Iterator[tuple[FloatArray, list[Sensor]]]:
    """Yield the different stamps of encoders, with the encoders that have them."""
    left = [s for s in instrument.sensors if s.kind == 'angle' and s.channel in recording]
    while left:
        time = recording[left[0].channel].time
        own = [s for s in left if np.array_equal(recording[s.channel].time, time)]
        left = [s for s in left if s not in own]
        yield time, own


def even_times(time: FloatArray) -> FloatArray | None:
    """
    Return the even times that stamps scatter about.

    :param time: the stamps [s], shape (n,).
    :return: the times, shape (n,); None where they are even already, or scatter about none.
    """
    steps = np.diff(time)
    period = float(np.median(steps)) if len(steps) >= RUN else 0.0
    if not period > 0.0:
        return None
    number = np.concatenate([[0.0], np.cumsum(np.round(steps / period))])
    # what was lost leaves the beat as it is, and a pause may end at any time
    missed = steps / period
    paused = (missed > 1.5) & (np.abs(missed - np.round(missed)) > OUT)
    runs = np.split(np.arange(len(time)), np.flatnonzero(paused) + 1)
    even = time.copy()
    for run in runs:
        if len(run) < RUN:
            continue
        n = number[run]
        even[run] = np.polyval(np.polyfit(n - n[0], time[run], 1), n - n[0])
    off = time - even
    if np.abs(off).max() > FAR * period or np.std(off) < EVEN * period:
        return None
    return even if np.all(np.diff(even) > 0.0) else None


def followed(
    time: FloatArray, even: FloatArray, channels: Sequence[tuple[Channel, float]]
) -> tuple[float, float]:
    """
    Return how far readings follow the scatter of their stamps.

    :param time: the stamps [s], shape (n,).
    :param even: what they scatter about, shape (n,).
    :param channels: what was read at these stamps, each with the error of a reading.
    :return: 1 where readings are as late as their stamps, 0 where they are even, and one standard
        deviation of it, infinite where nothing moves.
    """
    late = time - even
    steps = np.diff(even)
    near = np.abs(steps[1:] - steps[:-1]) < 0.5 * steps[1:]  # none of the three was lost
    own = (late[1:-1] - 0.5 * (late[:-2] + late[2:]))[near]
    product = power = spread = 0.0
    for channel, error in channels:
        value = channel.value
        speed = ((value[2:] - value[:-2]) / (even[2:] - even[:-2]))[near]
        off = (value[1:-1] - 0.5 * (value[:-2] + value[2:]))[near]
        told = speed * own
        weight = 1.0 / max(float(np.var(off)), error**2, 1e-30)
        product += weight * float(off @ told)
        power += weight * float(told @ told)
        spread += weight**2 * float(np.sum((off * told) ** 2))
    if not power > 0.0:
        return 0.0, np.inf
    return product / power, float(np.sqrt(spread)) / power
