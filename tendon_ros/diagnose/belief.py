"""
What is believed of all that a search has found, and what is kept for prediction beside it.

What a machine does is often told by effects that stand in for others which no catalogue has. They
are no explanation, and no report may name them as causes; a simulator or an estimator is better
off with them, so the instrument that a diagnosis writes has them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from tendon_ros.diagnose.company import companies
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import chance, equals, foretells, signs_beside
from tendon_ros.diagnose.naming import NAMED, Weighed
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.identify.explanation import Model


@dataclass(frozen=True)
class Belief:
    """
    Which causes of the last state of a search are believed.

    ``weighed``, ``chances``: of each cause. ``named``: those that are named, with what speaks for
    them; of causes that make up for one another the first is named for all. ``accepted``: these
    and who is named through them. ``kept``: the accepted ones and what foretells beside them.
    """

    weighed: tuple[Weighed, ...]
    chances: tuple[float, ...]
    named: Mapping[int, Weighed]
    accepted: tuple[int, ...]
    kept: tuple[int, ...]

    def model(self, found: Found, which: Collection[int]) -> Model:
        """
        Return a model with some of the causes.

        :param found: what the search has found.
        :param which: which of its causes.
        :return: the last state without all others, nothing refitted.
        """
        others = (k for k in range(len(self.weighed)) if k not in which)
        return found.final.model.without(*others)


def belief(ready: Prepared, found: Found) -> Belief:
    """
    Judge what a search has found.

    :param ready: the problem.
    :param found: what the search has found.
    :return: what is believed, and what is kept; nothing that happened once is kept for
        prediction, since it will not happen again.
    """
    causes = found.final.model.causes
    weighed = tuple(
        Weighed(
            cause,
            tuple(r.candidate for r in equals(ready.problem, found, k)),
            signs_beside(ready.problem, found, found.without[k]),
        )
        for k, cause in enumerate(causes)
    )
    chances = tuple(chance(ready, found, k, w.signs) for k, w in enumerate(weighed))
    named = {k: weighed[k] for k, p in enumerate(chances) if p >= NAMED}
    accepted = {*named}
    doubted = [k for k in range(len(causes)) if k not in named]
    for company in companies(ready, found, weighed, doubted):
        named[company.members[0]] = company.weighed
        accepted |= {*company.members}
    beside = {
        k
        for k, cause in enumerate(causes)
        if k not in accepted and not cause.instants and foretells(ready, found, k)
    }
    return Belief(
        weighed, chances, named, tuple(sorted(accepted)), tuple(sorted(accepted | beside))
    )
