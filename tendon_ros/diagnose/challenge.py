"""
The challenge: every other candidate may take the place of each cause.

One cause after the other, round and round, until each has stood its ground.
"""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.ablation import rest_of, sets_the_unit
from tendon_ros.diagnose.bent import degenerate
from tendon_ros.diagnose.beyond import hopeless
from tendon_ros.diagnose.excusing import excused
from tendon_ros.diagnose.form import tie
from tendon_ros.diagnose.found import best_of, Found, judged_cost, Rival
from tendon_ros.diagnose.further import saved
from tendon_ros.diagnose.logged import is_logged
from tendon_ros.diagnose.one_body import divide, instead, merge
from tendon_ros.diagnose.parsimony import as_good, pays
from tendon_ros.diagnose.parts import is_part, is_plainer, plain
from tendon_ros.diagnose.rivals import (
    BETTER,
    CLOSE,
    close_ones,
    CREEPING,
    halfway,
    relieved,
    sharpened,
)
from tendon_ros.diagnose.steps import CLEAR, Steps
from tendon_ros.diagnose.valleys import nudged, waved
from tendon_ros.diagnose.warm_start import Begun
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.first_order_worth import worths
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.multistart import swings
from tendon_ros.identify.screening import Screen, Seen

#: rivals that are fitted as carefully as the cause itself where only far better ones matter
BRIEFLY = 2
REPLACED = 6  # causes at most that challenges replace


class Challenge:
    """
    Challenges causes; those that stood clearly are not asked again.

    :param steps: of the search.
    :param seen: signatures beside an earlier state, which tell whom to look at more closely.
    :param held: blocks that no fit sees, where they judge who may take a place as well.
    """

    def __init__(self, steps: Steps, seen: Seen, held: Problem | None = None) -> None:
        self._steps = steps
        self._problem = steps.problem
        self._begun = Begun(steps)
        self._stood: dict[Candidate, tuple[Fit, list[Rival]]] = {}
        # whom to ask when a cause that has stood is asked again, since another one was replaced
        self._near: dict[Candidate, list[Candidate]] = {}
        self._seen = seen
        self._held = held

    def of(self, found: Found, *, brief: bool = False) -> None:
        """
        Challenge the causes of the last state; keep whoever fits better.

        :param found: its last state, rivals and states without a cause are replaced.
        :param brief: whether only rivals matter that are far better.
        """
        found.states[-1] = self._steps.renamed(found.final, found.final.model.causes)
        # that two are one, or one is two, is a matter of words where no law is quite right
        if not brief and not self._steps.patience.over:
            merged, split = merge(self._steps, found), divide(self._steps, found)
            self._stood = {} if merged or split else self._stood
        self._near = {}
        # guesses creep along valleys, and rivals are fitted from here on: theirs is no merit
        creeps = any(t.guessed for t in self._problem.tolerances)
        changed = bool(self._stood)
        if creeps:
            before = found.final
            if not brief:
                found.states[-1] = nudged(self._steps, before)
            changed |= self._converged(found) or found.final is not before
        replaced = 0
        stood = self._stood
        found.unmet = []
        while waiting := [c for c in found.final.model.causes if c not in stood]:
            # what is missed most comes first: there may not be time for all
            causes, worth = found.final.model.causes, worths(self._problem, found.final)
            cause = max(waiting, key=lambda c: worth[causes.index(c)])
            if self._steps.patience.over:
                found.unmet.append(cause)
                stood[cause] = rest_of(self._problem, found, causes.index(cause)), []
                continue
            self._steps.report(
                f'challenging {cause.effect} at {cause.place}', min(0.84, 0.5 + 0.03 * len(stood))
            )
            before = found.final
            without, rivals, better = self._contested(found, cause, brief, replaced < REPLACED)
            changed |= found.final is not before
            if better is None:
                stood[cause] = without, rivals
                continue
            replaced, changed = replaced + 1, True
            before, found.states[-1] = found.final, better
            if creeps:
                self._converged(found)
            # who stood only just did so beside the one that has gone
            stood = {c: s for c, s in stood.items() if self._clearly(before, *s)}
        changed |= self._converged(found)
        causes = found.final.model.causes
        others = {} if brief or self._steps.patience.over else instead(self._steps, found.final)
        found.rivals = [[*stood[c][1], *others.get(c, [])] for c in causes]
        found.without = [
            rest_of(self._problem, found, k) if changed else stood[c][0]
            for k, c in enumerate(causes)
        ]
        self._stood = {c: s for c, s in stood.items() if self._clearly(found.final, *s)}

    def _contested(
        self, found: Found, cause: Candidate, brief: bool, replace: bool
    ) -> tuple[Fit, list[Rival], Fit | None]:
        """
        Challenge one cause of the last state.

        :param found: a ripple's last state is that with the number of waves that fits best.
        :param cause: which of its causes.
        :param brief: whether only rivals matter that are far better.
        :param replace: whether another one may take its place.
        :return: the state without it, its rivals, and the state with a better one in its place.
        """
        k = found.final.model.causes.index(cause)
        without = rest_of(self._problem, found, k)
        if not brief:
            found.states[-1] = waved(self._steps, found.final, k, without)
        state = found.final
        rivals = self._challengers(found, cause, without, brief)
        better = None
        if replace:
            better = self._taken(found, self._better(found, cause, without, rivals, brief))
        near = halfway(state, without, rivals)
        if better is None:
            self._near[cause] = near
            return without, rivals, None
        # who takes its place has the same rivals, and it is one of everybody's
        self._near |= dict.fromkeys(set(better.model.causes) - set(state.model.causes), near)
        self._near = {c: list(dict.fromkeys([*others, cause])) for c, others in self._near.items()}
        return without, rivals, better

    def _converged(self, found: Found) -> bool:
        """
        Fit the last state to its end; return whether that was anything.

        Guesses creep along valleys: what they still gain would count against a small cause, since
        the fit without it goes on where the fit with it has stopped.
        """
        state = self._problem.fitted(found.final.model, rounds=CREEPING, accuracy=1e-3)
        if not state.cost < (1.0 - 1e-3) * found.final.cost:
            return False
        found.states[-1] = state
        return True

    def _clearly(self, state: Fit, without: Fit, rivals: Sequence[Rival]) -> bool:
        """Return whether a cause is missed so much more than any rival makes up for."""
        missed = without.cost - state.cost
        made_up = without.cost - min((r.fit.cost for r in rivals), default=without.cost)
        behind = missed - made_up
        return (
            behind > CLEAR * tie(self._problem, state) * len(state.left) or made_up < 0.5 * missed
        )

    def _challengers(
        self, found: Found, cause: Candidate, without: Fit, brief: bool
    ) -> list[Rival]:
        """Return the fits of other candidates in the place of a cause, best first."""
        proposals = found.proposals
        # who is asked again meets only who came near, else everybody: most first looks were taken
        among = self._near.get(cause)
        if without is not found.start:
            proposals = best_of(
                self._steps.screened(Screen(self._problem, without, self._seen), [cause], among)
            )
        proposals = [p for p in proposals if p.candidate != cause]
        missed = without.cost - found.final.cost
        # imitators of something unknown are many: among them only what ends the search counts
        brief = brief or hopeless(self._problem, found.start, found.final)
        rivals = self._steps.fitted(without, proposals, missed, cause.effect, brief=brief)
        begun = self._begun.wider(found.final, cause, proposals, brief=brief)
        begun += self._begun.narrower(found.final, cause, brief=brief)
        if not brief:
            begun += self._begun.elsewhere(found.final, cause, among)
            begun += self._begun.homed_again(found.final, cause)
        rivals = best_of(sorted([*begun, *rivals], key=judged_cost))
        # of a speed alone, one dry friction is as good as another: that is to be said
        if not brief or swings(self._problem):
            begun = self._begun.beside_the_others(found.final, cause, without, rivals)
            rivals = best_of(sorted([*begun, *rivals], key=judged_cost))
        rivals = sharpened(self._steps, found.final, without, rivals, BRIEFLY if brief else CLOSE)
        return [r for r in rivals if self._more_than_a_part(r, found.final)]

    def _more_than_a_part(self, rival: Rival, state: Fit) -> bool:
        """Return whether a rival does anything that a simpler effect, or an excuse, does not."""
        model = rival.fit.model
        values = model.values(-1)
        bent = degenerate(self._problem, rival.candidate, values)
        # what is no fault of the rig takes no cause's place
        bent |= is_logged(self._problem, rival.candidate, values)
        return (
            not bent and self._no_excuse(model, state) and plain(self._problem, model, -1) is None
        )

    def _taken(self, found: Found, better: Fit | None) -> Fit | None:
        """
        Return a fit with another candidate in the place of a cause, of causes worth having only.

        None where that one is none, and is missed: friction of a motor that stands for most of the
        time, for one, may fit better by what it merely holds.
        """
        state = found.final
        if better is None or self._foretells_worse(better, state):
            return None
        kept = self._steps.pruned(found.start, better, state.model.causes)
        stays = set(kept.model.causes) - set(state.model.causes)
        if not stays and not as_good(self._problem, kept, state):
            return None
        return None if self._foretells_worse(kept, state) else kept

    def _foretells_worse(self, other: Fit, state: Fit) -> bool:
        """Return whether a fit foretells what was held out worse, where that is asked."""
        # where no law is quite right, who fits as well may foretell worse; several of these, each
        # by no more than chance, are worse together
        if self._held is None:
            return False
        return float(saved(self._held, other.model, state.model).sum()) > 0.0

    def _no_excuse(self, model: Model, state: Fit) -> bool:
        """Return whether nothing has become an excuse beside a rival that was none before."""
        return excused(self._problem, model) <= excused(self._problem, state.model)

    def _better(
        self,
        found: Found,
        cause: Candidate,
        without: Fit,
        rivals: Sequence[Rival],
        brief: bool,
    ) -> Fit | None:
        """
        Return a fit with another candidate: one that fits better, or as well and is simpler.

        Or with none, where the machine in another unit does as well.
        """
        state = found.final
        k = state.model.causes.index(cause)
        if sets_the_unit(self._problem, state.model, k) and as_good(self._problem, without, state):
            return without

        def wins(rival: Candidate, fit: Fit) -> bool:
            more = rival.price - cause.price
            ahead = (state.cost - fit.cost) / len(state.left)
            # a law that holds another is never worse: it pays for its parameters, or that other
            # one is named, and it among those that cannot be told from it
            if is_part(rival, cause) or is_plainer(rival, cause):
                return not pays(self._problem, state, fit)
            held = is_part(cause, rival) or is_plainer(cause, rival)
            if held and not pays(self._problem, fit, state):
                return False
            if more < 0:
                return as_good(self._problem, fit, state)
            if more > 0:
                return ahead > tie(self._problem, fit)
            return fit.cost < BETTER * state.cost

        for rival in rivals[:2]:
            if wins(rival.candidate, rival.fit):
                trial = self._steps.settled(rival.fit.model, self._problem.slopes(state))
                if wins(rival.candidate, trial) and self._no_excuse(trial.model, state):
                    return trial
        # where no law is quite right, what is worth least still makes up for what others get wrong
        close = [] if brief else close_ones(self._problem, state, without, rivals)
        for rival in close[:2]:
            smaller = relieved(self._problem, rival.fit)
            if smaller is not None and as_good(self._problem, smaller, state):
                trial = self._steps.settled(smaller.model, self._problem.slopes(smaller))
                if as_good(self._problem, trial, state) and self._no_excuse(trial.model, state):
                    return trial
        return None
