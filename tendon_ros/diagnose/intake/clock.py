"""
Stamps: gaps, missing samples and clock jumps in what drives the model.

Channels keep their own stamps; that they are not synchronised is no fault, and a late sensor is
for the diagnosis to find. But across a gap in the motors' motion nobody knows what the rig did: a
short one takes the samples around it from what is compared, a long one cuts the recording in two.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.intake.breaks import Break, breaks_of, missing_share
from tendon_ros.diagnose.intake.step import shared_span, Sifted
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument

BEFORE, AFTER = 0.05, 0.1  # [s] around a gap in which comparisons feel it
MUCH = 0.05  # share of missing samples that is worth a sentence


def cut_at_breaks(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Cut recordings where the motion is unknown, and take out what short gaps spoil.

    :param recordings: with every motor's position.
    :param instrument: the network.
    :return: recordings on the time that all motors were measured, and sentences.
    """
    kept: list[Recording] = []
    sentences: list[str] = []
    for recording in recordings:
        names = motor_channels(instrument)
        breaks = _apart([b for name in names for b in breaks_of(recording[name])])
        bridged = [b for b in breaks if not b.cuts]
        cuts = [b for b in breaks if b.cuts]
        sentences += [
            f'{recording.name}: {b.words}; cut there, and each part judged by itself' for b in cuts
        ]
        if bridged:
            longest = max(bridged, key=lambda b: b.end - b.start)
            gaps = '1 gap' if len(bridged) == 1 else f'{len(bridged)} gaps'
            sentences.append(
                f'{recording.name}: {gaps} in the motor positions, the longest of '
                f'{longest.end - longest.start:.3f} s at {longest.start:.3f} s; what was measured '
                'around them is left out'
            )
        lost, name = max((missing_share(recording[name]), name) for name in names)
        if lost > MUCH:
            sentences.append(
                f'{recording.name}: {name} lacks {lost:.0%} of its samples; the motion between '
                'is interpolated'
            )
        parts, said = _parts(recording, names, cuts, bridged)
        kept += parts
        sentences += said
    return tuple(kept), sentences


def _apart(breaks: Sequence[Break]) -> list[Break]:
    """Return breaks of several motors in the order of time, those at one place as the longest."""
    found: list[Break] = []
    for one in sorted(breaks, key=lambda b: (b.start, -b.end)):
        if not found or one.start >= found[-1].end:
            found.append(one)
        elif one.end > found[-1].end or one.cuts > found[-1].cuts:
            last = found.pop()
            longer = one if one.cuts >= last.cuts else last
            found.append(replace(longer, start=last.start, end=max(one.end, last.end)))
    return found


def _parts(
    recording: Recording, names: Sequence[str], cuts: Sequence[Break], bridged: Sequence[Break]
) -> tuple[list[Recording], list[str]]:
    """Return the pieces of a recording between the cuts."""
    start, end = shared_span(recording, names)
    if end <= start:
        return [recording], []  # too short, as the next check will say
    edges = [start, *(t for b in cuts for t in (b.start, b.end)), end]
    parts: list[Recording] = []
    said: list[str] = []
    for low, high in zip(edges[::2], edges[1::2], strict=True):
        if high <= low:
            continue
        channels = {}
        for name, channel in recording.channels.items():
            piece = channel.between(low, high)
            if name not in names and not name.startswith('setpoint/'):
                piece = _off(piece, bridged)
            if piece.value.size:
                channels[name] = piece
            else:
                said.append(
                    f'{recording.name}: {name} left out: none of its {channel.value.size} samples '
                    f'lies in {low:.3f} to {high:.3f} s, when the motors are measured; record all '
                    'on one clock'
                )
        name = f'{recording.name} [{low:.1f}-{high:.1f} s]' if cuts else recording.name
        parts.append(replace(recording, name=name, channels=channels))
    return parts, said


def _off(channel: Channel, gaps: Sequence[Break]) -> Channel:
    """Return a channel without the neighbourhood of gaps."""
    keep = np.ones(channel.time.size, dtype=np.bool_)
    for gap in gaps:
        keep &= (channel.time < gap.start - BEFORE) | (channel.time > gap.end + AFTER)
    return replace(channel, time=channel.time[keep], value=channel.value[keep])
