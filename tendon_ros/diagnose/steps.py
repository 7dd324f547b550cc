"""The steps that looking for causes and challenging them are made of."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bent import at_once, biased, degenerate
from tendon_ros.diagnose.clock import told_apart
from tendon_ros.diagnose.excusing import excuses, needs_excuse, raised, without_excuses
from tendon_ros.diagnose.found import judged_cost, Rival
from tendon_ros.diagnose.parts import as_one, plain, simpler
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.worth import needed, worthwhile
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.first_order_worth import worths
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.screening import Proposal, Screen, Seen

FloatArray = NDArray[np.float64]
Report = Callable[[str, float], None]

CORRECTED = 36  # proposals that are judged again at their own size
SHORTLIST = 10  # rivals of a cause that are fitted
BRIEF = 4  # and where so much is left that only one which explains most of it matters
#: times what is needed that a cause is worth, to first order, if it need not be left out to see
CLEAR = 10.0
#: part of what a fit would explain that first order is sure to see
FIRST_ORDER_SEES = 0.4
#: the same of the effect in question at other places, and of the proposals that come first
KIN_SEEN, LEADERS = 0.1, 4


class Steps:
    """
    Screens, fits and prunes on one problem.

    :param problem: the fitted bins.
    :param candidates: all that may be named.
    :param jobs: threads.
    :param report: called with what is being done and the part that is done.
    :param patience: once it has run out, nothing more is begun.
    """

    def __init__(
        self,
        problem: Problem,
        candidates: Sequence[Candidate],
        jobs: int,
        report: Report,
        patience: Patience | None = None,
    ) -> None:
        self.problem = problem
        #: all that may be named, and of these who is asked
        self.everybody = self.candidates = tuple(candidates)
        self._allowed = {(c.effect, c.place): c for c in candidates}
        self.report = report
        self.patience = patience or Patience()
        self.pool = ThreadPoolExecutor(jobs)
        self._glanced: Seen = {}

    def screened(
        self,
        screen: Screen,
        leave: Sequence[Candidate] = (),
        among: Sequence[Candidate] | None = None,
    ) -> list[Proposal]:
        """
        Return the proposals of all candidates, two of each at most, best first.

        :param screen: of what holds already.
        :param leave: candidates to leave out.
        :param among: those to ask; all where None.
        :return: the proposals; those that explain most are judged again at their own size.
        """
        causes = screen.fit.model.causes
        # what happens at a time may happen again, in another recording
        lasting = [c for c in causes if not c.instants]
        out = {(c.effect, c.place) for c in (*lasting, *leave)}
        everyone = self.candidates if among is None else among
        asked = [c for c in everyone if (c.effect, c.place) not in out]
        first = [
            p
            for proposals in self.pool.map(screen.proposals, asked)
            for p in proposals[:2]
            if p.candidate not in causes
        ]
        first.sort(key=lambda p: (not screen.suspects(p.candidate), -p.gain))
        again = list(self.pool.map(screen.corrected, first[:CORRECTED]))
        return sorted([*again, *first[CORRECTED:]], key=lambda p: -p.gain)

    def glanced(self, state: Fit, leave: Sequence[Candidate] = ()) -> list[Proposal]:
        """
        Return proposals of all candidates that last, by a look at a few of many recordings.

        :param state: what holds already.
        :param leave: candidates to leave out.
        :return: the proposals, best first, with gains as if all recordings were like these.
        """
        glance = self.problem.rougher()
        seen = Screen(glance, glance.fitted(state.model, rounds=0), self._glanced)
        share = len(state.left) / len(seen.left)
        lasting = [c for c in self.candidates if not c.instants]
        found = self.screened(seen, leave, lasting)
        return [replace(p, gain=share * p.gain) for p in found]

    def fitted(
        self,
        state: Fit,
        proposals: Sequence[Proposal],
        needed: float,
        kin: str = '',
        *,
        brief: bool = False,
    ) -> list[Rival]:
        """
        Fit the proposals that may explain as much as is needed, each beside what holds already.

        :param state: what holds already.
        :param proposals: best first, one of each candidate.
        :param needed: by how much squares must fall.
        :param kin: an effect that is asked at more places: one preload may do what another does.
        :param brief: whether only fits matter that are far better.
        :return: the fits, best first.
        """
        near = [
            p
            for rank, p in enumerate(proposals)
            if p.gain > FIRST_ORDER_SEES * needed
            or (p.gain > KIN_SEEN * needed and (p.candidate.effect == kin or rank < LEADERS))
        ]
        chosen = near[: BRIEF if brief else SHORTLIST] or list(proposals[:1])
        known = self.problem.slopes(state)

        def one(proposal: Proposal) -> Rival:
            model = state.model.joined(proposal.candidate, proposal.values)
            # sizes and shapes lie along curved valleys: more of them, more steps
            rounds = 6 if brief else 6 * len(proposal.candidate.parameters)
            # a sensor that loses its sign turns all derivatives
            own = known if proposal.sizes else None
            fit = self.problem.fitted(model, own, rounds=max(rounds, 6), accuracy=1e-2)
            return Rival(proposal.candidate, fit)

        found = [
            r
            for r in self.pool.map(one, chosen)
            if np.isfinite(r.fit.cost)
            and not degenerate(self.problem, r.candidate, r.fit.model.values(-1))
            and not needs_excuse(self.problem, r.fit.model, len(state.model.causes))
        ]
        return sorted(without_excuses(self.problem, state, found), key=judged_cost)

    def settled(self, model: Model, known: Mapping[str, FloatArray] | None = None) -> Fit:
        """
        Fit with derivatives that are known already, then with those where the model now is.

        :param model: where to begin.
        :param known: derivatives by the unknown's label.
        :return: the fit.
        """
        fit = self.problem.fitted(model, known, rounds=8, accuracy=1e-3, timed=False)
        if known is None and not np.abs(fit.model.moved).max(initial=0.0) > 0.5:
            return self.problem.timed(fit, rounds=8, accuracy=1e-3)
        return self.problem.fitted(fit.model, rounds=6, accuracy=1e-3)

    def pruned(self, start: Fit, state: Fit, stood: Collection[Candidate] = ()) -> Fit:
        """
        Drop causes that are none, and those that others have made superfluous.

        :param start: without any cause.
        :param state: with all of them.
        :param stood: those that were there before.
        :return: with those that are worth having.
        """
        state = self.renamed(state, stood)
        model = self.parted(state)
        if model is not state.model:
            state = self.settled(model, self.problem.slopes(state))
        apart = told_apart(self.problem, state.model)
        if apart is not None:
            state = self.settled(apart)
        checked: set[Candidate] = set()
        rough = False
        while True:
            worth = worths(self.problem, state)
            least = needed(self.problem, start, state)
            doubtful = [
                k
                for k, cause in enumerate(state.model.causes)
                if cause not in checked and worth[k] < CLEAR * least
            ]
            if doubtful:
                k = min(doubtful, key=lambda k: worth[k])
                known = self.problem.slopes(state)
                smaller = self.problem.fitted(state.model.without(k), known, 6, accuracy=1e-2)
                if worthwhile(self.problem, start, smaller, state):
                    checked.add(state.model.causes[k])
                else:
                    state, rough = smaller, True
            elif rough:
                # carefully only once several have gone; what then is doubtful is asked anew
                # those that are left came in as causes, and may sink now that others have gone
                state, rough = self.renamed(self.settled(state.model), state.model.causes), False
                checked.clear()
            else:
                return self.raised(state)

    def raised(self, state: Fit) -> Fit:
        """
        Fit limits that have sunk once more from above: below, nothing tells the way up.

        :param state: with causes.
        :return: the better fit.
        """
        model = raised(self.problem, state.model)
        fit = state if model is state.model else self.settled(model)
        return min(state, fit, key=lambda one: one.cost)

    def renamed(self, state: Fit, stood: Collection[Candidate] = ()) -> Fit:
        """
        Give causes the names that they deserve, join what is one, and drop what is none.

        :param state: with causes that a fit may have bent.
        :param stood: those that were there before: they may sink to excuses.
        :return: the same where nothing has another name, else fitted again.
        """
        model = state.model
        taken = {(c.effect, c.place) for c in model.causes}
        for k in reversed(range(len(model.causes))):
            cause, values = model.causes[k], model.values(k)
            # who sinks is kept for those beside it
            kept = cause in stood and len(model.causes) > 1
            idle = not kept and excuses(self.problem, model, k)
            if idle or needs_excuse(self.problem, model, k):
                model = model.without(k)
                continue
            other = simpler(cause, values) or plain(self.problem, model, k)
            other = other or biased(self.problem, cause, values)
            if other is None and not degenerate(self.problem, cause, values):
                continue
            model = model.without(k)
            if other is None:
                continue
            name = (other[0].effect, other[0].place)
            known = self._allowed.get(name)
            if known is not None and name not in taken:
                model = model.joined(known, _instead(known, other[1]))
        model = as_one(model)
        return state if model is state.model else self.settled(model)

    def parted(self, state: Fit) -> Model:
        """
        Keep of events that happen at once the one that is worth most: they are one.

        :param state: with its derivatives.
        :return: its model, with fewer causes where some happen at once.
        """
        model = state.model
        order = np.argsort(worths(self.problem, state))
        gone: list[int] = []
        for k in order.tolist():
            own = model.causes[k], model.values(k)
            others = [n for n in range(len(model.causes)) if n != k and n not in gone]
            if any(at_once(own, (model.causes[n], model.values(n))) for n in others):
                gone.append(k)
        return model.without(*gone) if gone else model


def _instead(candidate: Candidate, more: Mapping[str, float]) -> dict[str, float]:
    """Return what stands instead of the file's effect where more of it was found beside it."""
    given = dict(candidate.given)
    neutral = find(candidate.effect).neutral
    return {name: given.get(name, neutral[name]) + size - neutral[name]
            for name, size in more.items()}  # fmt: skip
