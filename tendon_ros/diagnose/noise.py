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
    The noise that has a shape, beside what is heard.

    ``shaped``: what counts make, and what does not repeat itself, by recording and channel, shape
    (bins,) each, in the channel's unit. ``repeated``: in how many recordings something is
    repeated.
    """

    shaped: tuple[tuple[FloatArray, ...], ...]
    repeated: int

    def given(self, segments: Sequence[Segment], predicted: Sequence[FloatArray]) -> list[Segment]:
        """
        Return recordings with their noise.

        :param segments: the recordings.
        :param predicted: of each the channels as a model has them, shape (channels, bins).
        :return: the same with what is heard beside that model, and what has a shape.
        """
        return [
            segment.with_noise(
                [
                    np.hypot(heard(m, row, segment.period), s)
                    for m, row, s in zip(segment.measured, rows, shaped, strict=True)
                ],
                shaped,
            )
            for segment, rows, shaped in zip(segments, predicted, self.shaped, strict=True)
        ]


def noise_in(
    instrument: Instrument, segments: Sequence[Segment], recordings: Sequence[Recording]
) -> Noise:
    """
    Find the noise that has a shape.

    :param instrument: the network.
    :param segments: the recordings on bins.
    :param recordings: the same as they were recorded.
    :return: the noise.
    """
    predicted = Rollouts(instrument, segments).predicted([[] for _ in segments])
    left = [
        [m.value - row for m, row in zip(segment.measured, rows, strict=True)]
        for segment, rows in zip(segments, predicted, strict=True)
    ]
    apart = unrepeated(segments, left)
    shaped = []
    for n, (segment, recording) in enumerate(zip(segments, recordings, strict=True)):
        row = []
        counts = _counted(instrument, segment, recording, predicted[n])
        for c, (m, by_counts) in enumerate(zip(segment.measured, counts, strict=True)):
            # what is heard and what counts make does not repeat itself either
            known = heard(m, predicted[n][c], segment.period) ** 2 + float(np.mean(by_counts**2))
            row.append(np.hypot(by_counts, np.sqrt(max(0.0, apart[n][c] ** 2 - known))))
        shaped.append(tuple(row))
    return Noise(tuple(shaped), sum(any(row) for row in apart))


def heard(measured: Measured, predicted: FloatArray, period: float) -> float:
    """
    Return the noise of a channel that bins near each other do not share.

    :param measured: the channel.
    :param predicted: as a model has it, shape (bins,).
    :param period: of the bins [s].
    :return: one deviation, in its unit.
    """
    left = measured.value - predicted
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
) -> list[FloatArray]:
    """Return what the motion's counts make of each channel, shape (bins,)."""
    [disturbed] = Rollouts(
        instrument, [replace(segment, motion=_recounted(instrument, segment, recording))]
    ).predicted([[]])
    window = max(3, round(1.0 / segment.period))
    level = np.full(window, 1.0 / window)
    return [
        np.sqrt(np.convolve((other - row) ** 2, level, mode='same')[: len(row)])
        for row, other in zip(predicted, disturbed, strict=True)
    ]


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
