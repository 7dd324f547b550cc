"""
Noise: what no model could do better than.

What bins near each other do not share; what the motion's counts make of every channel through the
stiff cables, and what happens faster than the bins; and how far the machine agrees with itself
where it does the same again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.identify.motion import reading_error, ReadingError
from tendon_ros.identify.noise_estimate import heard, neighbours
from tendon_ros.identify.repetition import unrepeated
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import Measured, Segment
from tendon_ros.identify.smoothing import recounted, smoothed
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

COUNTED = 1.0  # [s] over which what counts make of a channel is much the same
STARTS = 0.3  # [s] in which a motion starts or stops


@dataclass(frozen=True)
class Noise:
    """
    What is known of the noise, whatever the model.

    ``counts``: what the motion's counts make of each channel, by recording and channel, shape
    (bins,) each, in the channel's unit; ``bins``: the same of what bins are too long to see.
    ``resting``: of each recording the channels of motors' torques, with where the motor cannot be
    told from rest, shape (bins,). ``motions``: of each how it may have moved as well, its counts
    elsewhere, and smoother.
    """

    counts: tuple[tuple[FloatArray, ...], ...]
    bins: tuple[tuple[FloatArray, ...], ...]
    resting: tuple[Mapping[int, BoolArray], ...]
    motions: tuple[tuple[Signals, Signals], ...]

    def beside(
        self,
        rollouts: Rollouts,
        uses: Sequence[Sequence[EffectUse]],
        predicted: Sequence[FloatArray],
    ) -> Noise:
        """
        Return the same with what counts make of the channels beside a model.

        A motor that gives half of the torque which the file guesses makes half as much of them.

        :param rollouts: of the recordings.
        :param uses: effects in force, for each.
        :param predicted: of each the channels as the model has them, shape (channels, bins).
        :return: the noise; as it is where the model cannot be computed.
        """
        counts = _counted(rollouts, self.motions, uses, predicted)
        known = all(np.isfinite(row).all() for rows in counts for row in rows)
        return replace(self, counts=counts) if known else self

    def unseen_by_bins(self, segments: Sequence[Segment], changes: Sequence[FloatArray]) -> Noise:
        """
        Return the same where bins are longer than they ought to be.

        :param segments: the recordings.
        :param changes: of each what shorter bins change, shape (channels, bins).
        :return: the noise; what cannot be computed on shorter bins changes nothing.
        """
        return replace(
            self,
            bins=tuple(
                tuple(_level(np.nan_to_num(row), segment.period, COUNTED) for row in rows)
                for segment, rows in zip(segments, changes, strict=True)
            ),
        )

    def given(
        self,
        segments: Sequence[Segment],
        predicted: Sequence[FloatArray],
        *,
        repeated: bool = True,
    ) -> list[Segment]:
        """
        Return recordings with their noise: what is heard, of counts, and does not repeat itself.

        :param segments: the recordings.
        :param predicted: of each the channels as a model has them, shape (channels, bins).
        :param repeated: whether what does not repeat itself counts.
        :return: the same with the noise beside that model.
        """
        left = [
            [m.value - row for m, row in zip(segment.measured, rows, strict=True)]
            for segment, rows in zip(segments, predicted, strict=True)
        ]
        found = []
        again = [[0.0] * len(s.measured) for s in segments]
        if repeated:
            again = unrepeated(segments, left)
        by_recording = (self.counts, self.bins, again, self.resting)
        for segment, rows, by_counts, by_bins, apart, resting in zip(
            segments, left, *by_recording, strict=True
        ):
            near = neighbours(segment.spacing, counted=bool(segment.prescribed))
            noise, shaped = [], []
            for n, (m, row, of_counts, of_bins, a) in enumerate(
                zip(segment.measured, rows, by_counts, by_bins, apart, strict=True)
            ):
                h = _heard(m, row, near)
                c = np.hypot(of_counts, of_bins)
                if n in resting:
                    c = _no_quieter(c, resting[n])
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
    motions = tuple(
        (_recounted(instrument, s, r), _smoother(instrument, s, r))
        for s, r in zip(segments, recordings, strict=True)
    )
    return Noise(
        _counted(Rollouts(instrument, segments), motions, [[] for _ in segments], predicted),
        tuple(tuple(np.zeros(len(s.time)) for _ in s.measured) for s in segments),
        tuple({row: still for row, _, still in s.at_rest(instrument)} for s in segments),
        motions,
    )


def _no_quieter(counts: FloatArray, still: BoolArray) -> FloatArray:
    """
    Return what counts make of a motor's torque, where it rests no less than where it moves.

    Friction and cogging hold a motor with any torque: a hold of minutes must not outweigh all that
    moves because nothing trembles there.
    """
    moving = counts[~still]
    if not moving.size:
        return counts
    return np.where(still, np.maximum(counts, np.median(moving)), counts)


def _heard(measured: Measured, left: FloatArray, apart: int) -> float:
    """Return the noise of a channel that bins near each other do not share, in its unit."""
    # a silent sensor would make any misfit infinite: a millionth of its range is noise
    span = float(np.nanmax(np.abs(measured.value), initial=0.0))
    return max(heard(left, apart), measured.floor, 1e-6 * span + 1e-12)


def _counted(
    rollouts: Rollouts,
    motions: Sequence[tuple[Signals, Signals]],
    uses: Sequence[Sequence[EffectUse]],
    predicted: Sequence[FloatArray],
) -> tuple[tuple[FloatArray, ...], ...]:
    """Return what the motion's counts make of each channel, by recording, shape (bins,)."""
    recounted, smoother = (
        rollouts.like(
            [replace(s, motion=m) for s, m in zip(rollouts.segments, moved, strict=True)]
        ).predicted(uses)
        for moved in zip(*motions, strict=True)
    )
    return tuple(
        tuple(
            np.hypot(
                _level(counted - row, segment.period, COUNTED),
                _level(once - row, segment.period, STARTS),
            )
            for row, counted, once in zip(*rows, strict=True)
        )
        for segment, *rows in zip(rollouts.segments, predicted, recounted, smoother, strict=True)
    )


def _level(change: FloatArray, period: float, seconds: float) -> FloatArray:
    """Return the root mean square about each bin, shape (bins,)."""
    window = max(3, round(seconds / period))
    level = np.full(window, 1.0 / window)
    power: FloatArray = np.convolve(change**2, level, mode='same')[: len(change)]
    return np.sqrt(power)


def _recounted(instrument: Instrument, segment: Segment, recording: Recording) -> Signals:
    """Return the motion as it would look had the encoders' counts lain half a count elsewhere."""

    def again(motion: FloatArray, reading: ReadingError, sampling: float) -> FloatArray:
        bins = segment.period * np.arange(len(motion))
        # the middle of a bin lies between two readings, which share their noise
        read = np.arange(-0.5 * sampling, len(motion) * segment.period, sampling)
        between: FloatArray = CubicSpline(bins, motion)(read)
        other = recounted(between, reading.still, reading.apart(between, sampling))
        # what lies between bins is not known to a count of a fine encoder: only changes count
        found: FloatArray = motion + np.interp(bins, read, other - between)
        return found

    return _moved(instrument, segment, recording, again)


def _smoother(instrument: Instrument, segment: Segment, recording: Recording) -> Signals:
    """
    Return a motion that is as near to the readings and smoother.

    A motion that starts or stops within a count has an acceleration that nobody has seen.
    """

    def again(motion: FloatArray, reading: ReadingError, _sampling: float) -> FloatArray:
        known = np.ones(len(motion), dtype=np.bool_)
        return smoothed(motion, known, reading.still, reading.still * np.sqrt(12.0))

    return _moved(instrument, segment, recording, again)


def _moved(
    instrument: Instrument,
    segment: Segment,
    recording: Recording,
    again: Callable[[FloatArray, ReadingError, float], FloatArray],
) -> Signals:
    """Return another motion, by the old one, the encoder's errors and its sampling [s]."""
    sensors = {s.channel: s for s in instrument.sensors}
    rows = list(segment.motion.value)
    for row, name in enumerate(encoder_channels(instrument)):
        reading = reading_error(recording[name], sensors[name])
        if reading.still > 0.0:
            rows[row] = again(rows[row], reading, recording[name].sampling)
    return Signals.smooth(segment.motion.start, segment.motion.step, np.array(rows))
