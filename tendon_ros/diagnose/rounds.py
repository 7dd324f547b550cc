"""
One round of a search: what joins a state, and whether it is needed.

The set of candidates that together explain most, to first order, is fitted, pruned, and believed
only where the state before it leaves much more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tendon_ros.diagnose.bent import at_once
from tendon_ros.diagnose.excusing import without_excuses
from tendon_ros.diagnose.found import best_of, Rival
from tendon_ros.diagnose.guesses import better, far_off, under_way
from tendon_ros.diagnose.steps import CORRECTED, Steps
from tendon_ros.diagnose.worth import LEAST, stands_out, worthwhile
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.screening import Proposal, Screen
from tendon_ros.identify.subset import Member, Subsets

#: causes; and from how many on each has to explain most of some channel, or the search goes astray
MOST, MANY = 10, 5
AT_ONCE = 3  # causes that a round adds: to first order, the fourth only imitates
#: part of the cost that the same causes leave where they have come out of a valley
GAINED = 0.8


class Round:
    """
    Joins causes to states of one problem.

    :param steps: of the search.
    :param start: without any cause.
    """

    def __init__(self, steps: Steps, start: Fit) -> None:
        self.problem = steps.problem
        self._steps = steps
        self._start = start
        # the last state that one cause was looked for beside, among whom, and what was found
        self._tried: tuple[Fit, Sequence[Proposal], Fit | None] | None = None

    def grown(self, before: Fit, screen: Screen, proposals: Sequence[Proposal]) -> Fit | None:
        """
        Return a state with the causes that explain most together.

        :param before: what it has to be better than.
        :param screen: of the state that they join.
        :param proposals: beside that state, best first.
        :return: the state; None where it is not needed.
        """
        state = screen.fit
        room = MOST - len(state.model.causes)
        if room <= 0:
            return None
        # guesses that have gone far to do without causes come back for all of them together
        most = room if far_off(self.problem, self._start) else min(room, AT_ONCE)
        members = self._subset(screen, proposals, most)
        if not members:
            # numbers within tolerance that hide one beyond it cost more than what they leave
            alone = self.alone(state, promising(state, proposals))
            return alone if alone and self.believes(before, alone) else None
        model = state.model
        for member in members:
            candidate = member.proposal.candidate
            model = model.joined(candidate, candidate.coordinates.values(member.z))
        # sizes and shapes lie along curved valleys: more of them, more steps
        fit = self.problem.fitted(model, self.problem.slopes(state), rounds=12, accuracy=1e-2)
        model = self._steps.parted(fit)
        fit = self._steps.pruned(
            self._start,
            self._steps.settled(model, self.problem.slopes(state)),
            state.model.causes,
        )
        fits = [fit]
        promised = max(m.proposal.gain for m in members)
        if not state.model.causes:
            fits = [self._simplest(before, state, proposals, fit)]
        elif not self.believes(before, fit) or fit.cost > state.cost - promised:
            # first order hardly tells the last of many, and one of them may lead all others
            # astray: see which one fits
            alone = self.alone(state, proposals)
            if alone is not None:
                fits.append(self._steps.pruned(self._start, alone, state.model.causes))
        whole = self._without_excuses(before, fits)
        return better(self.problem, *(fit for fit in whole if self.believes(before, fit)))

    def _without_excuses(self, before: Fit, fits: Sequence[Fit]) -> list[Fit]:
        """Return the fits but for those in which a limit that has come in excuses."""
        rivals = [Rival(fit.model.causes[-1], fit) for fit in fits if fit.model.causes]
        return [rival.fit for rival in without_excuses(self.problem, before, rivals)]

    def believes(self, before: Fit, fit: Fit) -> bool:
        """
        Return whether a state has causes that the one before has not, and needs them.

        Or the same ones leave much less: what came and went has led out of a valley.

        :param before: a state.
        :param fit: another one.
        :return: whether.
        """
        new = set(fit.model.causes) - set(before.model.causes)
        if not new:
            return bool(fit.model.causes) and fit.cost < GAINED * before.cost
        if not worthwhile(self.problem, self._start, before, fit):
            return False
        few = len(fit.model.causes) <= MANY
        return few or stands_out(self.problem, self._start, before, fit)

    def alone(self, state: Fit, proposals: Sequence[Proposal]) -> Fit | None:
        """
        Return a state with one cause more.

        :param state: what holds already.
        :param proposals: causes, best first.
        :return: the fit of the one that fits best; None where none does but a limit that excuses.
        """
        if self._tried and self._tried[0] is state and self._tried[1] is proposals:
            return self._tried[2]
        rivals = self._steps.fitted(state, best_of(proposals), 0.0) if proposals else []
        found: Fit | None = None
        if rivals:
            best, *others = rivals
            close = under_way(self.problem, state, best.fit, [r.fit for r in others])
            together = [best, *(r for r in others if any(r.fit is fit for fit in close))]
            later = [r for r in others if all(r.fit is not fit for fit in close)]
            settled = [self._ended(rival) for rival in together]
            # a limit may have sunk to where it excuses only once it was fitted to its end
            while not (whole := without_excuses(self.problem, state, settled)) and later:
                settled.append(self._ended(later.pop(0)))
            found = min((r.fit for r in whole), key=lambda fit: fit.cost, default=None)
        self._tried = state, proposals, found
        return found

    def _ended(self, rival: Rival) -> Rival:
        """Return a rival fitted to its end."""
        return replace(rival, fit=self._steps.settled(rival.fit.model))

    def _simplest(self, before: Fit, state: Fit, proposals: Sequence[Proposal], many: Fit) -> Fit:
        """
        Return the one cause that fits best where it does as well as many, else the many.

        To first order, smooth effects imitate one that is far from linear.
        """
        one = self.alone(state, proposals)
        if one is None or not self.believes(before, one):
            return many
        # a limit may have sunk while others that came with it went
        whole = self._without_excuses(before, [many, one])
        if len(whole) < 2:
            return whole[0] if whole else many
        if len(many.model.causes) < 2:
            return min(one, many, key=lambda fit: fit.cost)
        return many if worthwhile(self.problem, self._start, one, many) else one

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


def promising(state: Fit, proposals: Sequence[Proposal]) -> list[Proposal]:
    """
    Return the proposals that explain enough to be believed, to first order.

    Where samples are few and noisy no structure is to be seen in what is left, and yet a cause
    that turns with the motion may stand out.

    :param state: what holds already.
    :param proposals: beside it.
    :return: those of them.
    """
    return [p for p in proposals if p.gain > LEAST * len(state.left)]
