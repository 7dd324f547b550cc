"""Rivals of a cause: which of them come near, and what may hold one of them back."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from tendon_ros.diagnose.form import tie
from tendon_ros.diagnose.found import Found, judged_cost, Rival
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.first_order_worth import worths
from tendon_ros.identify.fit import Fit, Problem, UNTIMED

#: part of what a cause explains that a rival which is close may leave; and where channels weigh by
#: what stays of them, since less of that is noise
LEAVES, WEIGHED = 0.1, 0.05
CLOSE = 6  # rivals that are fitted as carefully as the cause itself
BETTER = 0.99  # part of the cost that what is no simpler must leave
CREEPING = 20  # rounds at most in which a fit comes to its end
#: a weight that hangs is a spring of which far angles tell it
LEAD_BACK = {'gravity', 'joint_spring'}
#: of those that are worth least beside a rival, how many may have stood for it
SUSPECTS = 2


def halfway(state: Fit, without: Fit, rivals: Sequence[Rival]) -> list[Candidate]:
    """
    Return the rivals that make up for more than half of a cause.

    :param state: with the cause.
    :param without: without it.
    :param rivals: fits of others in its place.
    :return: who they are, in the order of the rivals.
    """
    half = 0.5 * (state.cost + without.cost)
    return [r.candidate for r in rivals if r.fit.cost < half]


def alike(one: Candidate, two: Candidate) -> bool:
    """
    Return whether two candidates are different dry frictions of one pulley, or both lead it back.

    :param one: a candidate.
    :param two: another.
    :return: whether.
    """
    dry = one.dry and two.dry
    back = {one.effect, two.effect} == LEAD_BACK
    return (dry or back) and one.place == two.place and one.effect != two.effect


def bared(problem: Problem, state: Fit, k: int) -> Fit | None:
    """
    Return a state as it is without one of its causes, nothing else moved.

    What a rival would have to do there is all that the cause does. Fitted again without it, the
    others may go to a valley from which no rival finds back.

    :param problem: the data.
    :param state: with the cause.
    :param k: which cause.
    :return: the rest with the derivatives of the state; None where it cannot be computed.
    """
    rest = state.model.without(k)
    left = problem.left(rest)
    if not np.isfinite(left).all():
        return None
    known = problem.slopes(state)
    nothing = np.zeros(len(left))
    slope = np.stack([known.get(label, nothing) for label in problem.labels(rest)], axis=1)
    held = problem.prior(rest) @ problem.off(rest) ** 2
    return Fit(rest, left, slope, float(left @ left + held))


def close_ones(problem: Problem, state: Fit, without: Fit, rivals: Sequence[Rival]) -> list[Rival]:
    """
    Return the rivals that make up for nearly all of a cause.

    :param problem: the data.
    :param state: with the cause.
    :param without: without it.
    :param rivals: fits of others in its place.
    :return: those, in the order of the rivals.
    """
    leaves = WEIGHED if problem.by_misfit else LEAVES
    near = state.cost + leaves * max(without.cost - state.cost, 0.0)
    near += tie(problem, state) * len(state.left)
    return [r for r in rivals if r.fit.cost < near]


def contested(problem: Problem, found: Found) -> set[Candidate]:
    """
    Return the causes in whose place another effect makes up for nearly all that they do.

    :param problem: the data.
    :param found: what the search has found.
    :return: those.
    """
    return {
        cause
        for cause, without, rivals in zip(
            found.final.model.causes, found.without, found.rivals, strict=True
        )
        if any(
            rival.candidate.effect != cause.effect
            for rival in close_ones(problem, found.final, without, rivals)
        )
    }


def relieved(problem: Problem, fit: Fit) -> Fit | None:
    """
    Return a rival's fit without one of those that are worth least beside it.

    That may have stood for the rival, and keeps it in a valley from which it does not get out.

    :param problem: the data.
    :param fit: of a rival, which is its last cause.
    :return: the best fit with one cause less; None where the rival is alone or the rest diverges.
    """
    others = worths(problem, fit)[:-1]
    known = problem.slopes(fit)
    # two that share what they do have each taken some of it, and it is not told who had less
    rest = [fit.model.without(k) for k in np.argsort(others)[:SUSPECTS].tolist()]
    fits = [problem.fitted(model, known, 8, 1e-3, timed=False) for model in rest]
    best = min(fits, key=lambda smaller: smaller.cost, default=None)
    if best is None or not math.isfinite(best.cost):
        return None
    # who takes over what has gone moves far: derivatives from before stall
    return problem.fitted(best.model, rounds=8, accuracy=1e-3)


def sharpened(
    steps: Steps, state: Fit, without: Fit, rivals: Sequence[Rival], most: int
) -> list[Rival]:
    """
    Fit most of the rivals that come near as carefully as the cause that they challenge.

    :param steps: of the search.
    :param state: with the cause.
    :param without: without it.
    :param rivals: fits of others in its place, best first.
    :param most: how many are fitted.
    :return: all of them, best first.
    """
    problem = steps.problem
    close = close_ones(problem, state, without, rivals)[:most]
    here = problem.slopes(state)

    def careful(rival: Rival) -> Fit:
        # derivatives of another state stall a fit: who is better then seems only as good; when
        # events were is found in the second fit
        fit = problem.fitted(rival.fit.model, here, rounds=10, accuracy=UNTIMED)
        if fit.cost <= state.cost:
            return fit
        return problem.fitted(fit.model, rounds=6, accuracy=1e-3)

    fits = list(steps.pool.map(careful, close))
    sharp = [Rival(r.candidate, fit) for r, fit in zip(close, fits, strict=True)]
    return sorted([*sharp, *(r for r in rivals if r not in close)], key=judged_cost)
