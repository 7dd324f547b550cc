"""
The search for causes: which effects, together, explain what is left.

Each round adds the set of candidates that together explain most, to first order; everything is
then fitted, and every cause must still be worth having. At the end each one is challenged by all
others in its place. The order in which causes were found therefore decides nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tendon_ros.diagnose.asking import asked_again
from tendon_ros.diagnose.beyond import beyond_laws, hopeless
from tendon_ros.diagnose.cancelling import undoing
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.everywhere import without_idle
from tendon_ros.diagnose.first import FirstRound
from tendon_ros.diagnose.found import best_of, Found
from tendon_ros.diagnose.further import further
from tendon_ros.diagnose.guesses import far_off
from tendon_ros.diagnose.memory import Memory
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.rounds import MANY, promising, Round
from tendon_ros.diagnose.steps import Report, Steps
from tendon_ros.diagnose.valleys import started
from tendon_ros.diagnose.worth import open_question
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.screening import Screen, Seen

ROUNDS = 6  # of looking for more causes
FORETELL = 12  # causes at most of a machine, where blocks that were held out ask for them
GAINED = 0.8  # part of the cost that a challenge may leave for another look where much is left


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
    :param held: blocks that no fit sees: of a machine, they tell which causes more there are, and
        who may take the place of one.
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
        held: Problem | None = None,
    ) -> None:
        self.problem = problem
        # what laws get wrong is of no concern where channels weigh by their noise
        self._held = held if problem.by_misfit else None
        self._steps = Steps(problem, candidates, jobs, report, patience)
        # a first look from where nothing is known tells later whom to look at more closely
        self._seen: Seen = {}
        self._challenge = Challenge(self._steps, self._seen, self._held)
        self._memory = memory
        self._begun = begun

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
        self._steps.candidates = asked_again(self._steps.everybody, proposals)
        usual = Round(self._steps, state)
        first = FirstRound(self._steps, state, usual, self._seen)
        found.states.extend(self._earlier(usual, state))
        state = found.final
        self._asks(state)
        turn = len(found.states) - 1
        challenged: Fit | None = None
        looked: list[Fit] = []  # states beside which more causes were looked for
        asked_held = False
        while True:
            grown: Fit | None = None
            asks = open_question(self.problem, state)
            asks |= turn == 0 and bool(promising(state, proposals))
            if asks and turn < ROUNDS and not self._ends(state):
                looked.append(state)
                self._steps.report(f'looking for causes, round {turn + 1}', 0.05 + 0.1 * turn)
                if state is not found.start:
                    screen = Screen(self.problem, state, self._seen)
                    proposals = self._steps.screened(screen)
                if turn == 0:
                    grown = first.grown(screen, proposals)
                    found.unweighed = first.unweighed
                    if found.unweighed is not None:
                        return found
                    self._asks(grown)
                else:
                    grown = usual.grown(state, screen, proposals)
                turn += 1
            if grown is None and not asked_held:
                grown, asked_held = self._further(state), True
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
            if _known(looked, found.final):
                break
            state = challenged = found.final
        self._ordered(found)
        return found

    def _asks(self, state: Fit | None) -> None:
        """Ask everybody beside a lost sign: who leaves a trace was told beside none."""
        if state and any(cause.switches for cause in state.model.causes):
            self._steps.candidates = self._steps.everybody

    def _earlier(self, usual: Round, start: Fit) -> Iterator[Fit]:
        """Yield states of a search that was interrupted, or what one in the same data found."""
        kept = self._memory.models()[1:] if self._memory else []
        for model in kept:
            yield self._steps.settled(model)
        if self._begun is None or not self._begun.causes or kept:
            return
        state = self._steps.settled(self._begun)
        if self.problem.by_misfit:  # it is what was needed of all that is usual
            state = without_idle(self._steps, state)
        else:
            state = self._steps.pruned(start, state, self._begun.causes)
        if usual.believes(start, state):
            yield state

    def _ends(self, state: Fit) -> bool:
        """
        Return whether no more causes are looked for: there is no time, or no end.

        Where channels weigh by what stays of them, and many causes are needed already, what comes
        next may fit what laws get wrong: what was held out is asked then (:mod:`.further`).
        """
        many = self.problem.by_misfit and len(state.model.causes) > MANY
        return many or self._steps.patience.late

    def _further(self, state: Fit) -> Fit | None:
        """Return a state with further causes of a machine; None where there are none."""
        if self._held is None or not state.model.causes:
            return None
        self._steps.report('looking for causes that foretell what was held out', 0.45)
        grown = further(self._steps, state, self._held, FORETELL)
        return None if grown is state else grown

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


def _known(looked: Sequence[Fit], state: Fit) -> bool:
    """
    Return whether more causes were looked for beside the same ones before, and as good a fit.

    What a round adds and a challenge drops would come and go for as long as there is time.
    """
    causes = set(state.model.causes)
    return any(set(s.model.causes) == causes and not state.cost < GAINED * s.cost for s in looked)
