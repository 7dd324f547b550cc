"""
Effects that fits have bent into others, and causes that are one.

A fit knows no names: it turns a creep that is over at once into a softer cable, a ripple without a
wave into gravity, one push into a push and a slip.
"""

from __future__ import annotations

from collections.abc import Mapping
import math

import numpy as np

from tendon_ros.base.parameter import Parameter
from tendon_ros.diagnose.parts import simpler
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.starting import BEGUN, between_recordings, LASTS
from tendon_ros.identify.waves import shows, travel
from tendon_ros.model.numbers import place_index

#: periods of the controllers within which a delay is theirs
HOLDS = 0.75
#: counts of encoders up to which a play of a motor, or an angle that is off, may be what they
#: make: several counters may each cut off half a one
COUNTED = 1.5
#: part of a driven pulley's travel over which friction builds up at most: what yields no sooner is
#: a spring
YIELDS = 0.25
#: [rad] that no joint turns, and times as far as anything turns, if that is farther: a spring that
#: is relaxed beyond is a constant torque
TURN, BEYOND = 2.0 * math.pi, 2.0
#: part of static friction that slides at least, where nothing else rubs
GONE = 0.05
#: times a factor may still go before its bound, where it is as good as there
SPENT = 1.5
#: part of the widest knee of a torque limit, or of the bound of an amplitude, from which on it is
#: as wide as it may be
WIDE = 0.98
#: times its inertia that no body has by mistake
OVER = 10.0
#: times its angle that an encoder reads at most, and times less than its inertia that a body has
#: by a diameter taken for a radius: more may have been mounted on it. By a tenth an encoder is off
#: where a lever is not what it should be; further, it was taken for something else, a unit, say
MISCOUNTED, MISTAKEN = 1.25, 4.0
#: events nearer to each other than this are one [s]
AT_ONCE = 0.5


def degenerate(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a fit has bent an effect into something else.

    :param problem: the data.
    :param candidate: the effect.
    :param values: of its parameters.
    :return: whether: into another effect that has a name of its own, an event that always lasts,
        a delay that a controller's hold makes, a ripple of which not half a wave was
        seen, friction or a loop that never yields, a number of the file within its tolerance.
    """
    if _is_tolerated(problem, candidate, values):
        return True
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
        if p.search == 'cycles' and not shows(problem, candidate.place, values[p.name]):
            return True
    if candidate.effect == 'presliding_friction':
        far = travel(problem, candidate.place.removeprefix('pulley_'))
        if far is not None and values['angle'] > YIELDS * far:
            return True
    if candidate.effect == 'cable_hysteresis':
        _, cable = place_index(problem.rollouts.instrument, candidate.place)
        # a loop that has no room to turn in is a line
        if values['elongation'] > problem.rollouts.stretches[cable]:
            return True
    return (simpler(candidate, values) or biased(problem, candidate, values)) is not None


def _is_tolerated(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """Return whether numbers of the file, all that an effect moves, are within tolerances."""
    own = {t.parameter: t.axis for t in problem.tolerances if t.is_moved_by(candidate)}
    return bool(own) and all(
        p.name in own and own[p.name].low < values[p.name] < own[p.name].high
        for p in candidate.parameters
    )


def is_counted(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a play may be one that the counts of its motor's encoder make.

    Where a motor turns, within a count, is not seen, and what yields there with it lags.

    :param problem: the data.
    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether it is a play at a motor, hardly wider than a count.
    """
    if candidate.effect != 'backlash':
        return False
    counts = {
        f'motor_{drive.motor}': drive.sensor.resolution
        for drive in drives(problem.rollouts.instrument)
        if not drive.by_torque
    }
    return values['angle'] < COUNTED * counts.get(candidate.place, 0.0)


def is_constant(problem: Problem, candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a spring is a constant torque, which no effect on a pulley is.

    :param problem: the data.
    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether.
    """
    if candidate.effect != 'joint_spring':
        return False
    angles = [np.abs(segment.motion.value) for segment in problem.rollouts.segments]
    turned = max((float(a.max()) for a in angles if a.size), default=0.0)
    return abs(values['rest']) > max(TURN, BEYOND * turned)


def vanishes(problem: Problem, model: Model, k: int) -> bool:
    """
    Return whether a cause is friction that is gone once anything moves, and nothing else rubs.

    It holds whatever a resting motor reports and does nothing else: so a limit that nobody knows
    of is told, or a push. Machines rub in motion by a third and more of what they hold with.

    :param problem: the data.
    :param model: causes.
    :param k: which of them.
    :return: whether.
    """
    cause, values = model.causes[k], model.values(k)
    if cause.effect != 'stribeck_friction' or values['sliding'] > GONE * values['static']:
        return False
    rubbing = {c.place for n, c in enumerate(model.causes) if n != k and c.dry}
    own = problem.rollouts.instrument.effects
    rubbing |= {use.place for use in own if find(use.effect).dry}
    return cause.place not in rubbing


def spent(candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a parameter is at its bound: no value that it could have tells what is there.

    A play that rattles is told as a coupling fifty times too soft, and bodies as light as nothing;
    a cell of another gain as a pulley that runs out by a fifth of its radius; a supply that falls
    under load as a limit that sets in long before anything is cut off.

    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether.
    """
    return any(ends(candidate, values) for ends in (is_wide, at_bound, overweight))


def at_bound(candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a factor is nearly at its bound, or an angle or amplitude at it.

    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether.
    """
    return any(_is_at_bound(p, values[p.name]) for p in candidate.parameters if not p.is_shape)


def overweight(candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a body would have ten times its inertia or more, or a tenth or less.

    Nobody takes a body for another of that much: a motor that lags is told like that.

    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether.
    """
    return candidate.effect == 'inertia' and not 1.0 / OVER < values['scale'] < OVER


def far_fetched(candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether an encoder or a body would be further off than any is but by mistake.

    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether, from what the file says.
    """
    known = candidate.as_given
    if candidate.effect == 'encoder_gain':
        return not 1.0 / MISCOUNTED < values['gain'] / known['gain'] < MISCOUNTED
    if candidate.effect == 'inertia':
        return values['scale'] / known['scale'] <= 1.0 / MISTAKEN
    return False


def _is_at_bound(parameter: Parameter, value: float) -> bool:
    if parameter.neutral == 1.0:
        return parameter.low > 0.0 and not parameter.low * SPENT < value < parameter.high / SPENT
    # torques and forces end beyond any machine, and what is later than a delay's bound is late
    ends = parameter.unit in ('1', 'rad') and parameter.search != 'switch'
    return ends and abs(value) > WIDE * parameter.high


def is_wide(candidate: Candidate, values: Mapping[str, float]) -> bool:
    """
    Return whether a limit sets in long before anything is cut off.

    :param candidate: an effect.
    :param values: of its parameters.
    :return: whether.
    """
    return candidate.effect == 'torque_saturation' and any(
        values[p.name] > WIDE * p.high for p in candidate.parameters if p.name == 'knee'
    )


def biased(
    problem: Problem, candidate: Candidate, values: Mapping[str, float]
) -> tuple[Candidate, dict[str, float]] | None:
    """
    Return the bias of a motor that a constant torque on its pulley is.

    :param problem: the data.
    :param candidate: an effect.
    :param values: of its parameters.
    :return: the bias with its torque; None where it is something else.
    """
    if not is_constant(problem, candidate, values):
        return None
    for motor in problem.rollouts.instrument.motors:
        if candidate.place == f'pulley_{motor.pulley}':
            torque = values['stiffness'] * values['rest']
            return Candidate('torque_bias', f'motor_{motor.name}'), {'torque': torque}
    return None


def at_once(
    one: tuple[Candidate, Mapping[str, float]], other: tuple[Candidate, Mapping[str, float]]
) -> bool:
    """
    Return whether two events are at the same time: no push is quite the one of its law.

    :param one: an effect with its parameters.
    :param other: another one.
    :return: whether both are events that may be one, in the same recording.
    """
    first, second = (candidate.changes(values) for candidate, values in (one, other))
    if not first or not second:
        return False
    if one[0].only != other[0].only and one[0].only and other[0].only:
        return False
    return first[0] - AT_ONCE < second[-1] and second[0] - AT_ONCE < first[-1]
