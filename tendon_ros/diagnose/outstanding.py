"""
Events that stand out from all that laws get wrong.

A push that is fitted to one reversal explains most of what a friction leaves there, but friction
lets go a moment too early at other reversals, too. What happened once leaves more than that,
for as long as it lasts, and nothing else in the recordings leaves as much for as long.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: times what is left of any other stretch as long that an event leaves where it is not known
STANDS_OUT = 3.0
#: noise power that any stretch may leave
NOISE = 1.0
#: part of a stretch that has to be fitted for it to say anything
TOLD = 0.5


def stands_out_in_time(problem: Problem, without: Fit, state: Fit, event: Candidate) -> bool:
    """
    Return whether an event leaves far more than any other stretch of the recordings.

    :param problem: the data.
    :param without: a fit without it.
    :param state: with it, and all else.
    :param event: one of its causes, with a time.
    :return: whether: and no more once it is known.
    """
    values = state.model.values(state.model.causes.index(event))
    begun, *ended = event.changes(values)
    segments = problem.rollouts.segments
    happens = [
        (s.time >= begun) & (s.time < ended[0] if ended else True)
        if event.acts_in(s.name)
        else np.zeros(len(s.time), dtype=np.bool_)
        for s in segments
    ]
    seconds = max(s.period * float(own.sum()) for s, own in zip(segments, happens, strict=True))
    then, now = _power(problem, without.left), _power(problem, state.left)
    told = sum(float(count[own].sum()) for (_, count), own in zip(then, happens, strict=True))
    if told == 0.0:
        return False
    before, after = (
        sum(float(power[own].sum()) for (power, _), own in zip(rows, happens, strict=True)) / told
        for rows in (then, now)
    )
    elsewhere = [
        _means(power, count, own, round(seconds / s.period))
        for s, (power, count), own in zip(segments, now, happens, strict=True)
    ]
    means = np.concatenate(elsewhere)
    if not means.size:
        return False
    most = max(NOISE, float(means.max()))
    return before > STANDS_OUT * most and after <= most


def _power(problem: Problem, left: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """
    Return of each recording what neighbouring bins of all channels share, and how many they are.

    Friction that lets go leaves single spikes, which are no push. Of shape (bins,) each.
    """
    masks = problem.masks
    found = [(np.zeros(m.shape[1]), np.zeros(m.shape[1])) for m in masks]
    for n, c, own in problem.groups(left):
        power, count = found[n]
        at = np.flatnonzero(masks[n][c])[:-1]
        power[at] += own[:-1] * own[1:]
        count[at] += 1.0
    return found


def _means(power: FloatArray, count: FloatArray, happens: BoolArray, bins: int) -> FloatArray:
    """Return the means of all stretches of so many bins beside an event that tell anything."""
    if not 0 < bins <= len(power):
        return np.zeros(0)
    window = np.ones(bins)
    rows = power, count, happens.astype(np.float64)
    own, known, event = (np.convolve(row, window, mode='valid') for row in rows)
    tells = (event < 0.5) & (known > TOLD * bins * count.max(initial=0.0))
    return np.asarray(own[tells] / known[tells], dtype=np.float64)
