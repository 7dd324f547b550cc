"""What makes a verdict itself doubtful: units that cannot be, noise that hides what there is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np

from tendon_ros.base.recording import unit_of
from tendon_ros.diagnose.evidence import Moved, Trace
from tendon_ros.diagnose.prepare import Prepared

#: times the noise that is accounted for, beyond which what is heard is something else; and times
#: the noise of a sensor from which on one wants to hear what hides what it would show
LOUD = 3.0
#: times that a motor's torque is weaker than it can be
WEAK = 20.0


def absurd_words(moved: Sequence[Moved]) -> list[str]:
    """
    Say which guesses turned out so far off that the reason is rather another unit.

    :param moved: the numbers of the file as they were fitted.
    :return: a sentence for each.
    """
    return [
        f'the {one.quantity.replace("_", " ")} of {one.place} fits best as {one.value:.3g} times '
        'what the file guesses; where that cannot be, a recorded channel has another unit than '
        'its import says'
        for one in moved
        if one.absurd
    ]


def weak_words(traces: Sequence[Trace]) -> list[str]:
    """
    Say which motors report far less than the motion takes by the file, which no effect does.

    A torque may be many times what a file without friction foretells, and a load cell may feel
    nothing where the file has a wall: neither is said.

    :param traces: every channel, measured and predicted.
    :return: a sentence for each motor's torque.
    """
    powers: dict[str, list[tuple[float, float]]] = {}
    for trace in traces:
        if trace.channel.startswith('actuator/') and trace.channel.endswith('/effort'):
            powers.setdefault(trace.channel, []).append(
                (float(np.sum(trace.before**2)), float(np.sum(trace.measured**2)))
            )
    found = []
    for channel, parts in powers.items():
        expected, measured = np.sqrt(np.sum(parts, axis=0))
        if math.isfinite(expected) and expected > WEAK * measured:
            found.append(
                f'{channel} is {expected / max(measured, 1e-30):.0f} times weaker than the file '
                'foretells for this motion, which no effect makes it: a column that was taken '
                'for another, or a unit (of the torque, or degrees as rad), is likelier'
            )
    return found


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


def coarse_words(ready: Prepared) -> list[str]:
    """
    Say of which channels a count of the encoders hides more than their own noise does.

    :param ready: the problem, with its noise.
    :return: a sentence for each of whose sensor the file tells the noise.
    """
    return [
        f'{one.channel} is foretold to {one.heard:.2g} {unit_of(one.channel)} and no better, '
        f'{one.heard / one.sensor:.0f} times what its sensor leaves: the motion is known '
        'to a count of the encoders, and inertia and cables make that much of a count. What is '
        'smaller does not show here; slower motions or a finer encoder show more'
        for one in _levels(ready)
        if one.heard > LOUD * one.sensor and one.heard <= LOUD * one.told
    ]


@dataclass(frozen=True)
class _Level:
    """Noise of a channel's bins in its unit: heard, of its sensor alone, and with counts."""

    channel: str
    heard: float
    sensor: float
    told: float


def _levels(ready: Prepared) -> list[_Level]:
    """Return the noise of each channel of whose sensor the file tells it."""
    powers: dict[str, list[tuple[float, float, float]]] = {}
    for segment, counts in zip(ready.whole.rollouts.segments, ready.noise.counts, strict=True):
        for m, counted in zip(segment.measured, counts, strict=True):
            if m.floor > 0.0:
                own = m.floor**2
                powers.setdefault(m.sensor.channel, []).append(
                    (float(np.mean(m.noise**2)), own, own + float(np.mean(counted**2)))
                )
    return [
        _Level(channel, *(math.sqrt(power) for power in np.mean(parts, axis=0)))
        for channel, parts in powers.items()
    ]
