"""What a logger makes of sound sensors: registers read one after the other, counts cut off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tendon_ros.base.errors import listed
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

#: of the time between samples within which a delay is the logger's, which reads one register after
#: the other
POLLED = 0.5


def is_logged(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a cause may be what a logger makes of a sound sensor.

    :param problem: the data.
    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether it is a delay below half of the time between samples, or an angle that is off
        within a count: a counter that leaves out the rest reads half a count less.
    """
    if candidate.effect == 'sensor_delay':
        return values['time'] < POLLED * max(s.sampling for s in problem.rollouts.segments)
    if candidate.effect != 'encoder_offset':
        return False
    sensors = problem.rollouts.instrument.sensors
    counts = {s.name: s.resolution for s in sensors if s.kind == 'angle'}
    return abs(values['angle']) < counts.get(candidate.place, 0.0)


def logged_words(model: Model, which: Sequence[int]) -> str:
    """
    Say who is off by no more than a logger makes it.

    :param model: causes.
    :param which: of them.
    :return: a sentence for the report.
    """
    said = []
    for k in which:
        place, values = model.causes[k].place, model.values(k)
        if 'time' in values:
            late = f'{place} is late by {1e3 * values["time"]:.1f} ms'
            said.append(f'{late}, less than half of the time between samples')
        else:
            said.append(f'{place} reads {1e3 * values["angle"]:.2g} mrad off, within a count')
    return f'{listed(said)}: as much as a logger makes of a sound sensor, so it is used, not named'
