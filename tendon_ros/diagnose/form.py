"""
The form of laws: no effect of the catalogue is quite what a machine does.

What the right cause may leave, and when two explanations are equal, follow from how far laws may
be from machines.
"""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from tendon_ros.effects import find
from tendon_ros.identify.first_order_worth import worths
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.sticking import sticking
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
    return summed(form_parts(problem, start, state, resting=resting), state)


def creep_profile(problem: Problem, start: Fit, state: Fit) -> FloatArray:
    """
    Return where and when friction that holds may have crept away.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them, and with its derivatives.
    :return: noise power that each sample may keep for that, shape (samples,).
    """
    held = sticking(problem, state)
    parts = [
        HELD**2 * own * sticks
        for own, sticks in zip(_explained(problem, start, state), held, strict=True)
        if sticks is not None
    ]
    return summed(parts, state)


def summed(parts: Sequence[FloatArray], state: Fit) -> FloatArray:
    """
    Return what laws may leave together.

    :param parts: of some of the causes of a state, as :func:`form_parts` gives them.
    :param state: the state.
    :return: shape (samples,); zeros where there are no parts.
    """
    return np.sum([np.zeros(len(state.left)), *parts], axis=0)


def form_parts(
    problem: Problem, start: Fit, state: Fit, *, resting: bool = True
) -> list[FloatArray]:
    """
    Return where and when the law of each cause may be wrong.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them.
    :param resting: as for :func:`form_power`.
    :return: for each cause the noise power that each sample may keep, shape (samples,).
    """
    causes = state.model.causes
    held = sticking(problem, state) if resting else [None] * len(causes)
    found = []
    for cause, own, sticks in zip(causes, _explained(problem, start, state), held, strict=True):
        form = np.full(len(own), _form(problem, cause.effect, cause.place) ** 2)
        if sticks is not None:
            form[sticks] += HELD**2
        found.append(form * own)
    return found


def _explained(problem: Problem, start: Fit, state: Fit) -> list[FloatArray]:
    """Return for each cause the power that it explains of each sample, shape (samples,)."""
    causes = state.model.causes
    if not causes:
        return []
    explained = max(0.0, start.cost - state.cost) / len(state.left)
    # what each is worth beside the others; what they share is shared out
    worth = np.minimum(np.array(worths(problem, state)) / len(state.left), explained)
    worth *= max(1.0, explained / max(float(worth.sum()), 1e-12))
    found = []
    for k in range(len(causes)):
        power = change(problem, state, k) ** 2
        shared = min(float(worth[k]), explained) / max(float(np.mean(power)), 1e-12)
        found.append(shared * power)
    return found


def change(problem: Problem, state: Fit, k: int) -> FloatArray:
    """
    Return what a cause does to each sample, to first order where it has sizes.

    :param problem: the data.
    :param state: with the cause.
    :param k: which.
    :return: in noise deviations, shape (samples,).
    """
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
    return max(known.form, COUNTED) if known.dry and place in driven else known.form


#: of each problem, the state that was asked about last, and what the file's effects may leave:
#: a sample, and each of the samples
_OWN: WeakKeyDictionary[Problem, tuple[Fit, float, FloatArray]] = WeakKeyDictionary()


def own_power(problem: Problem, start: Fit) -> float:
    """
    Return what the laws of the file's own effects may leave.

    :param problem: the data.
    :param start: without any cause.
    :return: in noise power per sample.
    """
    return _by_own(problem, start)[1]


def own_profile(problem: Problem, start: Fit) -> FloatArray:
    """
    Return where and when the laws of the file's own effects may be wrong.

    :param problem: the data.
    :param start: without any cause.
    :return: noise power that each sample may keep for that, shape (samples,).
    """
    return _by_own(problem, start)[2]


def _by_own(problem: Problem, start: Fit) -> tuple[Fit, float, FloatArray]:
    known = _OWN.get(problem)
    if known is None or known[0] is not start:
        known = _OWN[problem] = start, *_left_by_own(problem, start)
    return known


def _left_by_own(problem: Problem, start: Fit) -> tuple[float, FloatArray]:
    instrument = problem.rollouts.instrument
    uses = problem.uses(start.model)
    measured = problem.rollouts.measured
    found, profile = 0.0, np.zeros(len(start.left))
    for own in instrument.effects:
        gone = EffectUse(own.effect, own.place, find(own.effect).neutral, instead=True)
        predicted = problem.rollouts.predicted([[*row, gone] for row in uses])
        left = problem.flat([m - p for m, p in zip(measured, predicted, strict=True)])
        grown = float(left @ left - start.left @ start.left) / max(len(left), 1)
        if np.isfinite(grown):
            part = _form(problem, own.effect, own.place) ** 2
            found += max(0.0, grown) * part
            profile += (left - start.left) ** 2 * part
    return found, profile


def tie(problem: Problem, best: Fit) -> float:
    """
    Return the misfit beyond the best within which two explanations are equal.

    What the best leaves shows how far laws and machine are apart here: so much may be luck.

    :param problem: the data.
    :param best: the best.
    :return: in noise power per sample.
    """
    return TIE + TIE_FORM * problem.structured(best.left)
