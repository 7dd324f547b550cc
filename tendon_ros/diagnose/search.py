"""
The search for causes: which effects, together, explain what is left.

Forward steps add the candidate that explains most when everything is refitted; after each step
every cause must still be worth having, and at the end each one is challenged by all others in its
place. The order in which causes were found therefore decides nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.form import degenerate, form_power, tie
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.memory import Memory
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.screening import Proposal, Screen

FloatArray = NDArray[np.float64]
Report = Callable[[str, float], None]

CORRECTED = 36  # proposals that are judged again at their own size
CLOSE = 6  # rivals that are fitted as carefully as the cause itself
SHORTLIST = 10  # candidates that are fitted at each step
MOST = 5  # causes
MANY = 3  # causes from which on not every candidate challenges each of them
ROUNDS = 3  # of challenges
#: part of the cost that one more parameter must save
PARAMETER = 0.004
#: part of the noise's power that a cause must explain, over all samples and over one channel
LEAST, LEAST_IN_ONE = 0.03, 0.12


def _judged(rival: Rival) -> float:
    """Return the cost of a fit, more where more parameters made it."""
    return rival.fit.cost * (1.0 + PARAMETER * len(rival.candidate.parameters))


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
        self._longest = max(float(s.time[-1]) for s in problem.rollouts.segments)

    def run(self) -> Found:
        """
        Search.

        :return: what was found.
        """
        found = Found()
        self.report('fitting the tolerances', 0.0)
        state = self._settled(self.problem.empty)
        found.states.append(state)
        for model in (self._memory.models() if self._memory else [])[1:]:
            state = self._settled(model)
            found.states.append(state)
        while len(state.model.causes) < MOST and self.open_question(state):
            step = len(state.model.causes)
            self.report(f'looking for cause {step + 1}', 0.05 + 0.1 * step)
            proposals = self.screened(state)
            if not found.proposals:
                found.proposals = proposals
            rivals = self.fitted(state, proposals)
            found.next_best = rivals
            if not rivals or not self.worthwhile(found.start, state, rivals[0].fit):
                break
            if not found.first:
                found.first = rivals[1:]
            state = self._settled(rivals[0].fit.model, self.problem.slopes(state))
            state = self._pruned(found.start, state)
            if len(state.model.causes) <= step:
                break
            found.states.append(state)
            if self._memory:
                self._memory.keep([s.model for s in found.states])
        self._challenge(found)
        return found

    # -- steps

    def screened(
        self,
        state: Fit,
        leave: Sequence[Candidate] = (),
        among: Sequence[Candidate] | None = None,
    ) -> list[Proposal]:
        """
        Return the best proposal of each candidate, best first.

        :param state: what holds already.
        :param leave: candidates to leave out.
        :param among: those to ask; all where None.
        :return: the proposals.
        """
        screen = Screen(self.problem, state)
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
        second = list(self._pool.map(screen.corrected, first[:CORRECTED])) + first[CORRECTED:]
        best: dict[Candidate, Proposal] = {}
        for p in sorted(second, key=lambda p: -p.gain):
            best.setdefault(p.candidate, p)
        return list(best.values())

    def fitted(self, state: Fit, proposals: Sequence[Proposal]) -> list[Rival]:
        """
        Fit the most promising proposals beside what holds already.

        :param state: what holds already.
        :param proposals: best first.
        :return: the fits, best first.
        """
        chosen = list(proposals[:SHORTLIST])
        pressed = self._pressed(state)
        chosen += [p for p in proposals[SHORTLIST:] if (p.candidate.effect, p.candidate.place)
                   in pressed]  # fmt: skip
        known = self.problem.slopes(state)

        def one(proposal: Proposal) -> Rival:
            values = pressed.get(
                (proposal.candidate.effect, proposal.candidate.place), proposal.values
            )
            model = state.model.joined(proposal.candidate, values)
            # sizes and shapes lie along curved valleys: more of them, more steps
            rounds = 6 * len(proposal.candidate.parameters)
            fit = self.problem.fitted(model, known, rounds=rounds, accuracy=1e-2)
            return Rival(proposal.candidate, fit)

        found = [
            r
            for r in self._pool.map(one, chosen)
            if np.isfinite(r.fit.cost)
            and not degenerate(r.candidate, r.fit.model.values(-1), self._longest)
        ]
        return sorted(found, key=_judged)

    def _pressed(self, state: Fit) -> dict[tuple[str, str], dict[str, float]]:
        """Return the tolerances that are at their ends: there, the number itself may be off."""
        found = {}
        for t, z in zip(self.problem.tolerances, state.model.moved, strict=True):
            low, high = t.axis.ends
            if z <= low + 0.02 or z >= high - 0.02:
                name = Candidate(t.effect, t.place).parameters[0].name
                found[t.effect, t.place] = {name: t.axis.value(z)}
        return found

    def worthwhile(self, start: Fit, before: Fit, after: Fit) -> bool:
        """
        Return whether one more cause is believed.

        :param start: without any cause.
        :param before: without this one.
        :param after: with it.
        :return: whether it explains more than noise and the form of the other laws can.
        """
        gain, in_one = self.gains(before, after)
        return (gain > LEAST or in_one > LEAST_IN_ONE) and gain > form_power(
            self.problem, start, before
        )

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
        """Drop causes that later ones have made superfluous."""
        k = 0
        while k < len(state.model.causes) - 1:
            known = self.problem.slopes(state)
            smaller = self.problem.fitted(state.model.without(k), known, rounds=6, accuracy=1e-2)
            if self.worthwhile(start, smaller, state):
                k += 1
            else:
                state = self._settled(smaller.model)
        return state

    def _challenge(self, found: Found) -> None:
        """Let every other candidate take the place of each cause; keep whoever fits better."""
        for left in reversed(range(ROUNDS)):
            state = found.final
            found.rivals, found.without = [], []
            better: Fit | None = None
            for k, cause in enumerate(state.model.causes):
                self.report(f'challenging {cause.effect} at {cause.place}', 0.6 + 0.05 * k)
                known = self.problem.slopes(state)
                smaller = state.model.without(k)
                without = found.start
                rivals = [r for r in found.first if r.candidate != cause]
                if len(state.model.causes) > 1 or not rivals:
                    without = self.problem.fitted(smaller, known, rounds=8, accuracy=1e-3)
                    among = self._likely(found, cause)
                    rivals = self.fitted(without, self.screened(without, [cause], among))
                found.without.append(without)
                rivals = self._sharpened(found, without, rivals)
                found.rivals.append(rivals)
                better = self._better(found, cause, rivals) if left else None
                if better is not None:
                    break
            if better is None:
                break
            found.states[-1] = better

    def _likely(self, found: Found, cause: Candidate) -> list[Candidate] | None:
        """Return who might replace one of many causes: kin, and what explained much at first."""
        if len(found.final.model.causes) < MANY:
            return None
        telling = [p.candidate for p in found.proposals[:CORRECTED]]
        kin = [c for c in self.candidates if c.effect == cause.effect or c.place == cause.place]
        return list(dict.fromkeys([*kin, *telling]))

    def _sharpened(self, found: Found, without: Fit, rivals: list[Rival]) -> list[Rival]:
        """Fit the rivals that come near as carefully as the cause that they challenge."""
        state = found.final
        near = state.cost + 0.05 * max(without.cost - state.cost, 0.0)
        near += tie(self.problem, found.start, state) * len(state.left)
        close = [r for r in rivals if r.fit.cost < near][:CLOSE]
        equal = state.cost + tie(self.problem, found.start, state) * len(state.left)

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
        allowed = tie(self.problem, found.start, state)
        simple = [
            r
            for r in rivals
            if len(r.candidate.parameters) < len(cause.parameters)
            and (r.fit.cost - state.cost) / len(state.left) <= allowed
        ]
        for rival in [*simple[:1], *rivals[:1]]:
            if rival in simple or rival.fit.cost < 0.99 * state.cost:
                trial = self._settled(rival.fit.model, self.problem.slopes(state))
                if rival in simple or trial.cost < 0.99 * state.cost:
                    return trial
        return None
