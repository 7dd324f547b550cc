"""What noise hides: channels that scatter more than is accounted for, or than their sensors do."""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import unit_of
from tendon_ros.diagnose.prepare import Prepared

FloatArray = NDArray[np.float64]

#: times the noise that is accounted for, beyond which what is heard is something else; and times
#: the noise of a sensor from which on one wants to hear what hides what it would show
LOUD = 3.0
#: part of what a channel varies by from which on noise that is accounted for hides much
HIDES = 0.2


def loud_words(ready: Prepared) -> list[str]:
    """
    Say which channels scatter far more than their sensors and the encoders' counts account for.

    :param ready: the problem, with its noise.
    :return: a sentence for each of whose sensor the file tells the noise.
    """
    return [
        f'{one.channel} scatters {one.heard / one.told:.0f} times as much as its sensor and the '
        'counts of the encoders account for: what shakes or knocks faster than the model is '
        'compared (a play, a fast ripple, a loop near its limit) is taken for noise here'
        for one in _levels(ready)
        if one.heard > LOUD * one.told
    ]


def coarse_words(ready: Prepared, *, much: bool = False) -> list[str]:
    """
    Say of which channels counts of the encoders, or bins, hide more than their own noise does.

    :param ready: the problem, with its noise.
    :param much: of which they hide a good part of all that the channel does, or of the others.
    :return: a sentence for each of whose sensor the file tells the noise.
    """
    found = []
    for one in _levels(ready):
        if one.heard <= LOUD * one.sensor or one.heard > LOUD * one.told:
            continue
        part = min(one.heard / max(one.varies, 1e-30), 1.0)
        if (part > HIDES) is not much:
            continue
        if one.bins > one.counts:
            period = ready.whole.rollouts.segments[0].period
            why = (
                f'bins of {1e3 * period:.2g} ms see no more of what swings that fast, and shorter '
                'ones would be too many. What is smaller does not show here; slower motions, or '
                'fewer seconds of them, show more'
            )
        else:
            why = (
                'the motion is known to a count of the encoders, and inertia and cables make that '
                'much of a count. What is smaller does not show here; slower motions or a finer '
                'encoder show more'
            )
        if much:
            why += f'. That is {part:.0%} of all that it does: that there is no gap says little'
        found.append(
            f'{one.channel} is foretold to {one.heard:.2g} {unit_of(one.channel)} and no better, '
            f'{one.heard / one.sensor:.0f} times what its sensor leaves: {why}'
        )
    return found


@dataclass(frozen=True)
class _Level:
    """
    Noise of a channel's bins in its unit: heard, and what its sensor, counts and bins make.

    ``varies``: what it measures, about its mean.
    """

    channel: str
    varies: float
    heard: float
    sensor: float
    counts: float
    bins: float

    @property
    def told(self) -> float:
        """Noise that is accounted for."""
        return math.hypot(self.sensor, self.counts, self.bins)


def _levels(ready: Prepared) -> list[_Level]:
    """Return the noise of each channel of whose sensor the file tells it."""
    powers: dict[str, list[FloatArray]] = {}
    segments = ready.whole.rollouts.segments
    for segment, *made in zip(segments, ready.noise.counts, ready.noise.bins, strict=True):
        for m, *rows in zip(segment.measured, *made, strict=True):
            if m.floor > 0.0:
                varies = float(np.nanvar(m.value))
                heard, *others = (float(np.mean(row**2)) for row in (m.noise, *rows))
                power = np.array([varies, heard, m.floor**2, *others])
                powers.setdefault(m.sensor.channel, []).append(power)
    return [
        _Level(channel, *np.sqrt(np.mean(parts, axis=0)).tolist())
        for channel, parts in powers.items()
    ]
