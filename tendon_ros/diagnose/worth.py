"""What a cause must be worth: more than noise, and than the form of other laws, can explain."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.cancelling import undoing
from tendon_ros.diagnose.form import form_parts, form_power, own_power, summed
from tendon_ros.diagnose.imitable import imitable
from tendon_ros.diagnose.outstanding import stands_out_in_time
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: part of the noise's power that a cause must explain, over all samples and over one channel
LEAST, LEAST_IN_ONE = 0.03, 0.12
#: times as much for an event: of all times and recordings, one always fits some of the noise
ATTEMPTS = 4.0
#: part of what is left that a cause must explain which is smaller than the form of other laws
TAKES = 0.65
#: times the noise's power that noise never has, shared by neighbours or not
LOUD = 2.0
#: part of what is left in one channel that it must explain else
HALF = 0.5
#: part of the samples that tells anything of a cause which shows there alone
ENOUGH = 0.1
#: form of a law from which on another effect of its kind may only give it another form: creep with
#: one time constant more, hysteresis with one more bend
COARSE = 0.1
#: times the form of other laws that an event must explain, besides half of what is left, for it
#: fits whatever they once get wrong; or the part of what is left
TIMES_EVENT, TAKES_EVENT = 10.0, 0.8


def worthwhile(problem: Problem, start: Fit, before: Fit, after: Fit) -> bool:
    """
    Return whether one more cause is believed.

    :param problem: the data.
    :param start: without any cause.
    :param before: without this one.
    :param after: with it.
    :return: whether it explains more than noise and the form of the other laws can.
    """
    free = ~_held(problem, before, after)
    after = moving(problem, before, after)
    gain, in_one = gains(problem, before, after)
    new = set(after.model.causes) - set(before.model.causes)
    eager = all(c.instants for c in new)
    least = ATTEMPTS if eager else 1.0
    if gain <= least * LEAST and in_one <= least * LEAST_IN_ONE:
        return False
    parts = form_parts(problem, start, before)
    profile = summed(parts, before)
    own = own_power(problem, start)
    form = own + float(np.mean(profile))
    if eager:  # what laws get wrong is not at one time, and nor is what has no law
        if all(stands_out_in_time(problem, before, after, event) for event in new):
            return True
        part = _part_where_it_happens(problem, before, after, new)
        return part > TAKES_EVENT or (part > HALF and gain > TIMES_EVENT * form)
    if gain > form or gain > own + _like_what_has_gone(problem, before, after, parts):
        return True
    # what the form of a law leaves has no other cause that would explain most of it
    most = (
        (gain > TAKES * problem.structured(free * before.left) and not _completes(before, new))
        or _most_of_one(problem, start, before, after, form, free)
        or _apart(before, after, (profile < LEAST_IN_ONE) & free)
    )
    return most and not _bends(problem, after, new)


def _like_what_has_gone(
    problem: Problem, before: Fit, after: Fit, parts: Sequence[FloatArray]
) -> float:
    """
    Return what laws may leave that looks like what has gone: a ripple errs in waves, if at all.

    ``parts``: what the law of each cause may leave without the new ones.
    """
    gone = before.left - after.left
    return sum(
        float(np.mean(part)) * (imitable(problem, before, k, gone) if cause.waves else 1.0)
        for k, (cause, part) in enumerate(zip(before.model.causes, parts, strict=True))
    )


def _part_where_it_happens(
    problem: Problem, before: Fit, after: Fit, new: Set[Candidate]
) -> float:
    """
    Return the part of what is left that events explain, in the recordings that have them.

    Of both what bins share counts: pushes fit the moments at which friction lets go, one by one.
    """
    segments = problem.rollouts.segments
    there = np.zeros(len(before.left), dtype=np.bool_)
    for n, _, span in problem.spans():
        there[span] = any(c.acts_in(segments[n].name) for c in new)
    then, last = (np.where(there, fit.left, 0.0) for fit in (before, after))
    left, stays = problem.structured(then), problem.structured(last)
    return (left - stays) / max(left, 1e-12)


def _completes(before: Fit, new: Set[Candidate]) -> bool:
    """Return whether coarse laws of the same kind act already, to which these lend their form."""
    coarse = {c.effect for c in before.model.causes if find(c.effect).form >= COARSE}
    return {c.effect for c in new} <= coarse


def _bends(problem: Problem, after: Fit, new: Set[Candidate]) -> bool:
    """Return whether new causes undo others: the difference gives one law another form."""
    undone = undoing(problem, after)
    return bool(undone) and new <= {after.model.causes[k] for k in undone}


def stands_out(problem: Problem, start: Fit, before: Fit, after: Fit) -> bool:
    """
    Return whether a cause explains most of a channel of which the other laws explain little.

    What a law gets wrong shows where it explains much; a preload that moves one pulley does not.

    :param problem: the data.
    :param start: without any cause.
    :param before: without this one.
    :param after: with it.
    :return: whether, what it merely holds left out.
    """
    form = form_power(problem, start, before)
    free = ~_held(problem, before, after)
    return _most_of_one(problem, start, before, moving(problem, before, after), form, free)


def _most_of_one(
    problem: Problem, start: Fit, before: Fit, after: Fit, form: float, free: BoolArray
) -> bool:
    """
    Return whether a cause explains most of a channel, more than other laws may leave there.

    Where friction only holds (not ``free``) it could explain anything, and nothing is asked.
    """
    first, then, last = (by_channel(problem, free * fit.left) for fit in (start, before, after))
    noise = by_channel(problem, free.astype(np.float64))
    explained = (start.cost - before.cost) / max(len(start.left), 1)
    wrong = form / max(explained, 1e-12)
    return any(
        then[c] - last[c]
        > max(wrong * (first[c] - then[c]), HALF * (then[c] - noise[c]), LEAST_IN_ONE)
        for c in first
    )


def _apart(before: Fit, after: Fit, quiet: BoolArray) -> bool:
    """
    Return whether a cause explains most of what is left where the other laws hardly act.

    A limit that cuts off some torques says nothing of all others.
    """
    if np.mean(quiet) < ENOUGH:
        return False
    then, last = (float(np.mean(fit.left[quiet] ** 2)) for fit in (before, after))
    return then - last > max(LEAST_IN_ONE, HALF * (then - 1.0))


def by_channel(problem: Problem, left: FloatArray) -> dict[str, float]:
    """
    Return what is left of each channel.

    :param problem: the data.
    :param left: what is left, in noise deviations, shape (samples,).
    :return: mean squares, all recordings together.
    """
    return {
        name: float(np.sum(left[samples] ** 2)) / max(int(samples.sum()), 1)
        for name, samples in problem.channels().items()
    }


def open_question(problem: Problem, state: Fit) -> bool:
    """
    Return whether what is left has any structure that a further cause could explain.

    What is late, say, shows for some hundredths of a second at reversals, and neighbours share
    nothing of it: so much power that it cannot be noise is a question, too.

    :param problem: the data.
    :param state: what holds already.
    :return: whether, over all samples or in one channel.
    """
    whole, in_one = problem.structures(state.left)
    loud = float(np.mean(state.left**2)) > LOUD
    return loud or whole > 0.5 * LEAST or in_one > 0.5 * LEAST_IN_ONE


def gains(problem: Problem, before: Fit, after: Fit) -> tuple[float, float]:
    """
    Return how much power falls, in units of the noise's.

    :param problem: the data.
    :param before: the poorer fit.
    :param after: the better one.
    :return: over all samples, and in the channel where it falls most.
    """
    then, last = by_channel(problem, before.left), by_channel(problem, after.left)
    gain = (before.cost - after.cost) / max(len(before.left), 1)
    return gain, max((then[c] - last[c] for c in then), default=0.0)


def moving(problem: Problem, before: Fit, after: Fit) -> Fit:
    """
    Return the better of two fits without what new friction merely holds while a motor rests.

    It could hold anything, so that holding is no reason to look for it.

    :param problem: the data.
    :param before: the poorer fit.
    :param after: the better one.
    :return: what it leaves, there as much as the poorer one does.
    """
    held = _held(problem, before, after)
    if not held.any():
        return after
    excused = float(np.sum(before.left[held] ** 2 - after.left[held] ** 2))
    left = np.where(held, before.left, after.left)
    return replace(after, left=left, cost=after.cost + max(0.0, excused))


def _held(problem: Problem, before: Fit, after: Fit) -> BoolArray:
    """Return which samples are torques of resting motors on whose pulleys new friction acts."""
    rubs = {c.place for c in set(after.model.causes) - set(before.model.causes) if c.dry}
    held = np.zeros(len(before.left), dtype=np.bool_)
    for place in rubs & set(problem.resting):
        held |= problem.resting[place]
    return held


def needed(problem: Problem, start: Fit, state: Fit) -> float:
    """
    Return the fall of squares that a cause beside all others must be worth.

    :param problem: the data.
    :param start: without any cause.
    :param state: with all of them.
    :return: in noise deviations squared.
    """
    return len(state.left) * max(LEAST_IN_ONE, form_power(problem, start, state))
