"""
The search for causes: which effects, together, explain what is left.

Each round adds the set of candidates that together explain most, to first order; everything is
then fitted, and every cause must still be worth having. At the end each one is challenged by all
others in its place. The order in which causes were found therefore decides nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.form import at_once, degenerate, form_power, simpler, tie
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.memory import Memory
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.coordinates import Coordinates
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.screening import Proposal, Screen
from tendon_ros.identify.subset import Member, Subsets

FloatArray = NDArray[np.float64]
Report = Callable[[str, float], None]

CORRECTED = 36  # proposals that are judged again at their own size
CLOSE = 6  # rivals that are fitted as carefully as the cause itself
SHORTLIST = 10  # rivals of a cause that are fitted
MOST = 5  # causes
ROUNDS = 4  # of looking for more causes
#: times as much for an event: of all times and recordings, one always fits some of the noise
ATTEMPTS = 4.0
#: part of what is left that a cause must explain which is smaller than the form of other laws
TAKES = 0.65
#: times the form of other laws that an event must explain: it fits whatever they once get wrong
TIMES_EVENT = 10.0
#: times what is needed that a cause is worth, to first order, if it need not be left out to see
CLEAR = 10.0
#: part of what a fit would explain that first order is sure to see
FIRST_ORDER_SEES = 0.4
TELLING = 20  # candidates of each round that may replace one of many causes
MANY = 3  # causes from which on not every candidate challenges each of them
REPLACED = 6  # causes at most that challenges replace
#: norm of a signature in noise deviations, imitations taken off, that leaves a trace
TRACE = 2.0
#: part of the cost that one more parameter must save
PARAMETER = 0.004
#: part of the noise's power that a cause must explain, over all samples and over one channel
LEAST, LEAST_IN_ONE = 0.03, 0.12


def _judged(rival: Rival) -> float:
    """Return the cost of a fit, more where more parameters made it."""
    return rival.fit.cost * (1.0 + PARAMETER * len(rival.candidate.parameters))


def best_of(proposals: Sequence[Proposal]) -> list[Proposal]:
    """
    Return the best proposal of each candidate.

    :param proposals: best first.
    :return: best first.
    """
    best: dict[Candidate, Proposal] = {}
    for proposal in proposals:
        best.setdefault(proposal.candidate, proposal)
    return list(best.values())


class Search:
    """
    Searches one problem.

    :param problem: the fitted bins.
    :param candidates: all that may be named.
    :param jobs: threads.
    :param report: called with what is being done and the part that is done.
    :param memory: of the steps of an interrupted search.
    """

    def __init__(
        self,
        problem: Problem,
        candidates: Sequence[Candidate],
        jobs: int = 2,
        report: Report = lambda _what, _done: None,
        memory: Memory | None = None,
    ) -> None:
        self.problem = problem
        self.candidates = tuple(candidates)
        self.report = report
        self._memory = memory
        self._pool = ThreadPoolExecutor(jobs)
        self._stood: dict[Candidate, tuple[Fit, list[Rival]]] = {}

    def run(self) -> Found:
        """
        Search.

        :return: what was found.
        """
        found = Found()
        self.report('fitting the tolerances', 0.0)
        state = self._settled(self.problem.empty)
        found.states.append(state)
        self.report('screening the candidates', 0.03)
        screen = Screen(self.problem, state)
        proposals = self.screened(state, screen)
        found.proposals = best_of(proposals)
        # what leaves no trace at a typical size is not asked again
        traced = {(p.candidate.effect, p.candidate.place) for p in proposals if p.own > TRACE}
        self.candidates = tuple(
            c for c in self.candidates if c.instants or (c.effect, c.place) in traced
        )
        for model in (self._memory.models() if self._memory else [])[1:]:
            state = self._settled(model)
            found.states.append(state)
        turn = len(found.states) - 1
        challenged: Fit | None = None
        while True:
            grown: Fit | None = None
            if turn < ROUNDS and self.open_question(state):
                self.report(f'looking for causes, round {turn + 1}', 0.05 + 0.1 * turn)
                if state is not found.start:
                    screen = Screen(self.problem, state)
                    proposals = self.screened(state, screen)
                grown = self._grown(found, screen, proposals)
                turn += 1
            if grown is not None:
                state = grown
                found.states.append(state)
                if self._memory:
                    self._memory.keep([s.model for s in found.states])
                continue
            if challenged is state:
                break
            # better causes may leave more to see: look again where a challenge has changed them
            self._challenge(found)
            if found.final is state:
                break
            state = challenged = found.final
        self._ordered(found)
        return found

    def _grown(self, found: Found, screen: Screen, proposals: Sequence[Proposal]) -> Fit | None:
        """Return a state with the causes that explain most together; None where none does."""
        state = screen.fit
        leading = best_of(proposals)[:TELLING]
        found.telling |= {(p.candidate.effect, p.candidate.place) for p in leading}
        room = MOST - len(state.model.causes)
        members = self._subset(screen, proposals, room)
        if not members:
            return None
        model = state.model
        for member in members:
            candidate = member.proposal.candidate
            model = model.joined(candidate, Coordinates(candidate.parameters).values(member.z))
        # sizes and shapes lie along curved valleys: more of them, more steps
        fit = self.problem.fitted(model, self.problem.slopes(state), rounds=12, accuracy=1e-2)
        fit = self._pruned(found.start, self._settled(fit.model, self.problem.slopes(state)))
        new = set(fit.model.causes) - set(state.model.causes)
        return fit if new and self.worthwhile(found.start, state, fit) else None

    def _subset(self, screen: Screen, proposals: Sequence[Proposal], most: int) -> list[Member]:
        """Return the proposals that together explain most, to first order."""
        telling = [p for p in proposals[:CORRECTED] if p.gain > 0.0]
        model = screen.fit.model
        known = [(c, model.values(k)) for k, c in enumerate(model.causes)]
        telling = [
            p for p in telling if not any(at_once((p.candidate, p.values), e) for e in known)
        ]
        if most <= 0:
            return []
        signatures = list(self._pool.map(screen.signatures, telling))
        kept = [(p, s) for p, s in zip(telling, signatures, strict=True) if s is not None]
        if not kept:
            return []
        sets = Subsets([p for p, _ in kept], [s for _, s in kept], screen.left)
        return sets.best(LEAST * len(screen.left), most)

    # -- steps

    def screened(
        self,
        state: Fit,
        screen: Screen | None = None,
        leave: Sequence[Candidate] = (),
        among: Sequence[Candidate] | None = None,
    ) -> list[Proposal]:
        """
        Return the proposals of all candidates, two of each at most, best first.

        :param state: what holds already.
        :param screen: of that state.
        :param leave: candidates to leave out.
        :param among: those to ask; all where None.
        :return: the proposals; those that explain most are judged again at their own size.
        """
        screen = screen or Screen(self.problem, state)
        # what happens at a time may happen again, in another recording
        lasting = [c for c in state.model.causes if not c.instants]
        out = {(c.effect, c.place) for c in (*lasting, *leave)}
        everyone = self.candidates if among is None else among
        asked = [c for c in everyone if (c.effect, c.place) not in out]
        first = [
            p
            for proposals in self._pool.map(screen.proposals, asked)
            for p in proposals[:2]
            if p.candidate not in state.model.causes
        ]
        first.sort(key=lambda p: -p.gain)
        again = list(self._pool.map(screen.corrected, first[:CORRECTED]))
        return sorted([*again, *first[CORRECTED:]], key=lambda p: -p.gain)

    def fitted(self, state: Fit, proposals: Sequence[Proposal], needed: float) -> list[Rival]:
        """
        Fit the proposals that may explain as much as is needed, each beside what holds already.

        :param state: what holds already.
        :param proposals: best first, one of each candidate.
        :param needed: by how much squares must fall.
        :return: the fits, best first.
        """
        near = [p for p in proposals if p.gain > FIRST_ORDER_SEES * needed]
        chosen = near[:SHORTLIST] or list(proposals[:1])
        known = self.problem.slopes(state)

        def one(proposal: Proposal) -> Rival:
            model = state.model.joined(proposal.candidate, proposal.values)
            # sizes and shapes lie along curved valleys: more of them, more steps
            rounds = 6 * len(proposal.candidate.parameters)
            fit = self.problem.fitted(model, known, rounds=rounds, accuracy=1e-2)
            return Rival(proposal.candidate, fit)

        found = [
            r
            for r in self._pool.map(one, chosen)
            if np.isfinite(r.fit.cost)
            and not degenerate(self.problem, r.candidate, r.fit.model.values(-1))
        ]
        return sorted(found, key=_judged)

    def worthwhile(self, start: Fit, before: Fit, after: Fit) -> bool:
        """
        Return whether one more cause is believed.

        :param start: without any cause.
        :param before: without this one.
        :param after: with it.
        :return: whether it explains more than noise and the form of the other laws can.
        """
        gain, in_one = self.gains(before, after)
        new = set(after.model.causes) - set(before.model.causes)
        eager = all(c.instants for c in new)
        least = ATTEMPTS if eager else 1.0
        if gain <= least * LEAST and in_one <= least * LEAST_IN_ONE:
            return False
        form = form_power(self.problem, start, before)
        if eager:
            return gain > TIMES_EVENT * form
        # what the form of a law leaves has no other cause that would explain most of it
        return gain > form or gain > TAKES * self.problem.structured(before.left)

    def open_question(self, state: Fit) -> bool:
        """
        Return whether what is left has any structure that a further cause could explain.

        :param state: what holds already.
        :return: whether, over all samples or in one channel.
        """
        whole, in_one = self.problem.structures(state.left)
        return whole > 0.5 * LEAST or in_one > 0.5 * LEAST_IN_ONE

    def gains(self, before: Fit, after: Fit) -> tuple[float, float]:
        """
        Return how much power falls, in units of the noise's.

        :param before: the poorer fit.
        :param after: the better one.
        :return: over all samples, and in the channel where it falls most.
        """
        total: dict[str, list[float]] = {}
        segments = self.problem.rollouts.segments
        for (n, c, a), (_, _, b) in zip(
            self.problem.groups(before.left), self.problem.groups(after.left), strict=True
        ):
            name = segments[n].measured[c].sensor.channel
            entry = total.setdefault(name, [0.0, 0.0])
            entry[0] += float(a @ a - b @ b)
            entry[1] += len(a)
        gain = (before.cost - after.cost) / max(len(before.left), 1)
        return gain, max((e[0] / e[1] for e in total.values() if e[1]), default=0.0)

    def _settled(self, model: Model, known: Mapping[str, FloatArray] | None = None) -> Fit:
        """Fit with derivatives that are known already, then with those where the model now is."""
        fit = self.problem.fitted(model, known, rounds=6, accuracy=1e-3)
        if known is None and not np.abs(fit.model.moved).max(initial=0.0) > 0.5:
            return fit
        return self.problem.fitted(fit.model, rounds=4, accuracy=1e-3)

    def _pruned(self, start: Fit, state: Fit) -> Fit:
        """Drop causes that are none, and those that others have made superfluous."""
        state = self._renamed(state)
        state = self._parted(state)
        checked: set[Candidate] = set()
        while True:
            worths = self.problem.worths(state)
            needed = self._needed(start, state)
            doubtful = [
                k
                for k, cause in enumerate(state.model.causes)
                if cause not in checked and worths[k] < CLEAR * needed
            ]
            if not doubtful:
                return state
            k = min(doubtful, key=lambda k: worths[k])
            known = self.problem.slopes(state)
            smaller = self.problem.fitted(state.model.without(k), known, rounds=6, accuracy=1e-2)
            if self.worthwhile(start, smaller, state):
                checked.add(state.model.causes[k])
            else:
                state = self._renamed(self._settled(smaller.model))

    def _renamed(self, state: Fit) -> Fit:
        """Give causes the names that their parameters deserve, and drop those that are none."""
        model = state.model
        taken = {(c.effect, c.place) for c in model.causes}
        for k in reversed(range(len(model.causes))):
            cause, values = model.causes[k], model.values(k)
            if not degenerate(self.problem, cause, values):
                continue
            other = simpler(cause, values)
            model = model.without(k)
            if other is not None and (other[0].effect, other[0].place) not in taken:
                model = model.joined(*other)
        return state if model is state.model else self._settled(model)

    def _parted(self, state: Fit) -> Fit:
        """Keep of events that happen at once the one that is worth most: they are one."""
        model = state.model
        order = np.argsort(self.problem.worths(state))
        gone: list[int] = []
        for k in order.tolist():
            own = model.causes[k], model.values(k)
            others = [n for n in range(len(model.causes)) if n != k and n not in gone]
            if any(at_once(own, (model.causes[n], model.values(n))) for n in others):
                gone.append(k)
        for k in sorted(gone, reverse=True):
            model = model.without(k)
        return self._settled(model, self.problem.slopes(state)) if gone else state

    def _needed(self, start: Fit, state: Fit) -> float:
        """Return the fall of squares that a cause beside all others must be worth."""
        return len(state.left) * max(LEAST_IN_ONE, form_power(self.problem, start, state))

    def _challenge(self, found: Found) -> None:
        """
        Let every other candidate take the place of each cause; keep whoever fits better.

        One cause after the other, round and round, until each has stood its ground.
        """
        self._merge(found)
        changed = bool(self._stood)
        replaced = 0
        stood = self._stood
        while waiting := [c for c in found.final.model.causes if c not in stood]:
            cause = waiting[0]
            self.report(
                f'challenging {cause.effect} at {cause.place}', min(0.84, 0.5 + 0.03 * len(stood))
            )
            state = found.final
            without = self._without(found, state.model.causes.index(cause))
            rivals = self._challengers(found, cause, without)
            better = self._better(found, cause, rivals) if replaced < REPLACED else None
            if better is None:
                stood[cause] = without, rivals
                continue
            replaced += 1
            changed = True
            found.states[-1] = self._pruned(found.start, better)
            # who stood only just did so beside the one that has gone
            stood = {c: s for c, s in stood.items() if self._clearly(state, *s)}
        causes = found.final.model.causes
        found.rivals = [stood[c][1] for c in causes]
        found.without = [
            self._without(found, k) if changed else stood[c][0] for k, c in enumerate(causes)
        ]
        self._stood = {c: s for c, s in stood.items() if self._clearly(found.final, *s)}

    def _merge(self, found: Found) -> None:
        """Let one effect take the place of two at one place, if it does as well."""
        for one, two in combinations(found.final.model.causes, 2):
            causes = found.final.model.causes
            if one.place != two.place or not {one, two} <= set(causes):
                continue
            state = found.final
            model = state.model
            for k in sorted((causes.index(one), causes.index(two)), reverse=True):
                model = model.without(k)
            smaller = self.problem.fitted(model, self.problem.slopes(state), 8, 1e-3)
            among = [c for c in self.candidates if c.place == one.place]
            proposals = best_of(self.screened(smaller, None, [], among))
            rivals = self.fitted(smaller, proposals, smaller.cost - state.cost)
            rivals = self._sharpened(found, smaller, rivals)
            allowed = tie(self.problem, state) * len(state.left)
            if rivals and rivals[0].fit.cost - state.cost < allowed:
                self._stood = {}
                found.states[-1] = self._settled(rivals[0].fit.model)

    def _clearly(self, state: Fit, without: Fit, rivals: Sequence[Rival]) -> bool:
        """Return whether a cause is missed so much more than any rival makes up for."""
        missed = without.cost - state.cost
        made_up = without.cost - min((r.fit.cost for r in rivals), default=without.cost)
        behind = missed - made_up
        return (
            behind > CLEAR * tie(self.problem, state) * len(state.left) or made_up < 0.5 * missed
        )

    def _challengers(self, found: Found, cause: Candidate, without: Fit) -> list[Rival]:
        """Return the fits of other candidates in the place of a cause, best first."""
        proposals = found.proposals
        if without is not found.start:
            among = self._likely(found, cause)
            proposals = best_of(self.screened(without, None, [cause], among))
        proposals = [p for p in proposals if p.candidate != cause]
        rivals = self.fitted(without, proposals, without.cost - found.final.cost)
        return self._sharpened(found, without, rivals)

    def _without(self, found: Found, k: int) -> Fit:
        """Return the final state without one cause, everything else fitted again."""
        state = found.final
        if len(state.model.causes) == 1:
            return found.start
        known = self.problem.slopes(state)
        return self.problem.fitted(state.model.without(k), known, rounds=8, accuracy=1e-3)

    def _ordered(self, found: Found) -> None:
        """Replace the states by one for each cause, the one that is missed most first."""
        final = found.final
        worth = [without.cost for without in found.without]
        order = sorted(range(len(worth)), key=lambda k: -worth[k])
        states = [found.start]
        for count in range(1, len(order)):
            model = final.model
            for k in sorted(order[count:], reverse=True):
                model = model.without(k)
            known = self.problem.slopes(final)
            states.append(self.problem.fitted(model, known, rounds=8, accuracy=1e-2))
        found.states = [*states, final] if order else states

    def _likely(self, found: Found, cause: Candidate) -> list[Candidate] | None:
        """Return who might replace one of many causes: kin, and what explained much at a time."""
        if len(found.final.model.causes) < MANY:
            return None
        kin = [c for c in self.candidates if c.effect == cause.effect or c.place == cause.place]
        telling = [c for c in self.candidates if (c.effect, c.place) in found.telling]
        return list(dict.fromkeys([*kin, *telling]))

    def _sharpened(self, found: Found, without: Fit, rivals: list[Rival]) -> list[Rival]:
        """Fit the rivals that come near as carefully as the cause that they challenge."""
        state = found.final
        near = state.cost + 0.05 * max(without.cost - state.cost, 0.0)
        near += tie(self.problem, state) * len(state.left)
        close = [r for r in rivals if r.fit.cost < near][:CLOSE]
        equal = state.cost + tie(self.problem, state) * len(state.left)

        def careful(rival: Rival) -> Fit:
            # derivatives of another state stall a fit: two places then seem to differ that do not
            fit = self.problem.fitted(rival.fit.model, rounds=10, accuracy=1e-3)
            if fit.cost <= equal:
                return fit
            return self.problem.fitted(fit.model, rounds=6, accuracy=1e-3)

        fits = list(self._pool.map(careful, close))
        sharp = [Rival(r.candidate, fit) for r, fit in zip(close, fits, strict=True)]
        return sorted([*sharp, *(r for r in rivals if r not in close)], key=_judged)

    def _better(self, found: Found, cause: Candidate, rivals: Sequence[Rival]) -> Fit | None:
        """Return a fit with another candidate: one that fits better, or as well and is simpler."""
        state = found.final

        def wins(rival: Candidate, fit: Fit) -> bool:
            more = len(rival.parameters) - len(cause.parameters)
            ahead = (state.cost - fit.cost) / len(state.left)
            if more < 0:
                return ahead > -tie(self.problem, state)
            if more > 0:
                return ahead > tie(self.problem, fit)
            return fit.cost < 0.99 * state.cost

        for rival in rivals[:2]:
            if wins(rival.candidate, rival.fit):
                trial = self._settled(rival.fit.model, self.problem.slopes(state))
                if wins(rival.candidate, trial):
                    return trial
        return None
