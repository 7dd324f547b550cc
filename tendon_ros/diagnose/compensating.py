"""
Causes that compensate for each other: that one of them is there can be said, which one cannot.

Each alone is hardly missed, since the others take over what it did; together they are missed
much. Friction of a tool's spindle and of its jaw, between two torque sensors, are such.

They do the same. Those of ``cancelling`` do the opposite of each other: each is missed badly when
it alone is left out, and none of them is there.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import signs_beside, spoils, Stays
from tendon_ros.diagnose.naming import NAMED, Weighed
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.signs import probability
from tendon_ros.identify.fit import Fit, Problem, UNTIMED

FloatArray = NDArray[np.float64]

#: times what each is missed alone that two causes must be missed together, and times what a
#: company and a further cause are missed apart
MAKES_UP = 2.0
FAR = 12  # rounds of a fit without any dry friction


@dataclass(frozen=True)
class Company:
    """
    Causes that make up for one another.

    ``members``: which causes of the last state, most missed first; ``weighed``: the first of them
    with all others as its equals, and what speaks for the company as one.
    """

    members: tuple[int, ...]
    weighed: Weighed


def companies(
    ready: Prepared,
    found: Found,
    weighed: Sequence[Weighed],
    able: Sequence[int],
    left: Stays,
) -> list[Company]:
    """
    Return what is certain of causes that are each uncertain.

    :param ready: the problem.
    :param found: what the search has found.
    :param weighed: its causes.
    :param able: which of them may make up for one another, sorted; events do for nothing.
    :param left: what all that may be believed leaves.
    :return: the companies that can be named.
    """
    problem, final = ready.problem, found.final
    causes = final.model.causes
    lasting = [k for k in able if not causes[k].instants]
    sure = {k for k in lasting if weighed[k].chance >= NAMED}
    alone = {k: found.without[k].cost - final.cost for k in lasting}
    missed = _Missed(problem, final)
    pairs = [pair for pair in combinations(lasting, 2) if not sure.issuperset(pair)]
    more = {pair: missed.more(pair, alone[pair[0]] + alone[pair[1]]) for pair in pairs}
    sets = _components(_linked(more, sure), len(causes))
    doubted = set(lasting) - sure - {k for members in sets for k in members}
    named = []
    for linked in sets:
        members = _grown(missed, linked, doubted, alone)
        doubted -= set(members)
        company = _as_one(ready, found, weighed, members, alone, missed.fit(members), left)
        named += [company] if company else []
    return named


def rubbing(
    ready: Prepared,
    found: Found,
    weighed: Sequence[Weighed],
    able: Sequence[int],
    left: Stays,
) -> Company | None:
    """
    Return the dry frictions of a machine as one, of which each alone is uncertain.

    Every bearing of a machine rubs, by some law or another. Of six frictions none is missed much
    alone, and by which of them something is told is as uncertain as their laws. That it is
    friction is not, if a fit without any leaves much more.

    :param ready: the problem.
    :param found: what the search has found.
    :param weighed: its causes.
    :param able: those that others do not undo.
    :param left: what all that may be believed leaves.
    :return: the company; None where one of them is certain, or all of them are not.
    """
    causes = found.final.model.causes
    dry = tuple(k for k in able if causes[k].dry)
    if len(dry) < 2 or any(weighed[k].chance >= NAMED for k in dry):
        return None
    alone = {k: found.without[k].cost - found.final.cost for k in dry}
    # who does without all of them goes far
    without = ready.problem.fitted(found.final.model.without(*dry), rounds=FAR, accuracy=1e-2)
    return _as_one(ready, found, weighed, dry, alone, without, left)


def _as_one(
    ready: Prepared,
    found: Found,
    weighed: Sequence[Weighed],
    members: Sequence[int],
    alone: Mapping[int, float],
    without: Fit,
    left: Stays,
) -> Company | None:
    """Return causes as a company, if it can be named; ``without``: the fit without all of them."""
    if not math.isfinite(without.cost):
        return None
    causes = found.final.model.causes
    first, *others = sorted(members, key=lambda k: -alone[k])
    # what undoes each other is not believed, and what stays is the same for all
    signs = signs_beside(ready.problem, found, without, left)
    likely = probability(signs)
    if likely < NAMED or spoils(ready, found, without):
        return None
    equal = [causes[k] for k in others]
    equal += [e for k in (first, *others) for e in weighed[k].equal]
    alike = tuple(dict.fromkeys(e for e in equal if e != causes[first]))
    whole = replace(weighed[first], equal=alike, signs=signs, chance=likely, without=without)
    return Company((first, *others), whole)


class _Missed:
    """
    Fits that do without several causes of a last state at once.

    :param problem: the data.
    :param final: the last state.
    """

    def __init__(self, problem: Problem, final: Fit) -> None:
        self._problem = problem
        self._final = final
        self._known = problem.slopes(final)
        self._fits: dict[tuple[int, ...], Fit] = {}

    def fit(self, members: tuple[int, ...]) -> Fit:
        """Return the fit without some causes, sorted."""
        if members not in self._fits:
            model = self._final.model.without(*members)
            self._fits[members] = self._problem.fitted(model, rounds=6, accuracy=UNTIMED)
        return self._fits[members]

    def together(self, members: tuple[int, ...]) -> float:
        """Return what causes are missed together."""
        return self.fit(members).cost - self._final.cost

    def more(self, members: tuple[int, ...], apart: float) -> float:
        """Return what causes are missed together beyond a multiple of what parts of them are."""
        # careful fits only find less: most are no company by a rough one
        model = self._final.model.without(*members)
        rough = self._problem.fitted(model, self._known, rounds=4, accuracy=1e-2)
        beyond = rough.cost - self._final.cost - MAKES_UP * apart
        return self.together(members) - MAKES_UP * apart if beyond > 0.0 else beyond


def _grown(
    missed: _Missed, members: tuple[int, ...], doubted: Collection[int], alone: Mapping[int, float]
) -> tuple[int, ...]:
    """Return a company with whoever makes up for it as its members make up for one another."""
    while True:
        own = missed.together(members)
        wider = {k: tuple(sorted((*members, k))) for k in doubted if k not in members}
        more = {k: missed.more(wider[k], own + alone[k]) for k in wider}
        # what cannot be computed without all of them says nothing
        goes = [k for k in sorted(more) if 0.0 < more[k] < math.inf]
        if not goes:
            return members
        members = wider[max(goes, key=lambda k: more[k])]


def _linked(more: Mapping[tuple[int, int], float], sure: Collection[int]) -> list[tuple[int, int]]:
    """
    Return which causes go together, of pairs with what they are missed more together.

    Those that are named alone stay apart: each doubted one goes with the one of them that it makes
    up for most, and else with its like.
    """
    links = []
    goes: dict[int, tuple[float, tuple[int, int]]] = {}
    for pair, size in more.items():
        # what cannot be computed without both says nothing
        if not 0.0 < size < math.inf:
            continue
        doubted = [k for k in pair if k not in sure]
        if len(doubted) == len(pair):
            links.append(pair)
        else:
            goes[doubted[0]] = max(goes.get(doubted[0], (0.0, pair)), (size, pair))
    beside = [pair for _, pair in goes.values()]
    return [*beside, *(pair for pair in links if not goes.keys() & set(pair))]


def _components(linked: Sequence[tuple[int, int]], count: int) -> list[tuple[int, ...]]:
    """Return the sets of two or more that links hold together, each sorted."""
    rows, columns = zip(*linked, strict=True) if linked else ((), ())
    graph = coo_array(([1] * len(linked), (rows, columns)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    sets = [tuple(k for k in range(count) if label[k] == n) for n in sorted({*label.tolist()})]
    return [members for members in sets if len(members) > 1]
