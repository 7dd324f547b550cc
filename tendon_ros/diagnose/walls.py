"""
What the tip met in a recording: walls of the file, something else whose load was measured, or air.

Walls belong to the surroundings, not to the instrument, and are found before any cause is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import loaded, Measured, Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]

#: times the force of the file's walls that those of a recording may have: another stiffness, or
#: an encoder whose zero moves the wall, is looked for later; and part of what no wall has wrong
#: that they may leave, for a small force imitates a bias
SIZES = np.geomspace(0.2, 5.0, 9)
RESIZED = 0.5
STILL = 1e-3  # part of what a channel reads that is no motion
#: part of what the contact force has against no wall that a wall of the file may leave
NO_WALL = 0.6
#: part that a load which truly pushes leaves of what the other channels have against its absence
FELT = 0.8


def placed(instrument: Instrument, segment: Segment, recording: Recording) -> Segment:
    """
    Return a segment with what the tip met, and the pose from which the motion began.

    :param instrument: the network.
    :param segment: with every wall that there may be.
    :param recording: what was measured.
    :return: the segment with the walls that were met, or with the load that was measured.
    """
    names = segment.contacts
    nobody, *some = product((False, True), repeat=min(len(names), 3))
    best = _meeting(instrument, segment, nobody)
    predicted = nothing = _predicted(instrument, best)
    least = without = _misfit(segment, nothing)
    for there in some:
        trial = _meeting(instrument, segment, there)
        rows = _predicted(instrument, trial)
        misfit = _misfit(segment, rows)
        if np.isfinite(misfit) and np.isfinite(without):
            resized = min(_misfit(segment, nothing + size * (rows - nothing)) for size in SIZES)
            misfit = min(misfit, resized) if resized < RESIZED * without else misfit
        # a wall that nothing came near is as good as none, and may be there
        if 0.999 * misfit < least:
            best, least, predicted = trial, misfit, rows
    # a cell whose bias is in the file reads something where nothing was met
    met, not_met = (_forces(_misfits(segment, rows)) for rows in (predicted, nothing))
    if met > NO_WALL * not_met:
        pushed = loaded(instrument, recording, segment)
        if pushed is not None and pushed.measured:
            pushed = _posed(instrument, pushed)
            # the noise or the bias of a cell that touches nothing has no wall either
            others = _misfits(pushed, _predicted(instrument, pushed))
            before = sum(m for c, m in _misfits(segment, predicted).items() if c in others)
            if sum(others.values()) < FELT * before:
                return pushed
    return best


def _meeting(instrument: Instrument, segment: Segment, there: Sequence[bool]) -> Segment:
    """Return a segment with some of its first walls, all others, and the pose at its start."""
    names = segment.contacts
    kept = tuple(n for n, t in zip(names, there, strict=False) if t) + names[len(there) :]
    return _posed(instrument, replace(segment, contacts=kept))


def _predicted(instrument: Instrument, segment: Segment) -> FloatArray:
    """Return the channels of a segment as the instrument file has them."""
    [predicted] = Rollouts(instrument, [segment]).predicted([[]])
    return predicted


def _forces(misfits: Mapping[str, float]) -> float:
    """Return the part of the contact forces that is wrong, of the channel where it is most."""
    return max((m for c, m in misfits.items() if c.startswith('load_cell/')), default=0.0)


def _misfit(segment: Segment, predicted: FloatArray) -> float:
    """
    Return the parts that a prediction gets wrong of all that moves in channels, added up.

    Zeros may be off: a bias or a gravity torque is nearly a wall that presses all the time.
    Infinite where the file's model diverges.
    """
    if not np.isfinite(predicted).all():
        return np.inf
    found = 0.0
    for measured, said, value in _compared(segment, predicted):
        moves = np.var(value) + np.mean(measured.noise**2) + STILL**2 * np.mean(value**2)
        off = min(np.var(said - value), _in_size(said, value))
        found += float(off / (moves + 1e-30))
    return found


def _misfits(segment: Segment, predicted: FloatArray) -> dict[str, float]:
    """Return the part of each channel's power that a prediction gets wrong."""
    found = {}
    for measured, said, value in _compared(segment, predicted):
        off = min(float(np.mean((said - value) ** 2)), _in_size(said, value))
        found[measured.sensor.channel] = off / (float(np.mean(value**2)) + 1e-30)
    return found


def _in_size(said: FloatArray, value: FloatArray) -> float:
    """Return what is wrong without a sign: a sensor that loses it must not deny a wall."""
    return float(np.mean((np.abs(said) - np.abs(value)) ** 2))


def _compared(
    segment: Segment, predicted: FloatArray
) -> Iterator[tuple[Measured, FloatArray, FloatArray]]:
    """Yield channels with what a prediction says and what they read, where they read anything."""
    for row, measured in zip(predicted, segment.measured, strict=True):
        known = np.isfinite(measured.value)
        if known.sum() > 2:
            yield measured, row[known], measured.value[known]


def _posed(instrument: Instrument, segment: Segment) -> Segment:
    """Return a segment with the pose in which the model rests before the motion begins."""
    if not segment.begins_at_rest(instrument):
        return segment
    first = segment.motion.value[:, 0]
    resting = replace(
        segment,
        motion=Signals(
            np.repeat(first[:, None], 200, axis=1),
            np.zeros((len(first), 200)),
            0.0,
            0.01,
        ),
        time=0.01 * np.arange(200, dtype=np.float64),
        period=0.01,
        measured=(),
        pose={},
    )
    inner = Rollouts(instrument, [resting]).rest()
    return replace(segment, pose=inner)
