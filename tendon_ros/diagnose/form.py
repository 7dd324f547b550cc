"""
The form of laws: no effect of the catalogue is quite what a machine does.

What the right cause may leave, when two explanations are equal, and when a fit has bent one effect
into another, all follow from how far laws may be from machines.
"""

from __future__ import annotations

from collections.abc import Mapping
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.starting import BEGUN, between_recordings, LASTS
from tendon_ros.identify.sticking import sticking
from tendon_ros.identify.worths import worths
from tendon_ros.model.instrument import EffectUse

FloatArray = NDArray[np.float64]

#: misfit beyond the best, in noise power per sample, within which two explanations are equal;
#: and the same as a part of the structure that the best leaves
TIE, TIE_FORM = 0.015, 0.5
#: form of dry friction on a driven pulley, whose motion is known to a count: it turns within less
COUNTED = 0.1
#: part of dry friction that may have gone while a pulley sticks: a motor that trembles within a
#: count lets it creep away
HELD = 0.3
#: periods of the controllers within which a delay is theirs
HOLDS = 0.75
#: waves of a ripple that a motor has to pass
SEEN = 0.5
#: events nearer to each other than this are one [s]
AT_ONCE = 0.5


def form_power(problem: Problem, start: Fit, state: Fit, *, resting: bool = True) -> float:
    """
    Return what the laws of causes, and of the file's effects, may leave although they are right.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them.
    :param resting: whether friction that holds may have crept away: it is no reason to doubt the
        friction, but what it leaves is left.
    :return: in noise power per sample.
    """
    profile = form_profile(problem, start, state, resting=resting)
    return own_power(problem, start) + float(np.mean(profile))


def form_profile(problem: Problem, start: Fit, state: Fit, *, resting: bool = True) -> FloatArray:
    """
    Return where and when the laws of the causes may be wrong: where they explain much.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them.
    :param resting: as for :func:`form_power`.
    :return: noise power that each sample may keep although the causes are right, shape (samples,).
    """
    found = np.zeros(len(state.left))
    causes = state.model.causes
    if not causes:
        return found
    explained = max(0.0, start.cost - state.cost) / len(state.left)
    # what each is worth beside the others; what they share is shared out
    worth = np.minimum(np.array(worths(problem, state)) / len(state.left), explained)
    worth *= max(1.0, explained / max(float(worth.sum()), 1e-12))
    held = sticking(problem, state) if resting else [None] * len(causes)
    for k, cause in enumerate(causes):
        power = _change(problem, state, k) ** 2
        form = np.full(len(found), _form(problem, cause.effect, cause.place) ** 2)
        if held[k] is not None:
            form[held[k]] += HELD**2
        shared = min(float(worth[k]), explained) / max(float(np.mean(power)), 1e-12)
        found += form * power * shared
    return found


def _change(problem: Problem, state: Fit, k: int) -> FloatArray:
    """Return what a cause does to each sample, to first order where it has sizes."""
    cause = state.model.causes[k]
    at = sum(len(c.parameters) for c in state.model.causes[:k])
    own = [at + n for n in cause.coordinates.sizes]
    if own:
        return np.asarray(state.slope[:, own] @ problem.pack(state.model)[own])
    return problem.left(state.model.without(k)) - state.left


def _form(problem: Problem, effect: str, place: str) -> float:
    """Return which part of what an effect does at a place its law may get wrong."""
    known = find(effect)
    driven = {f'pulley_{name}' for name in problem.rollouts.instrument.driven}
    return max(known.form, COUNTED) if known.hook == 'budget' and place in driven else known.form


#: of each problem, the state that was asked about last, and what the file's effects may leave
_OWN: WeakKeyDictionary[Problem, tuple[Fit, float]] = WeakKeyDictionary()


def own_power(problem: Problem, start: Fit) -> float:
    """
    Return what the laws of the file's own effects may leave.

    :param problem: the data.
    :param start: without any cause.
    :return: in noise power per sample.
    """
    known = _OWN.get(problem)
    if known is None or known[0] is not start:
        known = _OWN[problem] = start, _left_by_own(problem, start)
    return known[1]


def _left_by_own(problem: Problem, start: Fit) -> float:
    instrument = problem.rollouts.instrument
    uses = problem.uses(start.model)
    measured = problem.rollouts.measured
    found = 0.0
    for own in instrument.effects:
        gone = EffectUse(own.effect, own.place, find(own.effect).neutral, instead=True)
        predicted = problem.rollouts.predicted([[*row, gone] for row in uses])
        left = problem.flat([m - p for m, p in zip(measured, predicted, strict=True)])
        grown = float(left @ left - start.left @ start.left) / max(len(left), 1)
        if np.isfinite(grown):
            found += max(0.0, grown) * _form(problem, own.effect, own.place) ** 2
    return found


def tie(problem: Problem, best: Fit) -> float:
    """
    Return the misfit beyond the best within which two explanations are equal.

    What the best leaves shows how far laws and machine are apart here: so much may be luck.

    :param problem: the data.
    :param best: the best.
    :return: in noise power per sample.
    """
    return TIE + TIE_FORM * problem.structured(best.left)


def degenerate(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a fit has bent an effect into something else.

    :param problem: the data.
    :param candidate: the effect.
    :param values: of its parameters.
    :return: whether: into another effect that has a name of its own, an event that always lasts,
        a delay that a controller's hold makes, a ripple of which not half a wave was seen, a
        number of the file within its tolerance.
    """
    for t in problem.tolerances:
        if t.is_moved_by(candidate):
            value = values[t.parameter]
            return t.axis.low < value < t.axis.high
    # a controller holds its torque for a period, on average half of one too long
    held = HOLDS * problem.rollouts.instrument.control_period
    if candidate.effect == 'sensor_delay' and values['time'] < held:
        return True
    longest = max(float(s.time[-1]) for s in problem.rollouts.segments)
    # what has been there from the first in one of several recordings happened between them
    between = between_recordings(problem, candidate)
    for p in candidate.parameters:
        if p.search == 'instant':
            at = values[p.name] / longest
            if at > 1.0 - BEGUN or (at < BEGUN and not between):
                return True
        if p.search == 'duration' and values[p.name] > LASTS * longest:
            return True
        if p.search == 'cycles' and values[p.name] * _turned(problem, candidate.place) < SEEN:
            return True
    return simpler(candidate, values) is not None


def _turned(problem: Problem, place: str) -> float:
    """Return how far a motor turned in any recording, in turns; one where nothing tells."""
    motors = problem.rollouts.instrument.motors
    pulleys = [m.pulley for m in motors if f'motor_{m.name}' == place]
    travels = [
        float(np.ptp(segment.motion.value[segment.prescribed.index(pulley)]))
        for segment in problem.rollouts.segments
        for pulley in pulleys
        if pulley in segment.prescribed
    ]
    return max(travels) / (2.0 * np.pi) if travels else 1.0


def simpler(
    candidate: Candidate, values: Mapping[str, float]
) -> tuple[Candidate, dict[str, float]] | None:
    """
    Return the simpler effect that parameters make of an effect.

    :param candidate: the effect.
    :param values: of its parameters.
    :return: the other effect at the same place, with its parameters; None where there is none.
    """
    other = find(candidate.effect).other
    found = None if other is None else other(**values)
    if found is None:
        return None
    name, parameters = found
    return Candidate(name, candidate.place), parameters


def least_late(problem: Problem, model: Model) -> int | None:
    """
    Return the smallest delay where every sensor has one: what all share is the clock's.

    :param problem: the data.
    :param model: causes.
    :return: which cause; None where some sensor is on time.
    """
    rollouts = problem.rollouts
    sensors = {m.sensor.name for s in rollouts.segments for m in s.measured}
    sensors |= {d.sensor.name for d in drives(rollouts.instrument)}
    late = {k: c.place for k, c in enumerate(model.causes) if c.effect == 'sensor_delay'}
    if not sensors <= set(late.values()):
        return None
    return min(late, key=lambda k: model.values(k)['time'])


def at_once(
    one: tuple[Candidate, Mapping[str, float]], other: tuple[Candidate, Mapping[str, float]]
) -> bool:
    """
    Return whether two events are at the same time: no push is quite the one of its law.

    :param one: an effect with its parameters.
    :param other: another one.
    :return: whether both are events that may be one, in the same recording.
    """
    first, second = _span(*one), _span(*other)
    if first is None or second is None:
        return False
    if one[0].only != other[0].only and one[0].only and other[0].only:
        return False
    return first[0] - AT_ONCE < second[1] and second[0] - AT_ONCE < first[1]


def _span(candidate: Candidate, values: Mapping[str, float]) -> tuple[float, float] | None:
    """Return begin and end of an event [s]; None of what lasts."""
    begun = [values[p.name] for p in candidate.instants]
    if not begun:
        return None
    return begun[0], begun[0] + sum(
        values[p.name] for p in candidate.parameters if p.search == 'duration'
    )
