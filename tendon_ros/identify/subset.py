"""
Best subsets: which proposals, together, explain what is left, to first order.

One proposal at a time mis-ranks: the friction that two pulleys share is explained best by a third.
Signatures are few and their scalar products quickly made, so that sets are compared by the
thousand, each exchange tried, before anything is fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.screening import Proposal

FloatArray = NDArray[np.float64]

#: part of what is explained that first order gets wrong: no reason for one more
FIRST_ORDER = 0.01
#: an event chooses its time, and takes credit for whatever happens then
EVENT = 0.7
SMALLEST = 0.05  # part of its proposed size that a member may have which cannot turn its sign


@dataclass(frozen=True)
class Member:
    """A proposal that a set holds, and its places on its axes beside the others."""

    proposal: Proposal
    z: tuple[float, ...]


class Subsets:
    """
    Compares sets of proposals.

    :param proposals: the candidates' proposals, several of one candidate allowed.
    :param signatures: what the sizes of each change, shapes (samples, sizes), in noise
        deviations; of those without a size, what they change as they are.
    :param left: what is to be explained, shape (samples,).
    """

    def __init__(
        self,
        proposals: Sequence[Proposal],
        signatures: Sequence[FloatArray],
        left: FloatArray,
    ) -> None:
        self._proposals = tuple(proposals)
        columns = np.concatenate(signatures, axis=1)
        ends = np.cumsum([s.shape[1] for s in signatures])
        self._columns = [
            list(range(end - s.shape[1], end)) for end, s in zip(ends, signatures, strict=True)
        ]
        self._products = columns.T @ columns
        self._pull = -columns.T @ left
        self._whole = float(left @ left)
        self._places = [(p.candidate.effect, p.candidate.place) for p in proposals]
        self._worth = [EVENT if p.candidate.instants else 1.0 for p in proposals]
        self._least = [_least(p) for p in proposals]

    def best(self, least: float, most: int) -> list[Member]:
        """
        Return the set that explains most, as small as it may be.

        :param least: by how much squares must fall for one more member.
        :param most: members.
        :return: the members; empty where nothing is worth it.
        """
        chosen: list[int] = []
        rest = self._whole
        while len(chosen) < most:
            trials = [(self._gain(chosen, rest, j), j) for j in self._joining(chosen)]
            gain, j = max(trials, default=(0.0, -1))
            if gain <= max(least, FIRST_ORDER * (self._whole - rest)):
                break
            chosen = self._exchanged([*chosen, j])
            rest = self._solved(chosen)[0]
        _, sizes = self._solved(chosen)
        return [Member(self._proposals[j], self._proposals[j].resized(sizes[j])) for j in chosen]

    def _gain(self, chosen: Sequence[int], rest: float, j: int) -> float:
        return self._worth[j] * (rest - self._solved([*chosen, j])[0])

    def _joining(self, chosen: Sequence[int]) -> list[int]:
        """Return who is not in a set, nor any other proposal of the same effect and place."""
        taken = {self._places[j] for j in chosen}
        return [j for j, place in enumerate(self._places) if place not in taken]

    def _exchanged(self, chosen: list[int]) -> list[int]:
        """Return a set in which no exchange of one member for another explains more."""
        rest = self._solved(chosen)[0]
        better = True
        while better:
            better = False
            for n in range(len(chosen)):
                for j in self._joining(chosen[:n] + chosen[n + 1 :]):
                    trial = [*chosen[:n], j, *chosen[n + 1 :]]
                    now = self._solved(trial)[0]
                    eager = self._worth[j] < self._worth[chosen[n]]
                    if now < (EVENT if eager else 1.0 - 1e-3) * rest:
                        chosen, rest, better = trial, now, True
        return chosen

    def _solved(self, chosen: Sequence[int]) -> tuple[float, dict[int, list[float]]]:
        """Return the squares that a set leaves, infinite where it may not be, and its sizes."""
        fixed = [c for j in chosen if not self._proposals[j].sizes for c in self._columns[j]]
        free = [c for j in chosen if self._proposals[j].sizes for c in self._columns[j]]
        whole = self._whole
        pull = self._pull
        if fixed:
            whole = whole - 2.0 * self._pull[fixed].sum() + self._products[fixed][:, fixed].sum()
            pull = pull - self._products[:, fixed].sum(axis=1)
        products = self._products[np.ix_(free, free)]
        # two proposals that do the same share what they do
        ridge = 1e-6 * np.diag(np.diag(products)) + 1e-12 * np.eye(len(free))
        solution = np.linalg.solve(products + ridge, pull[free])
        rest = whole - float(solution @ pull[free])
        found = dict(zip(free, solution.tolist(), strict=True))
        sizes = {
            j: [found[c] for c in self._columns[j]] if self._proposals[j].sizes else []
            for j in chosen
        }
        small = any(
            size < least
            for j, row in sizes.items()
            for size, least in zip(row, self._least[j], strict=True)
        )
        return (np.inf if small else rest), sizes


def _least(proposal: Proposal) -> list[float]:
    """Return the smallest sizes that a member may have."""
    axes = proposal.candidate.coordinates.axes
    ends = [axes[n].ends[0] - base for n, base in zip(proposal.sizes, proposal.base, strict=True)]
    return [
        SMALLEST * step if end > -1e-9 else end
        for end, step in zip(ends, proposal.steps, strict=True)
    ]
