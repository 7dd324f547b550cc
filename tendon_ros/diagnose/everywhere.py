"""
All at once: friction, play, springs and zeros wherever they can be, as a place to begin from.

Where inertia, stiffness and preload of a mechanism are guesses, the first cause that is found
drags them to where it does best alone, and whatever comes next is judged from there. Every real
transmission rubs in each of its bearings, has play in its couplings and something that pulls it
back. Begun with all of that, guesses have no reason to go astray; what is not needed goes again.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

from tendon_ros.diagnose.cancelling import undoing
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.worth import needed
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.first_order_worth import growth
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.multistart import swings
from tendon_ros.identify.tied import tied

#: what every real transmission has; laws that hold these are tried later, in their place
USUAL = ('coulomb_friction', 'tension_friction', 'backlash', 'joint_spring', 'load_cell_bias')
#: those of them that are linear: they need no size to leave a trace
LINEAR = ('joint_spring', 'load_cell_bias')
#: parts of what is typical that the others have at first: of several ways one may end early
BEGINNINGS = (1.0, 0.3)
#: places from which it is begun where torque drives
FOLLOWED = 3
#: power a sample, of what stays of channels, that is nothing
NOTHING = 0.01
#: times the cost that one of several which undo each other may leave where all leave it
LITTLE_MORE = 1.5
#: rounds of the fit of all of it: from typical sizes the way is long. The best one goes on by as
#: many, up to so many times, as long as it comes to leave less than such a part of what it left
FAR, STAGES, GAINS = 12, 5, 0.9
#: rounds of fits that tell what is missed, with derivatives as they are, and of those with less
GLANCE, ROUNDS = 4, 8


def everywhere(candidates: Sequence[Candidate], model: Model, part: float) -> Model:
    """
    Return a model with all that transmissions usually have.

    :param candidates: all that may be named.
    :param model: where the numbers of the file are, and what is known already.
    :param part: of what is typical, for sizes of what has a threshold.
    :return: the model with more causes.
    """
    known = {(c.effect, c.place) for c in model.causes}
    for candidate in candidates:
        # what a load cell reads is what pushes: its zero is not to be had beside all else
        if candidate.place == 'load_cell' or (candidate.effect, candidate.place) in known:
            continue
        if candidate.effect in USUAL:
            sized = 0.0 if candidate.effect in LINEAR else part
            values = {
                p.name: p.typical if p.is_shape else p.neutral + sized * (p.typical - p.neutral)
                for p in candidate.parameters
            }
            model = model.joined(candidate, values)
    return model


def thinned_out(steps: Steps, start: Fit, most: int, known: Model | None = None) -> Fit | None:
    """
    Return what is needed of all that transmissions usually have.

    :param steps: of the search.
    :param start: without any cause.
    :param most: causes that may stay.
    :param known: what was found already; None to begin with the file.
    :return: the fit; None where the model with all of it diverges.
    """
    problem = steps.problem
    before = problem.begun if known is None else known

    def all_of(part: float) -> Model:
        return everywhere(steps.candidates, before, part)

    if swings(problem):
        begun = tied(problem, lambda sizes: all_of(*sizes))[:FOLLOWED]
    else:
        begun = list(map(all_of, BEGINNINGS))
    # the way is long, and rollouts with all of it are slow
    rougher = problem.rougher()
    rough = steps.pool.map(lambda m: rougher.fitted(m, rounds=FAR, accuracy=1e-2), begun)
    best = min(rough, key=lambda fit: fit.cost, default=None)
    if best is None:
        return None
    state = _to_its_end(rougher, best)
    while (single := _unopposed(steps, rougher, state)) is not None:
        state = single
    nothing = rougher.fitted(start.model, rounds=0)
    while math.isfinite(state.cost):
        smaller = _idle_dropped(rougher, state, needed(rougher, nothing, state))
        if smaller is None and len(state.model.causes) > most:
            smaller = _least_dropped(steps, rougher, state)
        if smaller is None:
            break
        state = rougher.fitted(smaller.model, rounds=ROUNDS, accuracy=1e-2)
    state = problem.fitted(state.model, rounds=ROUNDS, accuracy=1e-2)
    return steps.settled(state.model) if math.isfinite(state.cost) else None


def _to_its_end(problem: Problem, state: Fit) -> Fit:
    """
    Follow the fit of all of it to about its end: what goes before goes by chance.

    Threshold after threshold bends the way; each stage takes all derivatives anew.

    :param problem: the data.
    :param state: with all that is usual.
    :return: the better fit.
    """
    for _ in range(STAGES):
        before, state = state, problem.fitted(state.model, rounds=FAR, accuracy=1e-3)
        if not state.cost < GAINS * before.cost:
            break
    return state


def without_idle(steps: Steps, state: Fit) -> Fit:
    """
    Return a state without the causes of which nothing is missed.

    What was needed while channels weighed by their noise may be worth nothing by other weights.

    :param steps: of the search.
    :param state: with causes.
    :return: with those that are worth anything.
    """
    least = NOTHING * len(state.left)
    found = state
    while (smaller := _least_dropped(steps, steps.problem, found)) is not None:
        if not smaller.cost < found.cost + least:
            break
        found = smaller
    return state if found is state else steps.settled(found.model)


def _unopposed(steps: Steps, problem: Problem, state: Fit) -> Fit | None:
    """
    Return a state without one of several causes that undo each other, if it leaves little more.

    Two springs of one cable that are far from rest, one this way and one that, shift its force;
    what rubs in its bearings has gone before they do, since each is missed badly alone.

    :param steps: of the search.
    :param problem: the data that were fitted.
    :param state: with all that is usual.
    :return: the state; None where nothing is undone, or needs to be.
    """
    group = undoing(problem, state) if math.isfinite(state.cost) else frozenset()
    if not group:
        return None
    trials = steps.pool.map(lambda k: _glanced(problem, state, [k]), sorted(group))
    best = min(trials, key=lambda fit: fit.cost)
    ended = problem.fitted(best.model, rounds=ROUNDS, accuracy=1e-2)
    return ended if ended.cost < LITTLE_MORE * state.cost else None


def _idle_dropped(problem: Problem, state: Fit, least: float) -> Fit | None:
    """
    Return a state without the causes whose loss together is small; None where each is needed.

    First order sees no threshold: a friction of few mN m may be what tells on which side of a play
    the load lies. So a fit decides, and where it misses them, half of them are left out.
    """
    grows = growth(problem, state)
    idle: list[int] = []
    rest = list(range(len(state.model.causes)))
    while rest:
        loss, next_one = min((grows([*idle, k]), k) for k in rest)
        if loss > least:
            break
        idle.append(next_one)
        rest.remove(next_one)
    while idle:
        smaller = _glanced(problem, state, idle)
        if smaller.cost < state.cost + least:
            return smaller
        idle = idle[: len(idle) // 2]
    return None


def _least_dropped(steps: Steps, problem: Problem, state: Fit) -> Fit | None:
    """Return a state without the cause that is missed least."""
    each = range(len(state.model.causes))
    trials = steps.pool.map(lambda k: _glanced(problem, state, [k]), each)
    return min(trials, key=lambda fit: fit.cost, default=None)


def _glanced(problem: Problem, state: Fit, gone: Sequence[int]) -> Fit:
    """Return a state without some causes, fitted with the derivatives that are known."""
    return problem.fitted(
        state.model.without(*gone), problem.slopes(state), rounds=GLANCE, accuracy=1e-2
    )
