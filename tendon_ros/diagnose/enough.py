"""
Enough recordings: which of many a fit sees.

A hundred repetitions of one motion tell a fit no more than a few, and cost it a hundred times the
time. It sees those that differ most; all others judge what it has found.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import FITTED, Segment

KEPT = 4  # of so many recordings, or blocks of them, in a row one fewer is fitted
BLOCK = 1.5  # [s] of a block that is held out, longer than an instrument remembers a disturbance


def enough(segments: Sequence[Segment], shift: int = 0) -> set[int]:
    """
    Return which of many recordings are fitted.

    :param segments: the recordings.
    :param shift: any number for another choice.
    :return: their numbers: three of four, or those that differ most where these take too long.
    """
    every = range(len(segments))
    seconds = np.array([segment.time[-1] for segment in segments])
    three = {n for n in every if (n + shift) % KEPT != KEPT - 2}
    if seconds[sorted(three)].sum() <= FITTED:
        return three
    order = np.roll(_most_different_first(segments), -shift)
    count = max(2, int(np.searchsorted(np.cumsum(seconds[order]), FITTED, side='right')))
    return set(order[:count].tolist())


def _most_different_first(segments: Sequence[Segment]) -> NDArray[np.intp]:
    """Return the recordings in an order in which each is as far as can be from all before."""
    looks = [_look(segment) for segment in segments]
    names = sorted({name for look in looks for name in look})
    table = np.array([[look.get(name, np.nan) for name in names] for look in looks])
    there = np.isfinite(table)
    table -= np.nanmean(table, axis=0)
    # a channel that was not recorded is a difference of its own, its values are none
    table = np.hstack([np.where(there, table, 0.0), there])
    spread = table.std(axis=0)
    table = (table - table.mean(axis=0))[:, spread > 0.0] / spread[spread > 0.0]
    order = [int(np.argmax((table**2).sum(axis=1)))]
    far = ((table - table[order[0]]) ** 2).sum(axis=1)
    while len(order) < len(segments):
        far[order] = -1.0
        order.append(int(np.argmax(far)))
        far = np.minimum(far, ((table - table[order[-1]]) ** 2).sum(axis=1))
    return np.array(order, dtype=np.intp)


def _look(segment: Segment) -> dict[str, float]:
    """Return what tells recordings apart: how far and fast motors turn, and what sensors say."""
    found = {}
    driving = (*segment.prescribed, *segment.pushed)
    for name, value, slope in zip(
        driving, segment.motion.value, segment.motion.slope, strict=True
    ):
        found[f'{name} mean'] = float(value.mean())
        found[f'{name} range'] = float(value.std())
        found[f'{name} speed'] = float(np.abs(slope).mean())
    for measured in segment.measured:
        known = measured.value[np.isfinite(measured.value)]
        if known.size:
            found[f'{measured.sensor.name} mean'] = float(known.mean())
            found[f'{measured.sensor.name} range'] = float(known.std())
    return found
