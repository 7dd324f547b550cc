"""
Noise: what no model could do better than.

What bins near each other do not share; what the motion's counts make of every channel through the
stiff cables; and how far the machine agrees with itself where it does the same again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.identify.repetition import unrepeated
from tendon_ros.identify.residuals import neighbours
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import Measured, reading_error, Segment
from tendon_ros.identify.smoothing import smoothed
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """
    What is known of the noise, whatever the model.

    ``counts``: what the motion's counts make of each channel, by recording and channel, shape
    (bins,) each, in the channel's unit.
    """

    counts: tuple[tuple[FloatArray, ...], ...]

    def given(self, segments: Sequence[Segment], predicted: Sequence[FloatArray]) -> list[Segment]:
        """
        Return recordings with their noise: what is heard, of counts, and does not repeat itself.

        :param segments: the recordings.
        :param predicted: of each the channels as a model has them, shape (channels, bins).
        :return: the same with the noise beside that model.
        """
        left = [
            [m.value - row for m, row in zip(segment.measured, rows, strict=True)]
            for segment, rows in zip(segments, predicted, strict=True)
        ]
        found = []
        for segment, rows, by_counts, apart in zip(
            segments, left, self.counts, unrepeated(segments, left), strict=True
        ):
            noise, shaped = [], []
            for m, row, c, a in zip(segment.measured, rows, by_counts, apart, strict=True):
                h = heard(m, row, segment.period)
                # what is heard and what counts make does not repeat itself either
                shaped.append(np.sqrt(c**2 + max(0.0, a**2 - h**2 - float(np.mean(c**2)))))
                noise.append(np.hypot(h, shaped[-1]))
            found.append(segment.with_noise(noise, shaped))
        return found


def noise_of_counts(
    instrument: Instrument,
    segments: Sequence[Segment],
    recordings: Sequence[Recording],
    predicted: Sequence[FloatArray],
) -> Noise:
    """
    Find what the motion's counts make of every channel.

    :param instrument: the network.
    :param segments: the recordings on bins.
    :param recordings: the same as they were recorded.
    :param predicted: of each the channels as the file has them, shape (channels, bins).
    :return: the noise.
    """
    return Noise(
        tuple(
            _counted(instrument, segment, recording, rows)
            for segment, recording, rows in zip(segments, recordings, predicted, strict=True)
        )
    )


def heard(measured: Measured, left: FloatArray, period: float) -> float:
    """
    Return the noise of a channel that bins near each other do not share.

    :param measured: the channel.
    :param left: what a model leaves of it, shape (bins,), in its unit.
    :param period: of the bins [s].
    :return: one deviation, in its unit.
    """
    apart = neighbours(period)
    # second differences: what a wrong model leaves of a motion is nearly straight for so long
    bend = left[2 * apart :] - 2.0 * left[apart:-apart] + left[: -2 * apart]
    bend = bend[np.isfinite(bend)]
    found = 1.4826 * float(np.median(np.abs(bend))) / np.sqrt(6.0) if bend.size else 0.0
    # a silent sensor would make any misfit infinite: a millionth of its range is noise
    span = float(np.nanmax(np.abs(measured.value), initial=0.0))
    return max(found, measured.floor, 1e-6 * span + 1e-12)


def _counted(
    instrument: Instrument, segment: Segment, recording: Recording, predicted: FloatArray
) -> tuple[FloatArray, ...]:
    """Return what the motion's counts make of each channel, shape (bins,)."""
    [disturbed] = Rollouts(
        instrument, [replace(segment, motion=_recounted(instrument, segment, recording))]
    ).predicted([[]])
    window = max(3, round(1.0 / segment.period))
    level = np.full(window, 1.0 / window)
    return tuple(
        np.sqrt(np.convolve((other - row) ** 2, level, mode='same')[: len(row)])
        for row, other in zip(predicted, disturbed, strict=True)
    )


def _recounted(instrument: Instrument, segment: Segment, recording: Recording) -> Signals:
    """Return the motion as it would look had the encoders' counts lain half a count elsewhere."""
    rows = []
    sensors = {s.channel: s for s in instrument.sensors}
    for row, name in enumerate(encoder_channels(instrument)):
        motion = segment.motion.value[row]
        error = reading_error(recording[name], sensors[name])
        count = error * np.sqrt(12.0)
        if count <= 0.0:
            rows.append(motion)
            continue
        sampling = float(np.median(np.diff(recording[name].time)))
        fine = np.interp(
            np.arange(0.0, len(motion) * segment.period, sampling),
            segment.period * np.arange(len(motion)),
            motion,
        )
        counted = count * np.round(fine / count + 0.5) - 0.5 * count
        again = smoothed(counted, np.ones(len(counted), dtype=np.bool_), error, count)
        rows.append(
            np.interp(
                segment.period * np.arange(len(motion)), sampling * np.arange(len(again)), again
            )
        )
    rows += list(segment.motion.value[len(rows) :])
    return Signals.smooth(segment.motion.start, segment.motion.step, np.array(rows))
