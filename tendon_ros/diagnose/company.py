"""
Causes that make up for one another: which of them is there cannot be said, that one is can be.

Each alone is hardly missed, since the others take over what it did; together they are missed
much. Friction of a tool's spindle and of its jaw, between two torque sensors, are such.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
import math

from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import probability, signs_beside, spoils
from tendon_ros.diagnose.naming import NAMED, Weighed
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.identify.fit import Fit, UNTIMED

#: times what each is missed alone that two causes must be missed together
MAKES_UP = 2.0


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
    ready: Prepared, found: Found, weighed: Sequence[Weighed], able: Sequence[int]
) -> list[Company]:
    """
    Return what is certain of causes that are each uncertain.

    :param ready: the problem.
    :param found: what the search has found.
    :param weighed: its causes.
    :param able: which of them may make up for one another, sorted; events do for nothing.
    :return: the companies that can be named.
    """
    problem, final = ready.problem, found.final
    causes = final.model.causes
    lasting = [k for k in able if not causes[k].instants]
    sure = {k for k in lasting if weighed[k].chance >= NAMED}
    missed = {k: found.without[k].cost - final.cost for k in lasting}
    known = problem.slopes(final)
    fits: dict[tuple[int, ...], Fit] = {}

    def without_all(members: tuple[int, ...]) -> Fit:
        if members not in fits:
            model = final.model.without(*members)
            fits[members] = problem.fitted(model, rounds=6, accuracy=UNTIMED)
        return fits[members]

    def more_together(pair: tuple[int, int]) -> float:
        alone = missed[pair[0]] + missed[pair[1]]
        # careful fits only find less: most pairs are no company by a rough one
        fit = problem.fitted(final.model.without(*pair), known, rounds=4, accuracy=1e-2)
        if fit.cost - final.cost > MAKES_UP * alone:
            fit = without_all(pair)
        return fit.cost - final.cost - MAKES_UP * alone

    pairs = [pair for pair in combinations(lasting, 2) if not sure.issuperset(pair)]
    more = {pair: more_together(pair) for pair in pairs}
    named = []
    for members in _components(_linked(more, sure), len(causes)):
        first, *others = sorted(members, key=lambda k: -missed[k])
        without = without_all(members)
        if not math.isfinite(without.cost):
            continue
        # what undoes each other is not believed, and what stays is the same for all
        signs = signs_beside(problem, found, without, weighed[first].signs.left)
        likely = probability(signs)
        if likely < NAMED or spoils(ready, found, without):
            continue
        equal = [causes[k] for k in others]
        equal += [e for k in (first, *others) for e in weighed[k].equal]
        alike = tuple(dict.fromkeys(e for e in equal if e != causes[first]))
        whole = replace(weighed[first], equal=alike, signs=signs, chance=likely, without=without)
        named.append(Company((first, *others), whole))
    return named


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
