"""
Causes that cancel, or undo, each other: together they imitate something that is none of them.

What unrelated causes do to the channels adds up like squares. Where a fit lacks the true cause, it
makes one up from large effects of opposite sign whose small difference looks like it; each is then
missed badly when it alone is left out, and none of them is there.

They do the opposite of each other. Those of ``compensating`` do the same: each is hardly missed
when it alone is left out, and one of them is there.

What is made up is off somewhere by a part of the large effects. Two that happen to be opposed,
such as a softer contact beside an encoder that makes the tip press harder, leave nothing.

A sensor of another gain, for one, is imitated by all that pushes and all other sensors having that
gain: in every other channel nothing is left of several large effects.

Guessed numbers of the file undo causes as well. On a weight of unknown inertia whose torque is in
unknown units an encoder of three times the gain changes next to nothing, but how the weight's
torque bends; whatever bends it is not an encoder for that.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from tendon_ros.diagnose.form import change
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: cosine of what two causes do, or a cause and guesses, below which they are opposed
OPPOSED = -0.5
#: times the power of what they do together that opposed causes do each alone, all added up: true
#: ones that happen to be opposed do three times, those that imitate seven times and more
UNDONE = 5.0
#: the same in one channel, where something else may show in others, and where nothing is left
HUSHED = 20.0
#: part of what opposed causes do each, all added up, that nothing but the true ones leaves
EXACT = 1e-5
#: part of what they do together that stays at most beside true ones, and times its power that
#: these do each alone, all added up: what is made up of more may be close to anything
CLOSELY, MADE_UP = 3e-3, 12.0
#: part of what they do to the channel where they do most, as power, that is nothing in another one
NOWHERE = 0.01
#: causes from which on it is no chance that nothing is left of them in a channel
CONSPIRING = 3
#: part of what a cause does, as an amplitude, that guessed numbers cannot do as well
ITS_OWN = 0.1


def undoing(problem: Problem, state: Fit) -> frozenset[int]:
    """
    Return the causes of a state that mostly undo each other.

    :param problem: the data.
    :param state: with causes.
    :return: which causes.
    """
    causes = state.model.causes
    if len(causes) < 2:
        return frozenset()
    changes = np.array([change(problem, state, k) for k in range(len(causes))])
    changes = np.where(np.isfinite(changes), changes, 0.0)
    # a guess may scale all torques at once: friction, of which a gain makes more or less, and a
    # motor that gives way are not opposed for that; nor are those whose rest alone is
    return _opposed(problem, state, changes) & _opposed(
        problem, state, _own(problem, state, changes)
    )


def _opposed(problem: Problem, state: Fit, changes: FloatArray) -> frozenset[int]:
    """Return the causes that undo each other by what they do, shape (causes, samples)."""
    channels = problem.channels()
    power = problem.structured_by_channel(state.left)
    stays = [power[name][0] if name in power else 0.0 for name in channels]
    # guesses go where all channels together want them
    tied = any(t.guessed for t in problem.tolerances)
    happened = np.array([bool(cause.instants) for cause in state.model.causes])
    # doubts lie where causes do most: beside them little of any would stay
    changes = changes * np.sqrt(problem.doubted)
    found: frozenset[int] = frozenset()
    for alike in (happened, ~happened):
        among = [(changes * alike[:, None])[:, samples] for samples in channels.values()]
        found |= undone(among, stays, tied=tied) | conspiring(among)
    return found


def absorbed(problem: Problem, state: Fit, without: Sequence[Fit]) -> frozenset[int]:
    """
    Return the causes of a state that guessed numbers of the file mostly undo.

    :param problem: the data.
    :param state: with causes.
    :param without: of each cause the fit without it.
    :return: which causes.
    """
    columns = _guessed(problem, state)
    if not columns.size:
        return frozenset()
    moved = state.slope[:, columns] @ problem.pack(state.model)[columns]
    found = set()
    for k, cause in enumerate(state.model.causes):
        whole = change(problem, state, k)
        # they could do it as well, and have gone where they undo it; slopes promise more of many
        # numbers than a fit without the cause makes true
        missed = without[k].left - state.left
        absorbs = its_own(problem, state, k) < ITS_OWN
        absorbs &= not missed @ missed > ITS_OWN**2 * (whole @ whole)
        opposes = moved @ whole < OPPOSED * np.sqrt((moved @ moved) * (whole @ whole))
        # what happens once is no number's doing
        if absorbs and opposes and not cause.instants:
            found.add(k)
    return frozenset(found)


def its_own(problem: Problem, state: Fit, k: int) -> float:
    """
    Return the part of what a cause does, as an amplitude, that guessed numbers cannot do as well.

    :param problem: the data.
    :param state: with the cause.
    :param k: which cause.
    :return: 0 to 1; 1 where nothing is guessed.
    """
    whole = change(problem, state, k)
    power = float(whole @ whole)
    if not 0.0 < power < math.inf:
        return 1.0
    [own] = _own(problem, state, whole[None])
    return math.sqrt(float(own @ own) / power)


def _own(problem: Problem, state: Fit, changes: FloatArray) -> FloatArray:
    """Return what of several changes, shape (changes, samples), guessed numbers cannot do."""
    columns = _guessed(problem, state)
    slope = state.slope[:, columns]
    normal = slope.T @ slope + np.diag(problem.prior(state.model)[columns] + 1e-9)
    return changes - np.linalg.solve(normal, slope.T @ changes.T).T @ slope.T


def _guessed(problem: Problem, state: Fit) -> NDArray[np.intp]:
    """Return which columns of a state's derivatives belong to guessed numbers."""
    guessed = np.array([t.guessed for t in problem.tolerances], dtype=np.bool_)
    return np.asarray(state.slope.shape[1] - len(guessed) + np.flatnonzero(guessed))


def undone(
    channels: Sequence[FloatArray], stays: Sequence[float], *, tied: bool = False
) -> frozenset[int]:
    """
    Return which of several causes mostly undo each other.

    What others leave where these do nothing says nothing of them.

    :param channels: of each channel what each cause does to its samples, in noise deviations,
        shape (causes, samples).
    :param stays: what all of them leave of each channel, as a sum of squares.
    :param tied: whether what is wrong in one channel shows in all others.
    :return: the causes that are opposed to others of them, where little of them stays that would
        be any better than they are large.
    """
    changes = np.concatenate(channels, axis=1)
    hushed = _undone(changes, HUSHED)
    little = []
    for members in _undone(changes, UNDONE):
        own = list(members)
        alone = float(np.sum(changes[own] ** 2))
        together = float(np.sum(changes[own].sum(axis=0) ** 2))
        does = np.array([np.mean(c[own] ** 2) if c.size else 0.0 for c in channels])
        there = (does > NOWHERE * does.max()) | tied
        left = float(np.sum(np.asarray(stays)[there]))
        close = left <= CLOSELY * together and alone < MADE_UP * together
        if left > EXACT * alone and not close:
            little.append(members)
    return frozenset().union(*hushed, *little)


def conspiring(channels: Sequence[FloatArray]) -> frozenset[int]:
    """
    Return which of several causes are large and yet leave nothing in the channels that they share.

    :param channels: of each channel what each cause does to its samples, in noise deviations,
        shape (causes, samples).
    :return: three causes or more that one channel or another ties together.
    """
    count = len(channels[0]) if channels else 0
    tied = np.eye(count, dtype=np.bool_)
    for changes in channels:
        heard = np.mean(changes**2, axis=1) > 1.0
        for members in _undone(changes * heard[:, None], HUSHED):
            tied[np.ix_(list(members), list(members))] = True
    _, label = connected_components(tied, directed=False)
    return frozenset(k for k in range(count) if np.sum(label == label[k]) >= CONSPIRING)


def _undone(changes: FloatArray, most: float) -> list[frozenset[int]]:
    """Return the groups of rows that are opposed and of which little stays."""
    product = changes @ changes.T
    power = np.diag(product)
    size = np.sqrt(np.maximum(power, 1e-300))
    opposed = product / np.outer(size, size) < OPPOSED
    _, label = connected_components(opposed, directed=False)
    groups = [np.flatnonzero(label == one) for one in np.unique(label)]
    return [
        frozenset(members.tolist())
        for members in groups
        if power[members].sum() > most * product[np.ix_(members, members)].sum()
    ]
