"""
Repetition: how far a machine agrees with itself where it does the same again.

What differs between two cycles of one motion, or between recordings of one motion, no model of the
machine can tell, whatever it looks like. It belongs to the noise floor.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import Segment, SETTLING

FloatArray = NDArray[np.float64]

ALIKE = 1e-3  # part of a motion's power by which its repetition may differ
#: times as much of a measured load's: it has noise, and what it does to the model is accounted for
LOADS = 30.0
AWAY = 0.05  # the same, from where on a motion has gone somewhere before it repeats itself
STILL = 0.02  # deviation of a motion, against the largest one, that is no motion
PART = 0.75  # [s] that are one piece of evidence; of all pieces, half may hold something unusual
PIECES = 4  # that are needed
RECORDINGS = 3  # of one motion that are needed: of two, nobody knows which one is unusual


def cycle(segment: Segment) -> int:
    """
    Return after how many bins what drives the model repeats itself.

    :param segment: a recording.
    :return: bins; 0 where it does not.
    """
    rows = _moving(segment)
    if not len(rows):
        return 0
    gone = False
    best, least = 0, ALIKE
    for lag in range(1, rows.shape[1] // 2 + 1):
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

    :param segments: all recordings.
    :param left: of each the channels' misfits, in their units, shape (bins,) each.
    :return: of each segment, for each channel, one deviation in its unit; 0 where nothing is
        repeated often enough to tell.
    """
    squares: list[list[list[float]]] = [[[] for _ in s.measured] for s in segments]
    for n, segment in enumerate(segments):
        lag = cycle(segment)
        if not lag:
            continue
        late = segment.time[:-lag] > SETTLING
        for c, _ in enumerate(segment.measured):
            apart = (left[n][c][lag:] - left[n][c][:-lag])[late] / np.sqrt(2.0)
            squares[n][c] += _pieces(apart, segment.period)
    for alike in _groups(segments):
        if len(alike) < RECORDINGS:
            continue
        for c, _ in enumerate(segments[alike[0]].measured):
            rows = np.array([left[n][c] for n in alike])
            apart = (rows - np.median(rows, axis=0)) * np.sqrt(len(alike) / (len(alike) - 1.0))
            for n, row in zip(alike, apart, strict=True):
                late = segments[n].time > SETTLING
                squares[n][c] += _pieces(row[late], segments[n].period)
    return [
        [float(np.sqrt(np.median(p))) if len(p) >= PIECES else 0.0 for p in channels]
        for channels in squares
    ]


def _driven(segment: Segment) -> FloatArray:
    """Return what drives the model in each bin, one row each."""
    return segment.motion.value[:, : len(segment.time)]


def _moving(segment: Segment) -> FloatArray:
    """Return what drives the model and is not still, each row in deviations of its own."""
    rows = _driven(segment)
    spread = rows.std(axis=1)
    kept: list[FloatArray] = []
    angles = len(segment.prescribed)
    for kind in (slice(0, angles), slice(angles, len(rows))):
        most = float(spread[kind].max(initial=0.0))
        unit = 1.0 if kind.start == 0 else np.sqrt(LOADS)
        kept += [
            row / (unit * s)
            for row, s in zip(rows[kind], spread[kind], strict=True)
            if s > STILL * most
        ]
    return np.array(kept)


def _pieces(apart: FloatArray, period: float) -> list[float]:
    """Return mean squares of pieces of a difference."""
    known = apart[np.isfinite(apart)]
    length = max(1, round(PART / period))
    count = len(known) // length
    pieces = known[: count * length].reshape(count, length)
    return [float(square) for square in np.mean(pieces**2, axis=1)]


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
    if (
        len(one.time) != len(other.time)
        or one.contacts != other.contacts
        or (one.prescribed, one.pushed) != (other.prescribed, other.pushed)
        or channels[0] != channels[1]
    ):
        return False
    first, second = _driven(one), _driven(other)
    power = np.mean((first - second) ** 2, axis=1)
    allowed = np.where(np.arange(len(first)) < len(one.prescribed), ALIKE, LOADS * ALIKE)
    return bool((power <= 2.0 * allowed * first.var(axis=1)).all())
