"""What a logger makes of sound sensors: registers read one after the other, counts cut off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed
from tendon_ros.diagnose.bent import COUNTED
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.waves import travel

FloatArray = NDArray[np.float64]

#: of the time between samples within which a delay is the logger's, which reads one register after
#: the other
POLLED = 0.5
#: part of what an angle that is off does, as power, that is the same as what a count does
ALIKE = 0.8
DELAY, ZERO, GAIN = 'sensor_delay', 'encoder_offset', 'encoder_gain'


def is_logged(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a cause may be what a logger makes of a sound sensor.

    :param problem: the data.
    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether it is a delay below half of the time between samples, an angle that is off by
        a count or so, or a scale that is over all that it turns, all from what the file says: a
        counter that leaves out the rest reads half a count less. So does whatever a motor turns
        whose counter does.
    """
    if candidate.effect not in (DELAY, ZERO, GAIN):
        return False
    known = candidate.as_given
    [off] = [abs(values[p] - known[p]) for p in ('time', 'angle', 'gain') if p in known]
    if candidate.effect == DELAY:
        return off < POLLED * max(s.sampling for s in problem.rollouts.segments)
    instrument = problem.rollouts.instrument
    counts = {s.name: s.resolution for s in instrument.sensors if s.kind == 'angle'}
    if candidate.effect == GAIN:
        return off * _turned(problem, candidate.place) < COUNTED * counts[candidate.place]
    if off < COUNTED * counts[candidate.place]:
        return True
    motors = [d.sensor.name for d in drives(instrument) if not d.by_torque]
    does = _change(problem, candidate, values)
    return any(
        _within(does, _change(problem, Candidate(ZERO, name), {'angle': counts[name]}))
        for name in motors
        if name != candidate.place and counts.get(name, 0.0) > 0.0
    )


def _turned(problem: Problem, encoder: str) -> float:
    """Return how far what an encoder reads turned [rad]."""
    [of] = [s.of for s in problem.rollouts.instrument.sensors if s.name == encoder]
    driven = travel(problem, of)
    if driven is not None:
        return driven
    read = [
        float(np.nanmax(m.value) - np.nanmin(m.value))
        for segment in problem.rollouts.segments
        for m in segment.measured
        if m.sensor.name == encoder and np.isfinite(m.value).any()
    ]
    return max(read, default=0.0)


def _change(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> FloatArray:
    """Return what an effect does to each sample, in noise deviations."""
    begun = problem.begun
    return problem.left(begun.joined(candidate, values)) - problem.left(begun)


def _within(does: FloatArray, count: FloatArray) -> bool:
    """Return whether a change is what a count or so makes, for most of it."""
    square, whole = float(count @ count), float(does @ does)
    if not (square > 0.0 and whole > 0.0):
        return False
    pull = float(does @ count)
    return abs(pull) < COUNTED * square and pull**2 > ALIKE * square * whole


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
        elif 'gain' in values:
            off = f'{place} reads {values["gain"]:.5g} times its angle'
            said.append(f'{off}, over all that it turns a count of it or so')
        else:
            off = f'{place} reads {1e3 * values["angle"]:.2g} mrad off'
            said.append(f'{off}, a count of the encoders or so')
    return f'{listed(said)}: as much as a logger makes of a sound sensor, so it is used, not named'
