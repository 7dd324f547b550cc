"""
Torque limits that excuse: nearly all torques pass them, and no motion tells what those were.

A fit lowers a limit to have ever more excused, until it means nothing, or lets it set in so early
that it bends all of a motor's torques. So it does with one that just overcomes what rubs at the
motor, which could do little but stand. None comes in like that but where all others leave ten
times as much.
"""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.bent import is_wide
from tendon_ros.diagnose.found import Rival
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.motor_gain import motor_gain
from tendon_ros.identify.untold import guesses_torque
from tendon_ros.model.effect_use import in_force

#: part of what all others leave that an excuse may leave which comes in
EXCUSED = 0.1
COULOMB = 'coulomb_friction'
#: times what rubs at its pulley that a motor which moves it gives at least
RUBS = 1.2
#: times what a motor usually gives to which a limit is raised that had sunk below
ABOVE = 1.05


def excuses(problem: Problem, model: Model, k: int) -> bool:
    """
    Return whether a cause is a torque limit that nearly all torques pass, or that bends them all.

    One that is there may sink while others join, since it may stand for a motor that gives way
    otherwise than by any limit. It is no cause then, but what joins would not be seen without it.

    :param problem: the data.
    :param model: causes.
    :param k: which of them.
    :return: whether.
    """
    cause = model.causes[k]
    if cause.effect != 'torque_saturation':
        return False
    values = model.values(k)
    # how much a motor gives of what it reports is known, or is another guess
    motor = cause.place.removeprefix('motor_')
    known = not guesses_torque(problem.rollouts.instrument, motor)
    return (known and is_wide(cause, values)) or values['limit'] < _least(problem, model, cause)


def _least(problem: Problem, model: Model, limit: Candidate) -> float:
    """Return the torque that a motor gives at the least if any limit cuts it off [N m]."""
    motor = limit.place.removeprefix('motor_')
    usual = problem.rollouts.usual(motor, motor_gain(problem, model, motor))
    return max(usual, RUBS * _rubs(problem, model, motor))


def _rubs(problem: Problem, model: Model, motor: str) -> float:
    """Return the constant friction at the pulley of a motor [N m]."""
    [pulley] = [m.pulley for m in problem.rollouts.instrument.motors if m.name == motor]
    uses = problem.uses(model)[0]
    own = in_force(problem.rollouts.instrument.effects, uses)
    found = 0.0
    for use in own:
        effect = find(use.effect)
        parts = ('torque',) if use.effect == COULOMB else effect.holds.get(COULOMB, ())
        if use.place == f'pulley_{pulley}' and parts:
            found += min(use.parameters[name] for name in parts)
    return found


def raised(problem: Problem, model: Model) -> Model:
    """
    Return a model whose limits are raised to where they excuse no more, and set in at once.

    :param problem: the data.
    :param model: causes.
    :return: the model; the same where no limit excuses.
    """
    found = model
    for cause in sorted(excused(problem, model)):
        limit = model.values(model.causes.index(cause))['limit']
        values = dict(find(cause.effect).typical) | {
            'limit': max(limit, ABOVE * _least(problem, model, cause))
        }
        found = found.without(found.causes.index(cause)).joined(cause, values)
    return found


def needs_excuse(problem: Problem, model: Model, k: int) -> bool:
    """
    Return whether a cause scales the torque of a motor whose limit excuses whatever it gives.

    The motor may then give ten times as much, and the misfit of its torque is as many times less.

    :param problem: the data.
    :param model: causes.
    :param k: which of them.
    :return: whether.
    """
    cause = model.causes[k]
    if cause.effect != 'torque_gain':
        return False
    return any(limit.place == cause.place for limit in excused(problem, model))


def excused(problem: Problem, model: Model) -> frozenset[Candidate]:
    """
    Return which causes of a model are such limits.

    :param problem: the data.
    :param model: causes.
    :return: those.
    """
    return frozenset(cause for k, cause in enumerate(model.causes) if excuses(problem, model, k))


def without_excuses(problem: Problem, state: Fit, rivals: Sequence[Rival]) -> list[Rival]:
    """
    Return the rivals that bring no excuse, and those that leave a part of what all others do.

    Of a motor that hardly ever gives what it reports, nothing else can be seen before.

    :param problem: the data.
    :param state: beside which they were fitted.
    :param rivals: all of them.
    :return: those, in their order.
    """
    stood = set(state.model.causes)
    brings = [bool(excused(problem, r.fit.model) - stood) for r in rivals]
    others = [r.fit.cost for r, new in zip(rivals, brings, strict=True) if not new]
    most = EXCUSED * min([state.cost, *others])
    return [r for r, new in zip(rivals, brings, strict=True) if not new or r.fit.cost < most]
