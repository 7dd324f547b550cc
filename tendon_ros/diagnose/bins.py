"""
Recordings on bins: short enough that what the bins do not see drowns in noise.

How long bins may be for a drive's own inertia is known before any model runs
(``identify/binning.py``). What they do to a body behind a spring, or to an encoder a thousand
times finer than the motion needs, only the model tells: it is run on half as long ones as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.noise import Noise, noise_of_counts
from tendon_ros.diagnose.walls import placed
from tendon_ros.identify.binning import bin_length, BINS
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.identify.motion import thinned
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import ENDING, Segment, segment_of, SETTLING
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]

#: times a channel's noise that bins may get wrong of it before shorter ones are taken
DROWNS = 1.0


@dataclass(frozen=True)
class Binned:
    """
    Recordings on bins, with what the file makes of them.

    ``segments``: with their noise; ``predicted``: of each the channels as the file has them, shape
    (channels, bins); ``noise``: what is known of it, whatever the model.
    """

    segments: Sequence[Segment]
    predicted: Sequence[FloatArray]
    noise: Noise


def in_bins(recordings: Sequence[Recording], instrument: Instrument) -> Binned:
    """
    Return recordings on bins that suit all of them.

    :param recordings: admitted ones.
    :param instrument: the network.
    :return: on bins that are halved for as long as that changes a channel by more than its noise;
        where they would be too many, what halves would change counts as noise.
    """
    recordings = [_thinned(r, instrument) for r in recordings]
    period = bin_length(recordings, instrument)
    found = _heard(recordings, instrument, *_run(recordings, instrument, period))
    while shorter := _halved(found.segments):
        segments, predicted = _run(recordings, instrument, shorter)
        there = _there(segments, predicted, found.segments)
        changes = [new - old for new, old in zip(there, found.predicted, strict=True)]
        if not _shows(found.segments, changes, _noises(found.segments)):
            break
        if sum(len(s.time) for s in segments) > BINS:
            noise = found.noise.unseen_by_bins(found.segments, changes)
            heard = noise.given(found.segments, found.predicted)
            return replace(found, segments=heard, noise=noise)
        finer = _heard(recordings, instrument, segments, predicted)
        # shorter bins may only see more of what counts make up
        counted = _there(finer.segments, _noises(finer.segments), found.segments)
        if not _shows(found.segments, changes, counted):
            break
        found = finer
    return found


def _thinned(recording: Recording, instrument: Instrument) -> Recording:
    """Return a recording whose motors' encoders are read no more often than tells anything."""
    channels = dict(recording.channels)
    for name in encoder_channels(instrument):
        channels[name] = thinned(channels[name])
    return replace(recording, channels=channels)


def _run(
    recordings: Sequence[Recording], instrument: Instrument, period: float
) -> tuple[Sequence[Segment], Sequence[FloatArray]]:
    """Return recordings on bins of a length [s], and the channels as the file has them there."""
    segments = [segment_of(instrument, r, period) for r in recordings]
    segments = [placed(instrument, s, r) for s, r in zip(segments, recordings, strict=True)]
    return segments, Rollouts(instrument, segments).predicted([[] for _ in segments])


def _heard(
    recordings: Sequence[Recording],
    instrument: Instrument,
    segments: Sequence[Segment],
    predicted: Sequence[FloatArray],
) -> Binned:
    """Return recordings on bins with their noise."""
    noise = noise_of_counts(instrument, segments, recordings, predicted)
    return Binned(noise.given(segments, predicted), predicted, noise)


def _halved(segments: Sequence[Segment]) -> float:
    """Return half the length of the bins, in whole samples [s]; 0 where they get no shorter."""
    sampling = max(s.sampling for s in segments)
    return round(segments[0].period / sampling) // 2 * sampling


def _noises(segments: Sequence[Segment]) -> list[FloatArray]:
    """Return the noise of the channels of recordings, shape (channels, bins) each."""
    return [np.array([m.noise for m in s.measured]).reshape(-1, len(s.time)) for s in segments]


def _there(
    segments: Sequence[Segment], rows: Sequence[FloatArray], others: Sequence[Segment]
) -> list[FloatArray]:
    """Return what is known on bins at those of the same recordings on others."""
    return [
        np.array([np.interp(o.start + o.time, s.start + s.time, row) for row in of_one])
        for s, of_one, o in zip(segments, rows, others, strict=True)
    ]


def _shows(
    segments: Sequence[Segment], changes: Sequence[FloatArray], noises: Sequence[FloatArray]
) -> bool:
    """Return whether changes are more than a channel's noise in any recording."""
    for segment, *rows in zip(segments, changes, noises, strict=True):
        used = (segment.time > SETTLING) & (segment.time < segment.time[-1] - ENDING)
        for m, change, noise in zip(segment.measured, *rows, strict=True):
            counts = used & np.isfinite(m.value) & np.isfinite(change)
            if np.sum(change[counts] ** 2) > DROWNS**2 * np.sum(noise[counts] ** 2):
                return True
    return False
