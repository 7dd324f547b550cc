"""
Pushes that nobody gave: a motor that for a while gives a part of the torque that it reports.

A supply that dips or a contact that slips in a plug looks like somebody who leans on the motor's
pulley for so long, and where that leaves too much, like a push and whatever else fits at that
motor. No effect of the catalogue is that; but what is missing is in proportion to the torque, and
a push is not.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bodies import turned
from tendon_ros.diagnose.form import tie
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.residuals import SUDDEN

FloatArray = NDArray[np.float64]

PUSH = 'disturbance'
#: part of a push's length that it may have begun earlier, or ended later
WIDER = 0.3
#: bins of which at least a motor gives less
BRIEF = 10
#: bins that are tried as ends of a stretch, at most: every pair of them is
ENDS = 256


def giving_less(problem: Problem, state: Fit) -> frozenset[int]:
    """
    Return the causes that a motor makes up which for a while gives less than it reports.

    :param problem: the data.
    :param state: with causes.
    :return: pushes on pulleys of such motors that do worse than a torque that is all the time the
        same part of the one reported; and who acts beside them at the motor, where such a part
        alone does as well as all of them.
    """
    body = turned(problem.rollouts.instrument)
    torques = {
        body[f'motor_{s.of}']: s
        for s in problem.rollouts.instrument.sensors
        if s.kind == 'motor_torque'
    }
    causes = state.model.causes
    channels = problem.channels()
    equal = tie(problem, state) * len(state.left)
    own = float(state.left @ state.left)
    found: set[int] = set()
    for k, cause in enumerate(causes):
        sensor = torques.get(cause.place)
        if cause.effect != PUSH or sensor is None or sensor.channel not in channels:
            continue
        moved = cause.place.removeprefix('pulley_')
        if not all(moved in s.prescribed for s in problem.rollouts.segments):
            continue  # the torque drives the model, and is not predicted
        beside = {
            j
            for j, other in enumerate(causes)
            if j != k and body.get(other.place, other.place) == cause.place
        }
        if _left_with_less(problem, state, k, {k}, sensor.channel) < own - equal:
            found.add(k)
        elif beside and _left_with_less(problem, state, k, {k} | beside, sensor.channel) <= own:
            found |= {k} | beside
    return frozenset(found)


def _left_with_less(
    problem: Problem, state: Fit, k: int, gone: Collection[int], channel: str
) -> float:
    """Return the squares that stay if a motor gives less in the place of some causes."""
    cause, values = state.model.causes[k], state.model.values(k)
    wider = WIDER * values['duration']
    first, last = values['start'] - wider, values['start'] + values['duration'] + wider
    segments = problem.rollouts.segments
    within = [(first <= s.time) & (s.time <= last) & cause.acts_in(s.name) for s in segments]
    # what happens then must not bend the rest
    rest = problem.leaving_out(within).fitted(state.model.without(*gone), rounds=6)
    left = problem.left(rest.model)
    known = problem.predicted(rest.model)
    there = problem.sampled(within)
    time = problem.sampled([s.time for s in segments])
    for n, c, span in problem.spans():
        if segments[n].measured[c].sensor.channel == channel and there[span].any():
            own = np.flatnonzero(there[span]) + span.start
            left[own] = _with_less(left[own], known[own], time[own])
    stays = float(left @ left)
    return stays if np.isfinite(stays) else np.inf


def _with_less(left: FloatArray, known: FloatArray, time: FloatArray) -> FloatArray:
    """Return what stays of a torque if in its best stretch a further part of it is reported."""
    if len(left) <= BRIEF:
        return left
    ends = np.unique(np.linspace(0, len(left), ENDS + 1).round().astype(np.intp))
    cross = np.concatenate([[0.0], np.cumsum(left * known)])[ends]
    power = np.concatenate([[0.0], np.cumsum(known * known)])[ends]
    # more is reported than acts: the part has the sign of the torque
    more = np.maximum(cross[None, :] - cross[:, None], 0.0)
    among = np.maximum(power[None, :] - power[:, None], 1e-12)
    saved = np.where(ends[None, :] - ends[:, None] >= BRIEF, more**2 / among, 0.0)
    first, last = ends[list(np.unravel_index(int(np.argmax(saved)), saved.shape))]
    # nor does it set in at once
    at_ends = [np.abs(time - time[at]) < SUDDEN for at in (first, last - 1)]
    near = np.logical_or(*at_ends)
    within = np.zeros(len(left), dtype=np.bool_)
    within[first:last] = True
    sure = within & ~near
    part = max(0.0, float(left[sure] @ known[sure])) / max(float(known[sure] @ known[sure]), 1e-12)
    stays = left - part * known * within
    return np.where(near, np.clip(stays, -2.0, 2.0), stays)
