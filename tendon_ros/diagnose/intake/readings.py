"""
Noise of encoders as a recording has it, where the instrument file knows of counts only.

A log that has no stamps, or a driver that is polled, holds readings of a little earlier or later:
in motion they scatter far beyond a count. Taken for counts, they are accelerations that no torque
has made, and a guessed inertia goes to nothing to have none of them.

What a smooth motion is off a parabola a few samples long is nothing, and noise is off as much,
however far apart the samples are. What shakes is off the more the farther they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.intake.restated import restated
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.model.instrument import Instrument, Sensor

FloatArray = NDArray[np.float64]

#: times what the file says that readings scatter at least, to be said
NOISIER = 4.0
#: times as much that they do at most where samples are twice as far apart
WHITE = 2.0
#: part of all steps that are within so much of the usual one: other stamps tell of themselves
EVEN, STEP = 0.9, 0.05
#: counts that three steps are at least where something moves, and how many tell anything
MOVES, ENOUGH = 6.0, 100


def as_read(
    recordings: Sequence[Recording], instrument: Instrument
) -> tuple[Instrument, tuple[str, ...]]:
    """
    Return an instrument whose motors' encoders are as noisy as they are in recordings.

    :param recordings: of it.
    :param instrument: its file.
    :return: the instrument, and a sentence on each encoder that is far noisier than the file says.
    """
    driving = set(encoder_channels(instrument))

    def noisier(sensor: Sensor) -> tuple[Sensor, str] | None:
        noise = _noise_of(sensor, recordings) if sensor.channel in driving else 0.0
        known = float(np.hypot(sensor.resolution / np.sqrt(12.0), sensor.noise))
        if not noise > NOISIER * known > 0.0:
            return None
        return replace(sensor, noise=noise), (
            f'{sensor.name}: in motion its readings scatter by {1e3 * noise:.2g} mrad, '
            f'{noise / known:.0f} times what the instrument file says; that is taken for its '
            'noise (log the time at which each was read, or state its noise in the file)'
        )

    return restated(instrument, noisier)


def _noise_of(sensor: Sensor, recordings: Iterable[Recording]) -> float:
    """Return the noise of a sensor's readings [rad]; 0 where the recordings do not tell."""
    count = max(sensor.resolution, sensor.noise)
    told = [scatter(r[sensor.channel], count) for r in recordings if sensor.channel in r]
    known = [noise for noise in told if noise is not None]
    return float(np.median(known)) if known else 0.0


def scatter(channel: Channel, count: float) -> float | None:
    """
    Return how far readings of something that moves are off a smooth motion.

    :param channel: what was read.
    :param count: what is smaller is no motion.
    :return: one deviation, 0 where it shakes; None where it hardly moves, or its stamps are not
        even.
    """
    step = np.diff(channel.time)
    usual = float(np.median(step))
    if np.mean(np.abs(step - usual) < STEP * usual) < EVEN:
        return None
    near, far = (_off(channel.value, apart, count) for apart in (1, 2))
    if near is None or far is None:
        return None
    return near if far < WHITE * near else 0.0


def _off(value: FloatArray, apart: int, count: float) -> float | None:
    """Return the noise by third differences of samples so far apart; None without motion."""
    a, b, c, d = (value[n * apart : len(value) - (3 - n) * apart] for n in range(4))
    moving = np.abs(d - a) > MOVES * count
    if np.count_nonzero(moving) < ENOUGH:
        return None
    third = np.abs(d - 3.0 * c + 3.0 * b - a)[moving]
    # of a normal scatter 95 % are within 1.96 deviations; a slip is a few of them
    return float(np.quantile(third, 0.95) / (1.96 * np.sqrt(20.0)))
