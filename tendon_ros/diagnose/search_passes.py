"""
Search passes, or looks at recordings: a search, and others where its end asks for them.

What a search ends with says on what footing it should have stood: how channels weigh, which sensor
has a sign, what is noise, how well the numbers of the file are known. Each rule here is one such
footing that turned out otherwise; it gives a reason, changes the footing, and searches again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tendon_ros.diagnose.asking import lost, signless
from tendon_ros.diagnose.beyond import beyond_laws, hopeless
from tendon_ros.diagnose.creeping import doubting, left_to_chance
from tendon_ros.diagnose.enough import KEPT
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.memory import Memory
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.search import GAINED, Search
from tendon_ros.diagnose.spread import loose
from tendon_ros.diagnose.unexplained import (
    stands_out_in_a_block,
    surprising,
    unexplained,
)
from tendon_ros.diagnose.worth import worthwhile
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.multistart import swings

Report = Callable[[str, float], None]

LOOSENED = 2  # times that the numbers of a file may turn out to be less well known than supposed


class Looks:
    """
    Looks at one set of recordings until no rule asks for another look.

    :param ready: the recordings.
    :param candidates: all that may be named.
    :param jobs: threads.
    :param report: called with what is being done and the part that is done.
    :param memory: of the steps of an interrupted search.
    :param patience: once it has run out, no further look is taken.
    """

    def __init__(
        self,
        ready: Prepared,
        candidates: Sequence[Candidate],
        jobs: int,
        report: Report,
        memory: Memory | None,
        patience: Patience,
    ) -> None:
        by = memory.weighed() if memory else None
        #: the recordings as the last look saw them
        self.ready = ready.weighed(by) if by is not None else ready
        self._candidates = candidates
        self._jobs = jobs
        self._report = report
        self._memory = memory
        self._patience = patience
        #: what the last look that counts has found
        self.found = self._look(by, memory)

    def taken(self) -> tuple[Prepared, Found]:
        """
        Look again for every reason that there is, one rule after the other.

        :return: the recordings as the last look saw them, and what was found.
        """
        for rule in (
            self._weighed,
            self._without_sign,
            self._back_with_guesses,
            self._without_events,
            self._heard_again,
            self._otherwise_held_out,
            self._allowing,
            self._loosened,
        ):
            rule()
        return self.ready, self.found

    def _look(
        self,
        begun: Model | None,
        memory: Memory | None = None,
        among: Sequence[Candidate] | None = None,
    ) -> Found:
        """Search, from a model or from nothing, among all candidates or some."""
        asked = self._candidates if among is None else among
        return Search(
            self.ready.problem,
            asked,
            self._jobs,
            self._report,
            memory,
            begun,
            self._patience,
            self.ready.held,
        ).run()

    def _again(self, why: str) -> None:
        self._report(f'looking again: {why}', 0.0)

    def _from(self, why: str, begun: Model) -> None:
        """Look again from a model, and keep what that finds if it is clearly better."""
        self._again(why)
        other = self._look(begun)
        if other.final.cost < GAINED * self.found.final.cost:
            self.found = other

    def _weighed(self) -> None:
        """Let channels weigh by what is left of them, where a machine is far from its file."""
        if self.found.unweighed is None:
            return
        self._again('channels weigh by what stays of them')
        by = self.found.unweighed.model
        self.ready = self.ready.weighed(by)
        if self._memory is not None:
            self._memory.weigh(by)
        self.found = self._look(by, self._memory)

    def _without_sign(self) -> None:
        """
        Begin with a sensor that has lost its sign.

        Guesses go far to do without it, and what is found beside them imitates it: so it is asked
        alone. Beside a constant torque next to nothing turns round: there it comes last.
        """
        for sign in signless(self.ready.problem, self._candidates):
            found, problem = self.found, self.ready.problem
            first, last = (found.start, problem.begun), (found.final, found.final.model)
            for before, model in (first, last):
                imitated = beyond_laws(problem, self.found.start, self.found.final)
                known = sign in self.found.final.model.causes
                if not imitated or known or self._patience.over:
                    break
                begun = problem.fitted(lost(model, sign))
                # begun with a sign that nobody needs, a search would only do the same again
                if not worthwhile(problem, self.found.start, before, begun):
                    continue
                self._from('a sensor may have lost its sign', begun.model)

    def _back_with_guesses(self) -> None:
        """
        Begin with what was found and guesses where they began.

        On the way to it they may have gone where they did best without it.
        """
        problem, final = self.ready.problem, self.found.final
        if not final.model.causes or self._patience.over or not swings(problem):
            return
        model = problem.begun
        for k, cause in enumerate(final.model.causes):
            model = model.joined(cause, final.model.values(k))
        begun = problem.fitted(model)
        if begun.cost < GAINED * final.cost:
            self._from('guesses went astray on the way to what was found', begun.model)

    def _without_events(self) -> None:
        """
        Do without what was taken for an event.

        Whatever happened, a push explains most of what it left for a while, and what else is found
        beside it is not what is there.
        """
        happened = {(c.effect, c.place) for c in self.found.final.model.causes if c.instants}
        if not happened or not self._leaves_much():
            return
        self._again('without what was taken for an event')
        others = [c for c in self._candidates if (c.effect, c.place) not in happened]
        other = self._look(None, among=others)
        if other.final.cost < GAINED * self.found.final.cost:
            self.found = self._look(other.final.model)

    def _heard_again(self) -> None:
        """Take for noise only what still is: what stands in for the unknown may take some away."""
        again = self.ready.heard_again(self.found.final.model)
        if again.quieter(self.ready) and self._worth_more():
            self._again('what was taken for noise was not')
            self.ready = again
            self.found = self._look(self.found.final.model)

    def _otherwise_held_out(self) -> None:
        """
        Hold out other blocks: what stands in for the unknown foretells nothing in any.

        What happened in one block is fitted then. Where another one stands out instead, it was
        nothing that happened once.
        """
        whole = surprising(self.ready, self.found)
        # where no law is quite right, blocks stand out without anything that happened
        told = not self.ready.problem.by_misfit
        once = told and stands_out_in_a_block(self.ready, self.found)
        if not (whole or once) or not self._worth_more():
            return
        self._again('something happened in what was held out')
        before = self.ready, self.found
        self.ready = self.ready.moved(KEPT // 2)
        self.found = self._look(self.found.final.model)
        if not whole and stands_out_in_a_block(self.ready, self.found):
            self.ready, self.found = before

    def _allowing(self) -> None:
        """
        Doubt what laws may get wrong, where too much stays and much of it where friction holds.

        What stays there is chance, and outweighs what causes are worth elsewhere.
        """
        problem, start, final = self.ready.problem, self.found.start, self.found.final
        if not self._worth_more() or unexplained(self.ready, self.found, final) < NAMED:
            return
        if not left_to_chance(problem, start, final):
            return
        self._again('where friction holds, much of what stays is chance')
        self.ready, begun = doubting(self.ready, start.model, final.model)
        self.found = self._look(begun.model)

    def _loosened(self) -> None:
        """Know the file's numbers less well: some are no causes where others are off as far."""
        for _ in range(LOOSENED):
            wider = None if self._patience.over else loose(self.ready, self.found)
            if wider is None:
                break
            self._again('the numbers of the file are not that well known')
            known = wider.begun(self.ready, self.found)
            self.ready = self.ready.loosened(wider.looser)
            self.found = self._look(known)

    def _leaves_much(self) -> bool:
        """Return whether more stays than laws can be wrong by and noise is, and there is time."""
        beyond = beyond_laws(self.ready.problem, self.found.start, self.found.final)
        return beyond and not self.ready.problem.by_misfit and not self._patience.late

    def _worth_more(self) -> bool:
        """Return whether another search may tell more, and there is time for it."""
        hope = not hopeless(self.ready.problem, self.found.start, self.found.final)
        return hope and not self._patience.over
