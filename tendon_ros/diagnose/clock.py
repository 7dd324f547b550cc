"""
Delays are told against each other: what many sensors share is the clock's.

No sensor is early, and yet one may look so: a torque that is reported when it is asked for, while
the drive still lags behind, or a stamp that is set too soon. All others are then late, by the same
time, and none of them is at fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

#: part of a delay by which those that are one may differ
SHARED = 0.2


@dataclass(frozen=True)
class Early:
    """
    Sensors of one kind that are ahead of all others.

    ``sensors``: their names; ``time``: by how much [s]; ``late``: which causes say so.
    """

    sensors: tuple[str, ...]
    time: float
    late: frozenset[int]


def told_apart(problem: Problem, model: Model) -> Model | None:
    """
    Return a model without what all sensors are late by, where every one is: it is the clock's.

    :param problem: the data.
    :param model: causes.
    :return: without the smallest delay, the others less by it; None where some sensor is on time,
        or only filtered.
    """
    late = _late(model)
    if not _kinds(problem).keys() <= {model.causes[k].place for k in late}:
        return None
    # what a filter makes late is its own
    filters = {k: time * model.values(k).get('filtered', 0.0) for k, time in late.items()}
    dead = {k: time - filters[k] for k, time in late.items()}
    shared = min(dead, key=lambda k: dead[k])
    if not dead[shared] > 0.0:
        return None
    apart = model.without(*late)
    for k in sorted(late):
        rest = late[k] - dead[shared]
        if rest > 0.0:
            stays = {'time': rest, 'filtered': filters[k] / rest}
            apart = apart.joined(model.causes[k], model.values(k) | stays)
    return apart


def early(problem: Problem, model: Model) -> Early | None:
    """
    Return who is early where all other sensors are late by the same time.

    :param problem: the data.
    :param model: causes.
    :return: sensors of one kind, fewer than the others, which are of several kinds; None where
        nobody is.
    """
    kinds = _kinds(problem)
    late = _late(model)
    if len(late) < 2:
        return None
    behind = {model.causes[k].place for k in late}
    ahead = sorted(kinds.keys() - behind)
    times = np.array(list(late.values()))
    time = float(np.median(times))
    alike = bool(np.all(np.abs(times - time) <= SHARED * time))
    # all encoders may come late by one bus, and all torques: only who is alone among unlike ones
    alone = len({kinds[s] for s in ahead}) == 1 and len({kinds[s] for s in behind}) > 1
    if not alike or not alone or len(ahead) >= len(behind):
        return None
    return Early(tuple(ahead), time, frozenset(late))


def early_words(found: Early) -> str:
    """
    Say who is early.

    :param found: sensors that are ahead of all others.
    :return: a sentence for the report.
    """
    who = ', '.join(found.sensors)
    return (
        f'all sensors but {who} are late by {1e3 * found.time:.0f} ms, which is as much as to say '
        f'that {who} is early: its stamps, or what it reports lags behind when it says so, as the '
        'torque of a slow drive; no delay is named'
    )


def _late(model: Model) -> Mapping[int, float]:
    """Return the delays of a model [s], by which cause it is."""
    causes = enumerate(model.causes)
    return {k: model.values(k)['time'] for k, c in causes if c.effect == 'sensor_delay'}


def _kinds(problem: Problem) -> dict[str, str]:
    """Return what each sensor measures, by its name, whether it is predicted or drives."""
    rollouts = problem.rollouts
    sensors = [m.sensor for s in rollouts.segments for m in s.measured]
    sensors += [d.sensor for d in drives(rollouts.instrument)]
    return {s.name: s.kind for s in sensors}
