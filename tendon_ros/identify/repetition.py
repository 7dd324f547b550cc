"""
Repetition: how far a machine agrees with itself where it does the same again.

What differs at random between cycles of one motion, or between recordings of one motion, no model
of the machine can tell, whatever it looks like. It belongs to the noise floor.
"""

from __future__ import annotations

from collections.abc import Sequence
import warnings

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import Segment, SETTLING

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

ALIKE = 1e-3  # part of a motion's power by which its repetition may differ
#: times as much of a measured load's: it has noise, and what it does to the model is accounted for
LOADS = 30.0
AWAY = 0.05  # the same, from where on a motion has gone somewhere before it repeats itself
STILL = 0.02  # deviation of a motion, against the largest one, that is no motion
PART = 0.75  # [s] that are one piece of evidence; of all pieces, half may hold something unusual
PIECES = 4  # that are needed
CYCLES = 4  # that are needed: fewer, and what changes once lies between most of them
LENGTH = 0.95  # part of the longer recording that the shorter one of the same motion has
RECORDINGS = 3  # of one motion that are needed: of two, nobody knows which one is unusual


def cycle(segment: Segment) -> int:
    """
    Return after how many bins what drives the model repeats itself.

    :param segment: a recording.
    :return: bins; 0 where it does not do so often enough.
    """
    rows = _moving(segment)
    if not len(rows):
        return 0
    gone = False
    best, least = 0, ALIKE
    for lag in range(1, rows.shape[1] // CYCLES + 1):
        power = float(np.mean((rows[:, lag:] - rows[:, :-lag]) ** 2, axis=1).max()) / 2.0
        gone = gone or power > AWAY
        if not gone:
            continue
        if power < least:
            best, least = lag, power
        elif best and power > AWAY:
            break  # longer ones are multiples
    return best


def unrepeated(
    segments: Sequence[Segment], left: Sequence[Sequence[FloatArray]]
) -> list[list[float]]:
    """
    Return what does not repeat itself of each channel.

    What changes once (a slip) shows between two cycles only, what changes slowly (creep) hardly
    between a cycle and the mean of its neighbours: neither is taken for noise.

    :param segments: all recordings.
    :param left: of each the channels' misfits, in their units, shape (bins,) each.
    :return: of each segment, for each channel, one deviation in its unit; 0 where nothing is
        repeated often enough to tell.
    """
    found = [[0.0] * len(s.measured) for s in segments]
    for n, segment in enumerate(segments):
        lag = cycle(segment)
        if not lag:
            continue
        for c in range(len(segment.measured)):
            row = left[n][c][segment.time > SETTLING]
            apart = (row[lag:] - row[:-lag]) / np.sqrt(2.0)
            bent = (row[2 * lag :] - 2.0 * row[lag:-lag] + row[: -2 * lag]) / np.sqrt(6.0)
            found[n][c] = min(_usual(apart, segment.period), _usual(bent, segment.period))
    for alike in _groups(segments):
        if len(alike) < RECORDINGS:
            continue
        bins = min(len(segments[n].time) for n in alike)
        for c in range(len(segments[alike[0]].measured)):
            rows = np.array([left[n][c][:bins] for n in alike])
            rows = rows[:, segments[alike[0]].time[:bins] > SETTLING]
            known = np.isfinite(rows).sum(axis=0)
            rows = np.where(known >= RECORDINGS, rows, np.nan)
            with warnings.catch_warnings():
                warnings.simplefilter('ignore', RuntimeWarning)  # where nobody measured
                middle = np.nanmedian(rows, axis=0)
            apart = (rows - middle) * np.sqrt(known / np.maximum(known - 1.0, 1.0))
            for n, row in zip(alike, apart, strict=True):
                found[n][c] = max(found[n][c], _usual(row, segments[n].period))
    return found


def _driven(segment: Segment) -> FloatArray:
    """Return what drives the model in each bin, one row each."""
    return segment.motion.value[:, : len(segment.time)]


def _moving(segment: Segment) -> FloatArray:
    """Return what drives the model and is not still, each row in deviations of its own."""
    rows = _driven(segment)
    angles = np.arange(len(rows)) < len(segment.prescribed)
    unit = np.where(angles, 1.0, np.sqrt(LOADS))
    moves = rows.std(axis=1) >= np.maximum(_spread(rows, angles), 1e-30)
    return np.asarray(rows[moves] / (unit[moves] * rows[moves].std(axis=1))[:, None])


def _usual(apart: FloatArray, period: float) -> float:
    """Return the deviation of a difference in the median of its pieces; 0 where there are few."""
    known = apart[np.isfinite(apart)]
    length = max(1, round(PART / period))
    count = len(known) // length
    if count < PIECES:
        return 0.0
    pieces = known[: count * length].reshape(count, length)
    return float(np.sqrt(np.median(np.mean(pieces**2, axis=1))))


def _groups(segments: Sequence[Segment]) -> list[list[int]]:
    """Return the recordings of each motion that there is."""
    groups: list[list[int]] = []
    for n, segment in enumerate(segments):
        for group in groups:
            if _same(segments[group[0]], segment):
                group.append(n)
                break
        else:
            groups.append([n])
    return groups


def _same(one: Segment, other: Segment) -> bool:
    """Return whether two recordings are of one motion, against the same surroundings."""
    channels = [[m.sensor.channel for m in s.measured] for s in (one, other)]
    bins = [len(s.time) for s in (one, other)]
    if (
        min(bins) < LENGTH * max(bins)
        or one.contacts != other.contacts
        or (one.prescribed, one.pushed) != (other.prescribed, other.pushed)
        or channels[0] != channels[1]
    ):
        return False
    first, second = (_driven(s)[:, : min(bins)] for s in (one, other))
    angles = np.arange(len(first)) < len(one.prescribed)
    unit = np.where(angles, 1.0, np.sqrt(LOADS))
    spread = unit * np.maximum(_spread(first, angles), 1e-30)
    power = np.mean(((first - second) / spread[:, None]) ** 2, axis=1)
    return bool((power <= 2.0 * ALIKE).all())


def _spread(rows: FloatArray, angles: BoolArray) -> FloatArray:
    """Return the deviation of each row, of those that are still the least that is a motion."""
    spread = rows.std(axis=1)
    for kind in (angles, ~angles):
        spread[kind] = np.maximum(spread[kind], STILL * spread[kind].max(initial=0.0))
    return spread
