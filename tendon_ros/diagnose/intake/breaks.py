"""Where the stamps of a motor's position, or its counts, go wrong: gaps, clock jumps, leaps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import math

import numpy as np

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake.motion import STILL

GAP = 8.0  # usual spacings
SHORT_GAP = 0.03  # [s] that interpolation bridges whatever the sampling
LONG_GAP = 0.5  # [s] beyond which the motion is unknown
#: times the steps around it, or times what these differ by from one to the next and some times
#: them, by which a step is another than those beside it: no motor moves like that
LEAP, FASTER = 20.0, 3.0
#: times the largest step at any other time by which one from rest to rest is none of the motor
UNSEEN = 20.0
AROUND = 5  # samples
TURN = 2.0 * math.pi  # [rad]
ALL = 0.9  # part of all that it reads by which a reading begins anew


@dataclass(frozen=True)
class Break:
    """A place without motion to drive with: from the last good sample [s] to the next."""

    start: float
    end: float
    cuts: bool  # too long to be bridged
    words: str


def breaks_of(channel: Channel) -> list[Break]:
    """
    Return the breaks in what drives the model.

    :param channel: a motor's position; or its torque, which may well leap.
    :return: in the order of time; gaps in which the motor stood still are none, unless long.
    """
    leaps = _leaps(channel) if channel.name.endswith('/position') else ()
    return sorted([*_gaps(channel), *leaps], key=lambda found: found.start)


def missing_share(channel: Channel) -> float:
    """
    Return how many single samples are missing.

    :param channel: any channel.
    :return: share of those that there should be, gaps not counted.
    """
    step = np.diff(channel.time)
    usual = channel.sampling
    small = step[step <= max(GAP * usual, SHORT_GAP)]
    lost = float(np.sum(np.rint(small / usual) - 1.0))
    return max(0.0, lost / (lost + step.size))


def _gaps(channel: Channel) -> Iterator[Break]:
    time, value = channel.time, channel.value
    usual = channel.sampling
    for n in np.flatnonzero(np.diff(time) > max(GAP * usual, SHORT_GAP)).tolist():
        gap = float(time[n + 1] - time[n])
        moved = abs(float(value[n + 1] - value[n]))
        if gap <= LONG_GAP and moved <= STILL:
            continue
        first = max(n - AROUND, 0)
        pace = abs(float(value[n] - value[first])) / max(n - first, 1)  # [rad] a sample
        words = f'{channel.name} has a gap of {gap:.3f} s at {time[n]:.3f} s'
        if gap > LONG_GAP and moved <= 5.0 * pace and 20.0 * moved < pace * gap / usual:
            words = (
                f'the clock of {channel.name} jumps by {gap:.3f} s at {time[n]:.3f} s while the '
                'motion goes on without a break'
            )
        yield Break(float(time[n]), float(time[n + 1]), gap > LONG_GAP, words)


def _leaps(channel: Channel) -> Iterator[Break]:
    time = channel.time
    steps = np.diff(channel.value)
    leap = np.abs(steps)
    usual = channel.sampling
    previous, next_one = np.append(0.0, steps[:-1]), np.append(steps[1:], 0.0)
    off = np.abs(steps - 0.5 * (previous + next_one))
    beside = np.maximum(np.abs(previous), np.abs(next_one))
    for n in np.flatnonzero(off > np.maximum(STILL, FASTER * beside)).tolist():
        if time[n + 1] - time[n] > GAP * usual or not AROUND <= n < leap.size - AROUND:
            continue
        earlier, later = steps[n - AROUND : n], steps[n + 1 : n + 1 + AROUND]
        left, right = np.abs(earlier).max(), np.abs(later).max()
        pace = max(left, right)
        uneven = max(np.abs(np.diff(earlier)).max(), np.abs(np.diff(later)).max())
        if min(left, right) > 0.0:
            jumps = off[n] > max(FASTER * pace, LEAP * min(pace, uneven))
        else:  # between rests a small servo may well go like that, and does so at other times
            other = np.delete(leap, slice(n - AROUND, n + 1 + AROUND)).max(initial=0.0)
            jumps = leap[n] > UNSEEN * other > 0.0
        if jumps:
            after = '360 deg' if abs(leap[n] - TURN) <= 2.0 * pace else f'{leap[n]:.4g} rad'
            cause = (
                f'the reading begins anew: import it with wrap: {after} in its mapping'
                if leap[n] >= ALL * np.ptp(channel.value)
                else 'the clock jumped back and samples were lost, or the encoder miscounted'
            )
            words = (
                f'{channel.name} leaps by {leap[n]:.3g} rad between two samples at {time[n]:.3f} '
                f's: {cause}'
            )
            yield Break(float(time[n]), float(time[n + 1]), True, words)
