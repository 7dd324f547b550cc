"""
Screening: what each candidate could explain of what is left, tolerances and causes refitted.

One rollout for each of its sizes gives a candidate's signature. What tolerances and causes can
imitate is projected out, and the sizes that fit best follow by least squares; rollouts at those
sizes correct for friction and slack, which are far from linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.beside import Beside
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.starting import Starting

FloatArray = NDArray[np.float64]

#: signatures by the proposals that they belong to, and by the causes beside which they were seen:
#: all of them for what acts by others, else the lost signs, for without its sign what is read is
#: upside down half of the time
Seen = dict[tuple[Candidate, tuple[float, ...], frozenset[Candidate]], NDArray[np.float32] | None]

SUSPECT = 1.5  # deviations of a number of the file from which on its effect is suspected
FARTHEST = 30.0  # typical sizes that a first proposal goes


@dataclass(frozen=True)
class Proposal:
    """
    A candidate with places on its axes from which a fit may begin.

    ``sizes``: which of its axes are sizes; ``base``: the places on them where the state already
    is; ``gain``: by how much the squares fall, to first order; ``seen``: norm of the signature of
    typical size, in noise deviations, and ``own``: the part of it that nothing else imitates.
    ``firm``: it is what was tried: half of the way to a preload that leaves a cable slack nothing
    is slack.
    """

    candidate: Candidate
    z: tuple[float, ...]
    sizes: tuple[int, ...]
    base: tuple[float, ...]
    gain: float = 0.0
    seen: float = 0.0
    own: float = 0.0
    firm: bool = False

    @property
    def values(self) -> dict[str, float]:
        """The parameters, SI units."""
        return self.candidate.coordinates.values(self.z)

    @property
    def steps(self) -> list[float]:
        """How far the proposal goes on each axis that is a size."""
        return [self.z[n] - begun for n, begun in zip(self.sizes, self.base, strict=True)]

    def resized(self, steps: Sequence[float]) -> tuple[float, ...]:
        """
        Return the places with other sizes.

        :param steps: from the base, one for each of the axes that are sizes.
        :return: places within the bounds of the axes.
        """
        z = list(self.z)
        for n, begun, step in zip(self.sizes, self.base, steps, strict=True):
            low, high = self.candidate.coordinates.axes[n].ends
            z[n] = float(min(max(begun + step, low), high))
        return tuple(z)


class Screen:
    """
    Judges candidates against one fitted state.

    :param problem: the data.
    :param fit: the state.
    :param seen: signatures at typical sizes beside a state that is much like this one. First
        looks take them from there, and leave there what was not.
    """

    def __init__(self, problem: Problem, fit: Fit, seen: Seen | None = None) -> None:
        self.problem = problem
        self.fit = fit
        self._seen: Seen = {} if seen is None else seen
        self._causes = frozenset(fit.model.causes)
        self._signs = frozenset(c for c in fit.model.causes if c.switches)
        self._starting = Starting(problem, fit)
        self._free = problem.free(fit)
        # what a bound holds back imitates nothing
        self._slope = fit.slope * self._free
        self._inverse = problem.covariance(fit, self._free)
        self._pull = self._slope.T @ fit.left
        tolerances = problem.tolerances
        first = fit.slope.shape[1] - len(tolerances)
        self._numbers = [(t, first + n) for n, t in enumerate(tolerances)]
        self._beside = Beside(problem, fit)
        #: what is left once what moves already has moved as far as it likes, shape (samples,)
        self.left: FloatArray = fit.left - self._slope @ (self._inverse @ self._pull)

    def proposals(self, candidate: Candidate) -> list[Proposal]:
        """
        Return what a candidate could explain to first order, one proposal for each start.

        :param candidate: the candidate.
        :return: the proposals, best first; empty where it changes nothing that was measured.
        """
        coordinates = candidate.coordinates
        found: dict[Proposal, None] = {}
        for n, (one, values) in enumerate(self._starting.of(candidate)):
            z = coordinates.place(values)
            sizes = coordinates.sizes
            slack = any(p.search == 'slack' for p in one.parameters)
            start = Proposal(one, z, sizes, self._base(candidate), firm=slack and n > 0)
            # the bins about an event hardly count, whatever its size: at a small one they are all
            # and a preload is asked about where it leaves a cable slack
            sized = one.instants or slack
            at = start.steps if sized else [1.0] * len(sizes)
            judged = self._judged(start, at, self._first(start, at))
            if judged is not None:
                found[judged] = None
        return sorted(found, key=lambda p: -p.gain)

    def suspects(self, candidate: Candidate) -> bool:
        """
        Return whether a candidate is a number of the file that has moved far.

        Several numbers that each move within their tolerances can hide one that is far beyond.

        :param candidate: the candidate.
        :return: whether; a first look does not see what it costs to hold numbers within.
        """
        n = self.fit.slope.shape[1]
        return any(abs(self.fit.model.moved[j - n]) > SUSPECT for j in self._own(candidate))

    def corrected(self, proposal: Proposal) -> Proposal:
        """
        Return a proposal judged at the sizes that it proposes.

        :param proposal: of this state.
        :return: the same candidate, its sizes corrected once more.
        """
        if not proposal.sizes or (proposal.gain <= 0.0 and not self.suspects(proposal.candidate)):
            return proposal
        changes = self._changes(proposal, [step or 1.0 for step in proposal.steps])
        if changes is None or proposal.firm:
            return proposal
        own = self._own(proposal.candidate)
        gain, steps = self._beside.best(changes, self._reach(proposal), own)
        if not steps.any():
            return replace(proposal, gain=0.0)
        return replace(proposal, z=proposal.resized(steps.tolist()), gain=gain)

    def signatures(self, proposal: Proposal) -> FloatArray | None:
        """
        Return what each size of a proposal changes that nothing which moves already imitates.

        :param proposal: of this state.
        :return: by one on the axis of the size, shape (samples, sizes), in noise deviations; by
            all of it where the proposal has no size; None where the model diverges.
        """
        changes = self._changes(proposal, [step or 1.0 for step in proposal.steps])
        return None if changes is None else self._projected(proposal.candidate, changes)

    def _first(self, proposal: Proposal, at: Sequence[float]) -> FloatArray | None:
        """Return the signature of a first look, perhaps as it was beside another state."""
        if proposal.candidate.instants:  # as large as what is left here says
            return self._changes(proposal, at)
        beside = self._causes if proposal.candidate.by_others else self._signs
        key = (proposal.candidate, proposal.z, beside)
        if key not in self._seen:
            found = self._changes(proposal, at)
            self._seen[key] = None if found is None else found.astype(np.float32)
        seen = self._seen[key]
        return None if seen is None else seen.astype(np.float64)

    def _judged(
        self, proposal: Proposal, at: Sequence[float], changes: FloatArray | None
    ) -> Proposal | None:
        """Return a proposal with its best sizes; ``changes`` are its signatures ``at`` some."""
        if changes is None:
            return None
        seen = float(np.linalg.norm(changes * np.asarray(at or [1.0])))
        if seen < 1e-3:
            return None
        own = self._projected(proposal.candidate, changes)
        kept = float(np.linalg.norm(own * np.asarray(at or [1.0])))
        if not proposal.sizes:
            [change] = own.T
            rest = self.left + change
            gain = float(self.left @ self.left - rest @ rest)
            return replace(proposal, gain=max(gain, 0.0), seen=seen, own=kept)
        if kept <= 3e-5 * seen:
            return replace(proposal, gain=0.0, seen=seen, own=kept)
        steps = np.clip(self._best(proposal, own), -FARTHEST, FARTHEST)
        if proposal.firm:
            steps = np.array(proposal.steps)
        gain = self._gain(own, steps)
        if gain <= 0.0:  # keep a size to speak of
            return replace(proposal, gain=0.0, seen=seen, own=kept)
        z = proposal.resized(steps.tolist())
        return replace(proposal, z=z, gain=gain, seen=seen, own=kept)

    def _gain(self, own: FloatArray, steps: FloatArray) -> float:
        """Return by how much the squares fall where sizes have gone so far."""
        return float(self.left @ self.left - np.sum((self.left + own @ steps) ** 2))

    def _own(self, candidate: Candidate) -> list[int]:
        """Return which unknowns of the fit are the very numbers that a candidate moves."""
        return [j for t, j in self._numbers if t.is_moved_by(candidate)]

    def _base(self, candidate: Candidate) -> tuple[float, ...]:
        """Return where numbers of the file have moved to already, as their effect says it."""
        coordinates = candidate.coordinates
        own = {
            t.parameter: t.axis.value(float(z))
            for t, z in zip(self.problem.tolerances, self.fit.model.moved, strict=True)
            if t.is_moved_by(candidate)
        }
        if not own:
            return (0.0,) * len(coordinates.sizes)
        places = coordinates.place({**candidate.as_given, **own})
        return tuple(places[n] for n in coordinates.sizes)

    def _changes(self, proposal: Proposal, at: Sequence[float]) -> FloatArray | None:
        """Return what each size changes by one, taken at a size; shape (samples, sizes or 1)."""
        coordinates = proposal.candidate.coordinates
        steps = np.zeros(len(proposal.sizes))
        found: list[FloatArray] = []
        before = self.fit.left
        # one size after the other: where a spring rests says nothing before it has a stiffness
        for n, size in enumerate(at or [1.0]):
            if proposal.sizes:
                steps[n] = size
            values = coordinates.values(proposal.resized(steps.tolist()))
            now = self.problem.left(self.fit.model.joined(proposal.candidate, values))
            if not np.isfinite(now).all():
                return None
            # a size of nothing changes nothing
            found.append((now - before) / (size or 1.0))
            before = now
        return np.array(found).T

    def _projected(self, candidate: Candidate, changes: FloatArray) -> FloatArray:
        """Return the part of changes that tolerances and causes do not imitate."""
        inverse = self._inverse
        # beyond its tolerance, a number is the cause itself
        j = [j for j in self._own(candidate) if self._free[j]]
        if j:
            inverse = inverse - inverse[:, j] @ np.linalg.solve(inverse[np.ix_(j, j)], inverse[j])
        own: FloatArray = changes - self._slope @ (inverse @ (self._slope.T @ changes))
        return own

    def _reach(self, proposal: Proposal) -> FloatArray:
        """Return how far each size may go down and up, shape (2, sizes)."""
        axes = proposal.candidate.coordinates.axes
        ends = np.array([axes[n].ends for n in proposal.sizes]).reshape(-1, 2).T
        reach: FloatArray = np.clip(ends - np.asarray(proposal.base), -FARTHEST, FARTHEST)
        return reach

    def _best(self, proposal: Proposal, own: FloatArray) -> FloatArray:
        """Return the steps that fit best, none where it may not be."""
        low = self._reach(proposal)[0]
        kept = np.arange(len(low))
        best = np.zeros(len(low))
        while len(kept):
            part = own[:, kept]
            products = part.T @ part
            ridge = 1e-9 * np.diag(np.diag(products)) + 1e-30 * np.eye(len(kept))
            found = np.linalg.solve(products + ridge, -part.T @ self.left)
            wrong = found < low[kept]
            if not wrong.any() or len(kept) == 1:
                best[kept] = np.where(wrong, low[kept].clip(min=-FARTHEST, max=0.0), found)
                return best
            kept = np.delete(kept, int(np.argmin(found - low[kept])))
        return best
