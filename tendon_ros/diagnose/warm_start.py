"""
Warm starts: rivals that begin where a cause has brought everything else.

Screening looks for them where the rest stands without the cause, and may look in another valley.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math

import numpy as np

from tendon_ros.diagnose.found import best_of, Rival
from tendon_ros.diagnose.parts import is_part, widened
from tendon_ros.diagnose.rivals import alike, bared, halfway
from tendon_ros.diagnose.steps import Steps
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.screening import Proposal, Screen
from tendon_ros.identify.segment import SETTLING
from tendon_ros.identify.starting import between_recordings

#: rounds and accuracy of fits: only careful ones tell whether there is more to an effect
CAREFUL, BRIEF = (20, 1e-3), (6, 1e-2)
#: parts of the size that first order says from which friction may begin
LESS = (1.0, 0.3, 0.1, 0.03)
ZERO = 'encoder_offset'
BEGUN_ANEW = 3  # rivals halfway there that are begun beside what the others are with the cause


class Begun:
    """
    Fits rivals from where a cause has brought everything else.

    :param steps: of the search.
    """

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._problem = steps.problem

    def wider(
        self, state: Fit, cause: Candidate, proposals: Sequence[Proposal], *, brief: bool = False
    ) -> list[Rival]:
        """
        Return the fits of effects that hold the cause's, which begin from what it found.

        They are then never worse than it for having been fitted badly.

        :param state: with the cause.
        :param cause: which one.
        :param proposals: of others in its place.
        :param brief: whether only fits matter that are far better.
        :return: the fits.
        """
        values = state.model.values(state.model.causes.index(cause))
        begun = [
            (p.candidate, widened(p.values, p.candidate, values, cause))
            for p in proposals
            if is_part(cause, p.candidate)
        ]
        return self._instead(state, cause, begun, *(BRIEF if brief else CAREFUL))

    def narrower(self, state: Fit, cause: Candidate, *, brief: bool = False) -> list[Rival]:
        """
        Return the fits of effects that are part of the cause's, which begin from what it found.

        Friction by direction has made up for what else has moved to go along with it: a plain one
        is fitted from where that stands, and not given up halfway. What the file has of it is
        beside the cause, and so part of the plain one.

        :param state: with the cause.
        :param cause: which one.
        :param brief: whether only fits matter that are far better.
        :return: the fits.
        """
        values = state.model.values(state.model.causes.index(cause))
        begun: list[tuple[Candidate, dict[str, float]]] = []
        if cause.given:  # without it, what the file has is there again
            return []
        for candidate in self._steps.candidates:
            held = find(cause.effect).holds.get(candidate.effect, ())
            if not held or candidate.place != cause.place or candidate in state.model.causes:
                continue
            [size] = candidate.parameters
            mean = float(np.mean([values[name] for name in held]))
            begun.append((candidate, {size.name: size.neutral + mean}))
        how = BRIEF if brief else CAREFUL
        return self._instead(state, cause, begun, *how, anew=True)

    def elsewhere(
        self, state: Fit, cause: Candidate, among: Sequence[Candidate] | None
    ) -> list[Rival]:
        """
        Return the fits of the same effect at other places, which begin from what the cause found.

        Screening may have looked for their time or phase in another valley.

        :param state: with the cause.
        :param cause: which one.
        :param among: those to ask; all where None.
        :return: the fits.
        """
        values = state.model.values(state.model.causes.index(cause))
        others = [
            c
            for c in (self._steps.candidates if among is None else among)
            if c.effect == cause.effect and c not in state.model.causes
        ]
        rest = state.model.without(state.model.causes.index(cause))

        def begun(candidate: Candidate) -> tuple[Candidate, dict[str, float]]:
            # cables cross: what turns one pulley forward turns another one back
            tried = [candidate.as_much(cause, values, back=back) for back in (False, True)]
            costs = [self._problem.cost(rest.joined(candidate, begin)) for begin in tried]
            return candidate, tried[int(np.argmin(costs))]

        return self._instead(state, cause, list(self._steps.pool.map(begun, others)))

    def homed_again(self, state: Fit, cause: Candidate) -> list[Rival]:
        """
        Return the fits of encoders' zeros, if a cause has been there since its recording began.

        What slipped between two recordings may as well have been homed.

        :param state: with the cause.
        :param cause: which one.
        :return: the fits.
        """
        values = state.model.values(state.model.causes.index(cause))
        if not between_recordings(self._problem, cause) or any(
            values[p.name] > SETTLING for p in cause.instants
        ):
            return []
        zeros = [replace(c, only=cause.only) for c in self._steps.candidates if c.effect == ZERO]
        return self._instead(state, cause, [(c, c.as_given) for c in zeros])

    def beside_the_others(
        self, state: Fit, cause: Candidate, without: Fit, rivals: Sequence[Rival]
    ) -> list[Rival]:
        """
        Return the fits of rivals that came halfway, which begin where the others now stand.

        A weight and a spring of a small angle do the same, but not beside others that have moved
        to make up for the one before the other came. One that came near may still be held back.

        :param state: with the cause.
        :param cause: which one.
        :param without: the fit without it.
        :param rivals: fits of others in its place.
        :return: the fits.
        """
        near = halfway(state, without, rivals)[:BEGUN_ANEW]
        # guesses that have moved to do without one friction hide that another does as well
        if any(t.guessed for t in self._problem.tolerances):
            near += [c for c in self._steps.candidates if alike(c, cause) and c not in near]
        rest = bared(self._problem, state, state.model.causes.index(cause)) if near else None
        if rest is None:
            return []
        proposals = best_of(self._steps.screened(Screen(self._problem, rest), [cause], near))
        sized = self._steps.pool.map(lambda p: self._sized(rest.model, p), proposals)
        begun = [(p.candidate, values) for p, values in zip(proposals, sized, strict=True)]
        return self._instead(state, cause, begun)

    def _sized(self, rest: Model, proposal: Proposal) -> dict[str, float]:
        """
        Return the parameters from which the fit of a proposal begins.

        Friction that holds all of a motion does not tell how much less would let it go, so less is
        tried as well.
        """
        if not proposal.candidate.dry:
            return proposal.values
        coordinates = proposal.candidate.coordinates
        tried = [
            coordinates.values(proposal.resized([part * step for step in proposal.steps]))
            for part in LESS
        ]

        return min(tried, key=lambda v: self._problem.cost(rest.joined(proposal.candidate, v)))

    def _instead(
        self,
        state: Fit,
        cause: Candidate,
        begun: Sequence[tuple[Candidate, dict[str, float]]],
        rounds: int = CAREFUL[0],
        accuracy: float = CAREFUL[1],
        *,
        anew: bool = False,
    ) -> list[Rival]:
        """
        Return fits of candidates in the place of a cause, from where each begins.

        ``anew``: with derivatives of their own, where others have to move far.
        """
        rest = state.model.without(state.model.causes.index(cause))
        known = None if anew else self._problem.slopes(state)

        def one(begin: tuple[Candidate, dict[str, float]]) -> Rival:
            # when it was is found once it comes near
            fit = self._problem.fitted(rest.joined(*begin), known, rounds, accuracy, timed=False)
            return Rival(begin[0], fit)

        return [r for r in self._steps.pool.map(one, begun) if math.isfinite(r.fit.cost)]
