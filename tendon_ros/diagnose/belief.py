"""
What is believed of all that a search has found, and what is kept for prediction beside it.

What a machine does is often told by effects that stand in for others which no catalogue has. They
are no explanation, and no report may name them as causes; a simulator or an estimator is better
off with them, so the instrument that a diagnosis writes has them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bent import (
    far_fetched,
    is_constant,
    is_counted,
    is_wide,
    spent,
    vanishes,
)
from tendon_ros.diagnose.cancelling import absorbed, undoing
from tendon_ros.diagnose.clock import Early, early
from tendon_ros.diagnose.compensating import companies, rubbing
from tendon_ros.diagnose.ends import at_an_end
from tendon_ros.diagnose.excusing import excuses
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.giving_less import giving_less
from tendon_ros.diagnose.intervals import unsized
from tendon_ros.diagnose.judge import (
    chance,
    equals,
    IDLE,
    signs_beside,
    spoils,
    Stays,
    stays,
    takes_noise,
)
from tendon_ros.diagnose.logged import is_logged
from tendon_ros.diagnose.naming import NAMED, Weighed
from tendon_ros.diagnose.outstanding import stands_out_in_time
from tendon_ros.diagnose.plausible import is_at_end, is_far_off
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: kinds of effect that may be alike: there are five of dry friction, and no family has more. Where
#: still others do as well, all of them do badly
ALIKE = 5
#: part of a size by which a cause may change where what stands for something unknown goes
STEADY = 0.2


@dataclass(frozen=True)
class Belief:
    """
    Which causes of the last state of a search are believed.

    ``weighed``: each of them; those that undo each other are not believed. ``named``: those that
    are named, with what speaks for them; ``companies``: causes that make up for one another, of
    which the first is named for all. ``accepted``: these and who is named through them.
    ``kept``: the accepted ones, and what spoils nothing beside them. ``early``: who is early where
    all other sensors are late; those delays are not believed. ``logged``: those that are
    believed and not named, since they may be what a logger makes of a sound sensor.
    """

    weighed: tuple[Weighed, ...]
    named: Mapping[int, Weighed]
    companies: tuple[tuple[int, ...], ...]
    accepted: tuple[int, ...]
    kept: tuple[int, ...]
    early: Early | None
    logged: tuple[int, ...]

    def model(self, found: Found, which: Collection[int]) -> Model:
        """
        Return a model with some of the causes.

        :param found: what the search has found.
        :param which: which of its causes.
        :return: the last state without all others, nothing refitted.
        """
        others = (k for k in range(len(self.weighed)) if k not in which)
        return found.final.model.without(*others)

    def doubting(self, unsized: Collection[int]) -> Belief:
        """
        Return the same where causes that may as well have no size are not named.

        :param unsized: causes whose stated intervals hold none; those of a company make up for one
            another, and are named for all of them.
        :return: with those no more probable than what may be nothing.
        """
        members = {k for company in self.companies for k in company}
        doubted = {k for k in self.named if k in unsized and k not in members}
        return replace(
            self,
            named={k: w for k, w in self.named.items() if k not in doubted},
            weighed=tuple(
                replace(w, chance=min(IDLE, w.chance)) if k in doubted else w
                for k, w in enumerate(self.weighed)
            ),
        )


def belief(ready: Prepared, found: Found) -> Belief:
    """
    Judge what a search has found.

    :param ready: the problem.
    :param found: what the search has found.
    :return: what is believed, and what is kept; nothing that happened once is kept for
        prediction, since it will not happen again.
    """
    problem, final = ready.problem, found.final
    causes = final.model.causes
    ahead = early(problem, final.model)
    # what a motor does for a while, or a pulley where it touches something
    local = giving_less(problem, final) | at_an_end(problem, final, found.without)
    undone = undoing(problem, final) | absorbed(problem, final, found.without) | local
    undone |= ahead.late if ahead else frozenset()
    undone |= {k for k in range(len(causes)) if is_at_end(problem, found, k)}
    rest = _without(ready, found, undone)
    left = stays(ready, rest)
    weighed = _all_weighed(ready, found, rest, left, undone)
    # one that is missed, and may as well have no size, is part of a form that several make up
    nothing = unsized(problem, final) - undone
    if empty := {k for k in nothing if weighed[k].chance >= NAMED}:
        undone |= empty
        rest = _without(ready, found, undone)
        left = stays(ready, rest)
        weighed = _all_weighed(ready, found, rest, left, undone)
    able = [k for k in range(len(causes)) if k not in undone and not _open(problem, found, k)]
    together = companies(ready, found, weighed, able, left)
    if problem.by_misfit and not together:
        others = [k for k in range(len(causes)) if k not in undone]
        rubs = rubbing(ready, found, weighed, others, left)
        together = [rubs] if rubs else []
    members = {k for company in together for k in company.members}
    weighed = _happening(ready, found, weighed, members)
    alone = {k: w for k, w in enumerate(weighed) if w.chance >= NAMED and k not in members}
    named = alone | {company.members[0]: company.weighed for company in together}
    logged = {
        k
        for k, cause in enumerate(causes)
        if k not in undone and is_logged(problem, cause, final.model.values(k))
    }
    accepted = members | {*alone} | logged
    # fits want them, and what was held out is often a few seconds only: it must speak plainly
    beside = {
        k
        for k, cause in enumerate(causes)
        # who only helps a push is of no use without it, nor is who stands for a stop elsewhere
        if k not in accepted | local
        and not cause.instants
        # nor is an encoder that reads five times what turns any good in a repaired file
        and not spent(cause, final.model.values(k))
        and not far_fetched(cause, final.model.values(k))
        and not spoils(ready, found, found.without[k])
        # who is fitted next to what only takes noise comes out too small
        and not takes_noise(problem, found, k)
    }
    return Belief(
        weighed,
        named,
        tuple(company.members for company in together),
        tuple(sorted(accepted)),
        tuple(sorted(accepted | beside)),
        ahead,
        tuple(sorted(logged)),
    )


def _all_weighed(
    ready: Prepared, found: Found, rest: Fit, left: Stays, undone: Collection[int]
) -> tuple[Weighed, ...]:
    """
    Return what speaks for each cause of the last state.

    ``rest``: the fit without those that are ``undone``, and ``left``: what that leaves.
    """
    final = found.final
    whole = left if rest is final else stays(ready, final)
    beside = [
        whole if _stands_alone(final, rest, k) else left for k in range(len(final.model.causes))
    ]
    return tuple(
        _weighed(ready, found, k, of_others, k in undone) for k, of_others in enumerate(beside)
    )


def _without(ready: Prepared, found: Found, undone: Collection[int]) -> Fit:
    """Return the last state without the causes that undo each other, refitted."""
    if not undone:
        return found.final
    rest = ready.problem.fitted(found.final.model.without(*undone), rounds=6, accuracy=1e-2)
    return rest if math.isfinite(rest.cost) else found.start


def _happening(
    ready: Prepared,
    found: Found,
    weighed: tuple[Weighed, ...],
    members: Collection[int],
) -> tuple[Weighed, ...]:
    """
    Return the same where no event is believed that stands out only beside what is not.

    A stop that is hit again and again is told by a torque limit, a lighter body and a push: the
    two take what all other hits leave, and the push one that they fit worse.

    ``members``: causes that make up for one another and are believed together.
    """
    doubted = {k for k, w in enumerate(weighed) if w.chance <= IDLE and k not in members}
    events = [k for k, w in enumerate(weighed) if w.chance >= NAMED and w.signs.lone]
    if not events or not doubted:
        return weighed
    problem = ready.problem
    believed = _without(ready, found, doubted)
    once = {
        k
        for k in events
        if not stands_out_in_time(
            problem, _without(ready, found, {k, *doubted}), believed, found.final.model.causes[k]
        )
    }
    return tuple(
        replace(w, chance=min(IDLE, w.chance)) if k in once else w for k, w in enumerate(weighed)
    )


def _stands_alone(final: Fit, rest: Fit, k: int) -> bool:
    """
    Return whether a cause has the same sizes with those that undo each other and without them.

    They stand for something unknown. It is not what that is told by then, and what stays beside
    it is what all leave.
    """
    cause, sizes = final.model.causes[k], final.model.values(k)
    if cause not in rest.model.causes or rest.cost <= final.cost:
        return False
    alone = rest.model.values(rest.model.causes.index(cause))
    return all(
        abs(alone[p.name] - sizes[p.name]) <= STEADY * abs(sizes[p.name] - p.neutral)
        for p in cause.parameters
        if not p.is_shape
    )


def _weighed(ready: Prepared, found: Found, k: int, left: Stays, undone: bool) -> Weighed:
    """
    Return what speaks for one cause of the last state.

    ``left``: what stays of all that may be believed beside it; ``undone``: whether others undo it.
    """
    without = found.without[k]
    signs = signs_beside(ready.problem, found, without, left)
    likely = chance(ready, found, k, signs)
    cause = found.final.model.causes[k]
    equal = tuple(r.candidate for r in equals(ready.problem, found, k))
    # beside a strong effect many differ by less than its law may be wrong by
    as_good = {r.candidate.effect for r in equals(ready.problem, found, k, by_law=False)}
    vague = len({cause.effect} | as_good) > ALIKE or _open(ready.problem, found, k)
    values = found.final.model.values(k)
    vague |= any(
        is_none(ready.problem, cause, values) for is_none in (is_constant, is_counted, is_logged)
    )
    return Weighed(
        cause=cause,
        equal=equal,
        signs=signs,
        chance=min(IDLE, likely) if undone or vague else likely,
        without=without,
    )


def _open(problem: Problem, found: Found, k: int) -> bool:
    """Return whether nobody was tried in its place, or no value of it tells what is there."""
    model = found.final.model
    cause = model.causes[k]
    return (
        cause in found.unmet
        or is_wide(cause, model.values(k))
        or excuses(problem, model, k)
        or vanishes(problem, model, k)
        or is_far_off(problem, found, k)
    )
