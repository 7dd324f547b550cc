"""
The search for causes: which effects, together, explain what is left.

Each round adds the set of candidates that together explain most, to first order; everything is
then fitted, and every cause must still be worth having. At the end each one is challenged by all
others in its place. The order in which causes were found therefore decides nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tendon_ros.diagnose.asking import asked_again, may_be_signless
from tendon_ros.diagnose.bent import at_once
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.everywhere import thinned_out, without_idle
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.guesses import astray, better, far_off, under_way
from tendon_ros.diagnose.memory import Memory
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.steps import best_of, CORRECTED, Report, Steps
from tendon_ros.diagnose.undoing import undoing
from tendon_ros.diagnose.valleys import from_afar, SETTLED, started
from tendon_ros.diagnose.worth import (
    beyond_laws,
    hopeless,
    LEAST,
    open_question,
    outweighed,
    stands_out,
    worthwhile,
)
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.screening import Proposal, Screen, Seen
from tendon_ros.identify.subset import Member, Subsets

#: causes; and from how many on each has to explain most of some channel, or the search goes astray
MOST, MANY = 10, 5
AT_ONCE = 3  # causes that a round adds: to first order, the fourth only imitates
ROUNDS = 6  # of looking for more causes
#: part of the cost that a challenge may leave for another look where much is left, and the same
#: causes for it to be another state
GAINED = 0.8


class Search:
    """
    Searches one problem.

    :param problem: the fitted bins.
    :param candidates: all that may be named.
    :param jobs: threads.
    :param report: called with what is being done and the part that is done.
    :param memory: of the steps of an interrupted search.
    :param begun: what an earlier search found in the same recordings.
    :param patience: once it has run out, the search ends with what it has.
    """

    def __init__(
        self,
        problem: Problem,
        candidates: Sequence[Candidate],
        jobs: int = 2,
        report: Report = lambda _what, _done: None,
        memory: Memory | None = None,
        begun: Model | None = None,
        patience: Patience | None = None,
    ) -> None:
        self.problem = problem
        self._steps = Steps(problem, candidates, jobs, report, patience)
        # a first look from where nothing is known tells later whom to look at more closely
        self._seen: Seen = {}
        self._challenge = Challenge(self._steps, self._seen)
        self._memory = memory
        self._begun = begun
        # the last state that one cause was looked for beside, among whom, and what was found
        self._tried: tuple[Fit, Sequence[Proposal], Fit | None] | None = None

    def run(self) -> Found:
        """
        Search.

        :return: what was found; what holds of all that is usual, and no more, where channels
            should weigh by what it leaves of them.
        """
        found = Found()
        self._steps.report('fitting the tolerances', 0.0)
        state = started(self._steps)
        found.states.append(state)
        self._steps.report('screening the candidates', 0.03)
        screen = Screen(self.problem, state, self._seen)
        proposals = self._steps.screened(screen)
        found.proposals = best_of(proposals)
        self._steps.candidates = asked_again(self._steps.candidates, proposals)
        for model in (self._memory.models() if self._memory else [])[1:]:
            state = self._steps.settled(model)
            found.states.append(state)
        if self._begun is not None and self._begun.causes and len(found.states) == 1:
            earlier = self._steps.settled(self._begun)
            if self.problem.by_misfit:  # it is what was needed of all that is usual
                earlier = without_idle(self._steps, earlier)
            else:
                earlier = self._steps.pruned(found.start, earlier)
            if self._believed(found, found.start, earlier):
                state = earlier
                found.states.append(state)
        turn = len(found.states) - 1
        challenged: Fit | None = None
        while True:
            grown: Fit | None = None
            asks = open_question(self.problem, state)
            asks |= turn == 0 and bool(_promising(state, proposals))
            if asks and turn < ROUNDS and not self._ends(state):
                self._steps.report(f'looking for causes, round {turn + 1}', 0.05 + 0.1 * turn)
                if state is not found.start:
                    screen = Screen(self.problem, state, self._seen)
                    proposals = self._steps.screened(screen)
                look = self._first if turn == 0 else self._grown
                grown = look(found, state, screen, proposals)
                if found.unweighed is not None:
                    return found
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
            brief = self._of_a_machine(found)
            self._challenge.of(found, brief=brief)
            if found.final.model.causes == state.model.causes:
                break
            gained = found.final.cost < GAINED * state.cost
            if (brief or self._imitates(found)) and not gained:
                break
            state = challenged = found.final
        self._ordered(found)
        return found

    def _first(
        self, found: Found, before: Fit, screen: Screen, proposals: Sequence[Proposal]
    ) -> Fit | None:
        """Return what the first round finds, from wherever guesses may have to begin."""
        many = self._of_many(found)
        grown: Fit | None = None
        if many is None:
            grown = self._grown(found, before, screen, proposals)
            if astray(self.problem, found.start, grown):
                grown = better(self.problem, grown, self._from_the_file(found))
        best = better(self.problem, many, grown, self._without_sign(found))
        if many is not None and best is many and outweighed(self.problem, found.start, many):
            found.unweighed = many
        return best

    def _without_sign(self, found: Found) -> Fit | None:
        """Return the best state in which a sensor knows no sign: guesses were fitted to one."""
        fits = []
        for candidate in self._steps.candidates:
            if may_be_signless(self.problem, candidate):
                lost = find(candidate.effect).typical
                alone = self.problem.empty.joined(candidate, lost)
                fits += [
                    from_afar(self._steps, found.start.model.joined(candidate, lost)),
                    self._of_many(found, alone),
                    self._from_the_file(found, alone),
                ]
        believed = [fit for fit in fits if fit and self._believed(found, found.start, fit)]
        return better(self.problem, *believed)

    def _ends(self, state: Fit) -> bool:
        """
        Return whether no more causes are looked for: there is no time, or no end.

        Where channels weigh by what stays of them, and many causes are needed already, whatever
        comes next fits what laws get wrong: nothing that no fit has seen is foretold better.
        """
        many = self.problem.by_misfit and len(state.model.causes) > MANY
        return many or self._steps.patience.over

    def _imitates(self, found: Found) -> bool:
        """Return whether further causes would only help to imitate one that is not known."""
        final = found.final
        return hopeless(self.problem, found.start, final) or bool(undoing(self.problem, final))

    def _of_a_machine(self, found: Found) -> bool:
        """Return whether guesses had far to go, and more stays than laws can be wrong by."""
        if not far_off(self.problem, found.start):
            return False
        # where channels weigh by what stays of them, that has been seen before
        beyond = beyond_laws(self.problem, found.start, found.final)
        return self.problem.by_misfit or beyond

    def _from_the_file(self, found: Found, known: Model | None = None) -> Fit | None:
        """Return causes that are found beside the numbers of the file as they are."""
        file = self.problem.fitted(known or self.problem.empty, rounds=0)
        # where nothing has moved far, signatures are what they are beside the tolerances fitted
        seen = None if far_off(self.problem, found.start) else self._seen
        screen = Screen(self.problem, file, seen)
        proposals = self._steps.screened(screen)
        grown = self._grown(found, found.start, screen, proposals)
        # what is there or not shows only once the guesses have followed
        for asked in (proposals, [p for p in proposals if not p.sizes]):
            alone = self._alone(file, asked)
            if alone is not None and self._believed(found, found.start, alone):
                grown = better(self.problem, grown, alone)
        return grown

    def _of_many(self, found: Found, known: Model | None = None) -> Fit | None:
        """Return what is needed of what is known and usually there, if guesses ask for it."""
        if not far_off(self.problem, found.start):
            return None
        # guesses that have explained nearly all have little to come back for
        if self.problem.structured(found.start.left) < SETTLED:
            return None
        fit = thinned_out(self._steps, found.start, MOST, known)
        # where it leaves much, it is something else that is behind it
        if fit is None or hopeless(self.problem, found.start, fit):
            return None
        return fit if self._believed(found, found.start, fit) else None

    def _alone(self, state: Fit, proposals: Sequence[Proposal]) -> Fit | None:
        """Return the state with the one cause more that fits best; None without proposals."""
        if self._tried and self._tried[0] is state and self._tried[1] is proposals:
            return self._tried[2]
        rivals = self._steps.fitted(state, best_of(proposals), 0.0) if proposals else []
        found: Fit | None = None
        if rivals:
            best, *others = (r.fit for r in rivals)
            fits = [best, *under_way(self.problem, state, best, others)]
            settled = [self._steps.settled(fit.model) for fit in fits]
            found = min(settled, key=lambda fit: fit.cost)
        self._tried = state, proposals, found
        return found

    def _grown(
        self, found: Found, before: Fit, screen: Screen, proposals: Sequence[Proposal]
    ) -> Fit | None:
        """Return a state with the causes that explain most together; None where none does."""
        state = screen.fit
        room = MOST - len(state.model.causes)
        if room <= 0:
            return None
        # guesses that have gone far to do without causes come back for all of them together
        most = room if far_off(self.problem, found.start) else min(room, AT_ONCE)
        members = self._subset(screen, proposals, most)
        if not members:
            # numbers within tolerance that hide one beyond it cost more than what they leave
            alone = self._alone(state, _promising(state, proposals))
            return alone if alone and self._believed(found, before, alone) else None
        model = state.model
        for member in members:
            candidate = member.proposal.candidate
            model = model.joined(candidate, candidate.coordinates.values(member.z))
        # sizes and shapes lie along curved valleys: more of them, more steps
        fit = self.problem.fitted(model, self.problem.slopes(state), rounds=12, accuracy=1e-2)
        model = self._steps.parted(fit)
        fit = self._steps.pruned(
            found.start, self._steps.settled(model, self.problem.slopes(state))
        )
        if not state.model.causes:
            fit = self._simplest(found, before, state, proposals, fit)
        elif not self._believed(found, before, fit):
            # first order hardly tells the last of many: see which one fits
            alone = self._alone(state, proposals)
            fit = fit if alone is None else self._steps.pruned(found.start, alone)
        return fit if self._believed(found, before, fit) else None

    def _believed(self, found: Found, before: Fit, fit: Fit) -> bool:
        """
        Return whether a state has causes that the one before has not, and needs them.

        Or the same ones leave much less: what came and went has led out of a valley.
        """
        new = set(fit.model.causes) - set(before.model.causes)
        if not new:
            return bool(fit.model.causes) and fit.cost < GAINED * before.cost
        if not worthwhile(self.problem, found.start, before, fit):
            return False
        few = len(fit.model.causes) <= MANY
        return few or stands_out(self.problem, found.start, before, fit)

    def _simplest(
        self, found: Found, before: Fit, state: Fit, proposals: Sequence[Proposal], many: Fit
    ) -> Fit:
        """
        Return the one cause that fits best where it does as well as many, else the many.

        To first order, smooth effects imitate one that is far from linear.
        """
        one = self._alone(state, proposals)
        if one is None or not self._believed(found, before, one):
            return many
        if len(many.model.causes) < 2:
            return min(one, many, key=lambda fit: fit.cost)
        return many if worthwhile(self.problem, found.start, one, many) else one

    def _subset(self, screen: Screen, proposals: Sequence[Proposal], most: int) -> list[Member]:
        """Return the proposals that together explain most, to first order."""
        telling = [p for p in proposals[:CORRECTED] if p.gain > 0.0]
        model = screen.fit.model
        known = [(c, model.values(k)) for k, c in enumerate(model.causes)]
        telling = [
            p for p in telling if not any(at_once((p.candidate, p.values), e) for e in known)
        ]
        signatures = list(self._steps.pool.map(screen.signatures, telling))
        kept = [(p, s) for p, s in zip(telling, signatures, strict=True) if s is not None]
        if not kept:
            return []
        sets = Subsets([p for p, _ in kept], [s for _, s in kept], screen.left)
        return sets.best(LEAST * len(screen.left), most)

    def _ordered(self, found: Found) -> None:
        """Replace the states by one for each cause that can be, what is missed most first."""
        final = found.final
        worth = [without.cost for without in found.without]
        order = sorted(range(len(worth)), key=lambda k: -worth[k])
        states = [found.start]
        for count in range(1, len(order)):
            model = final.model.without(*order[count:])
            known = self.problem.slopes(final)
            fit = self.problem.fitted(model, known, rounds=8, accuracy=1e-2)
            if np.isfinite(fit.cost):
                states.append(fit)
        found.states = [*states, final] if order else states


def _promising(state: Fit, proposals: Sequence[Proposal]) -> list[Proposal]:
    """
    Return the proposals that explain enough to be believed, to first order.

    Where samples are few and noisy no structure is to be seen in what is left, and yet a cause
    that turns with the motion may stand out.
    """
    return [p for p in proposals if p.gain > LEAST * len(state.left)]
