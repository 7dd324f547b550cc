"""Stretches of recordings: what lies between two times, as a recording of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
import math

from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.recording import Channel, Recording


@dataclass(frozen=True)
class Stretch:
    """
    What to look at of a recording.

    ``recording``: its name; empty for all of which no stretch is named. ``first``, ``last``: in
    seconds from its first stamp.
    """

    recording: str
    first: float
    last: float

    @classmethod
    def parsed(cls, text: str) -> Stretch:
        """
        Return the stretch of ``[RECORDING=]FROM:TO``, either end of which may be left out.

        :param text: such as ``2:10``, ``run1=:30``.
        :return: the stretch.
        :raises RecordingError: where it is none.
        """
        name, equals, times = text.rpartition('=')
        first, colon, last = times.partition(':')
        try:
            found = cls(name, float(first or 0.0), float(last or math.inf))
        except ValueError:
            colon = ''
        if not colon or (equals and not name) or not 0.0 <= found.first < found.last:
            raise RecordingError(
                f'{text!r}: give seconds as FROM:TO, such as 2:10, or of one recording as '
                'NAME=FROM:TO'
            )
        return found


def within(recordings: Sequence[Recording], stretches: Sequence[Stretch]) -> list[Recording]:
    """
    Return what lies within stretches, each of them a recording of its own.

    :param recordings: whole ones.
    :param stretches: of them; none where recordings are wanted as they are.
    :return: the stretches, in the order of recordings and times, and recordings of which none was
        asked as they are.
    :raises RecordingError: on stretches of nothing, or of the same time.
    """
    names = {r.name for r in recordings}
    for stretch in stretches:
        if stretch.recording and stretch.recording not in names:
            raise RecordingError(f'no recording {stretch.recording!r}; there are {listed(names)}')
    found: list[Recording] = []
    for recording in recordings:
        own = [s for s in stretches if s.recording == recording.name]
        own = sorted(own or [s for s in stretches if not s.recording], key=lambda s: s.first)
        for one, later in pairwise(own):
            if later.first < one.last:
                raise RecordingError(
                    f'{recording.name}: {one.first:g}:{one.last:g} and '
                    f'{later.first:g}:{later.last:g} share seconds, which would count twice'
                )
        found += [_cut(recording, s) for s in own] or [recording]
    return found


def _cut(recording: Recording, stretch: Stretch) -> Recording:
    """Return the part of a recording in a stretch; its time zero is where that begins."""
    lasts = recording.end - recording.start
    if stretch.first > lasts:
        raise RecordingError(
            f'{recording.name}: lasts {lasts:.1f} s, and has nothing between {stretch.first:g} '
            f'and {stretch.last:g} s'
        )
    begins = recording.start + stretch.first
    ends = math.nextafter(recording.start + stretch.last, begins)  # who ends there begins the next
    channels: dict[str, Channel] = {}
    silent: list[str] = []
    for name, channel in recording.channels.items():
        piece = channel.between(begins, ends)
        if piece.time.size:
            channels[name] = replace(piece, time=piece.time - begins)
        else:
            silent.append(name)
    name = f'{recording.name}, {stretch.first:g} to {min(stretch.last, lasts):.4g} s'
    warnings = [f'{name}: {one} left out: it says nothing in that time' for one in silent]
    return replace(
        recording,
        name=name,
        channels=channels,
        epoch_ns=recording.epoch_ns + round(1e9 * begins),
        warnings=(*recording.warnings, *warnings),
    )
