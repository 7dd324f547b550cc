"""
Single readings of angles that went astray: a bit that fell over, a message that was late.

A motor that would have been there for one sample has an acceleration that no torque made, and its
torque is foretold wrong by many times its noise. Nothing mechanical comes and goes like that: all
around such a reading lies on one curve, with it and without it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from tendon_ros.base.recording import Channel, FloatArray, Recording
from tendon_ros.diagnose.intake.step import Sifted
from tendon_ros.model.instrument import Instrument

#: times what readings around are off a curve that one is off which is astray; and times that
#: those beside it are off at most, once it is gone, and less than it was
ASTRAY, BESIDE = 12.0, 4.0
#: readings on either side of those around; and counts that one that is astray is off at least
AROUND, COUNTS = 25, 3.0
#: part of all readings that may be astray: more are how this sensor reads
FEW = 2e-3
FINEST = 1e-9  # [rad] count of a sensor of which nobody knows it
#: readings on either side through which a curve goes
NEAR = (-2, -1, 1, 2)


def without_astray(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Take out single readings of angles that nothing around them agrees with.

    :param recordings: what was measured.
    :param instrument: its encoders count.
    :return: the recordings without such readings, and a sentence for each channel that had some.
    """
    counts = {s.channel: s.resolution for s in instrument.sensors if s.kind == 'angle'}
    kept, sentences = [], []
    for recording in recordings:
        changed = []
        for name, count in counts.items():
            if name not in recording:
                continue
            channel = recording[name]
            gone, off = _astray(channel, count)
            if not gone.any():
                continue
            changed.append(Channel(name, channel.time[~gone], channel.value[~gone]))
            worst = int(np.argmax(np.where(gone, np.abs(off), 0.0)))
            single = np.count_nonzero(gone)
            sentences.append(
                f'{recording.name}: {single} reading{"s" if single > 1 else ""} of {name} '
                f'{"are" if single > 1 else "is"} left out, which nothing around agrees with '
                f'(a late message, or a bit that fell over), the worst at '
                f'{channel.time[worst]:.3f} s, off by {abs(off[worst]):.2g} rad'
            )
        kept.append(recording.with_channels(changed) if changed else recording)
    return tuple(kept), sentences


def _astray(channel: Channel, count: float) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which readings are astray, and how far each is off the curve beside it [rad]."""
    value, size = channel.value, channel.value.size
    nothing = np.zeros(size, dtype=np.bool_)
    if size < 2 * AROUND:
        return nothing, np.zeros(size)
    off = _off(channel.time, value)
    # a sensor may count otherwise than its file says, and while it rests a count is all there is
    steps = np.abs(np.diff(value))
    count = max(
        count, FINEST, float(steps[steps > 0.0].min(initial=np.inf)) if steps.any() else 0.0
    )
    usual = median_filter(np.abs(off), 2 * AROUND + 1, mode='nearest')
    wild = np.abs(off) > np.maximum(ASTRAY * usual, COUNTS * count)
    # what is astray takes those beside it along, by less
    most = np.maximum.reduce([np.abs(np.roll(off, n)) for n in (-2, -1, 1, 2)])
    gone = nothing
    for n in np.flatnonzero(wild & (np.abs(off) > most)).tolist():
        near = np.delete(np.arange(n - 4, n + 5), 4)
        if near[0] < 0 or near[-1] >= size:
            continue
        rest = _off(channel.time[near], value[near])[2:-2]
        # beside a leap, what is on either side of it stays as it was
        if np.abs(rest).max() < min(BESIDE * max(usual[n], count), abs(off[n]) / BESIDE):
            gone[n] = True
    if np.count_nonzero(gone) > FEW * size:
        return np.zeros(size, dtype=np.bool_), off
    return gone, off


def _off(time: FloatArray, value: FloatArray) -> FloatArray:
    """Return how far each reading is off the cubic through two on either side; 0 at the ends."""
    found = np.zeros(value.size)
    here = slice(2, value.size - 2)
    at = {n: (time[2 + n : value.size - 2 + n], value[2 + n : value.size - 2 + n]) for n in NEAR}
    inner = time[here]
    through = np.zeros(inner.size)
    for n in NEAR:
        weight = np.ones(inner.size)
        for other in NEAR:
            if other != n:
                weight *= (inner - at[other][0]) / (at[n][0] - at[other][0])
        through += weight * at[n][1]
    found[here] = value[here] - through
    return found
