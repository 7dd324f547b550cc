"""
Pushes that nobody gave: a motor that for a while gives a part of the torque that it reports.

A supply that dips or a contact that slips in a plug looks like somebody who leans on the motor's
pulley for so long, and where that leaves too much, like a push and whatever else fits at that
motor. No effect of the catalogue is that; but what is missing is in proportion to the torque, and
a push is not.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bent import at_once
from tendon_ros.diagnose.bodies import turned
from tendon_ros.diagnose.form import TIE
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.residuals import SUDDEN

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

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
    own = float(state.left @ state.left)
    found: set[int] = set()
    asked: set[int] = set()
    for k, cause in enumerate(causes):
        sensor = torques.get(cause.place)
        if cause.effect != PUSH or sensor is None or sensor.channel not in channels or k in asked:
            continue
        moved = cause.place.removeprefix('pulley_')
        if not all(moved in s.prescribed for s in problem.rollouts.segments):
            continue  # the torque drives the model, and is not predicted
        # whatever happens to a motor at a time may happen in several recordings
        here = replace(cause, only='')
        pushes = {
            j
            for j, other in enumerate(causes)
            if (other.effect, other.place) == (PUSH, cause.place)
            and at_once((here, state.model.values(k)), (other, state.model.values(j)))
        }
        beside = {
            j
            for j, other in enumerate(causes)
            if j not in pushes and body.get(other.place, other.place) == cause.place
        }
        asked |= pushes
        then = _torque_about(problem, state, pushes, sensor.channel)
        # what laws get wrong elsewhere is no reason to hold pushes for as good
        equal = TIE * float(problem.sampled(then).sum())
        if _left_with_less(problem, state, pushes, pushes, then) < own - equal:
            found |= pushes
        elif beside and _left_with_less(problem, state, pushes, pushes | beside, then) <= own:
            found |= pushes | beside
    return frozenset(found)


def _torque_about(
    problem: Problem, state: Fit, pushes: Collection[int], channel: str
) -> list[BoolArray]:
    """Return which bins are of a torque at the time of pushes, (channels, bins) a segment."""
    found = []
    for s in problem.rollouts.segments:
        own = np.array([[m.sensor.channel == channel] for m in s.measured], dtype=np.bool_)
        then = np.zeros(len(s.time), dtype=np.bool_)
        for k in pushes:
            cause = state.model.causes[k]
            begun, ended = cause.changes(state.model.values(k))
            wider = WIDER * (ended - begun)
            near = (begun - wider <= s.time) & (s.time <= ended + wider)
            then |= near & cause.acts_in(s.name)
        found.append(own.reshape(-1, 1) & then)
    return found


def _left_with_less(
    problem: Problem,
    state: Fit,
    pushes: Collection[int],
    gone: Collection[int],
    then: Sequence[BoolArray],
) -> float:
    """Return the squares that stay if a motor gives less in the place of some causes."""
    # what the torque is then must not bend the rest, which all else then still holds
    rest = problem.leaving_out(then).fitted(state.model.without(*gone), rounds=6)
    left = problem.left(rest.model)
    known = problem.predicted(rest.model)
    there = problem.sampled(then)
    time = problem.sampled([s.time for s in problem.rollouts.segments])
    for _, _, span in problem.spans():
        own = np.flatnonzero(there[span]) + span.start
        left[own] = _with_less(left[own], known[own], time[own])
    for k in pushes:  # as it was beside the pushes
        problem.forgive(left, state.model.causes[k], state.model.values(k))
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
