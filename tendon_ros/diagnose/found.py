"""What a search has found: the states it went through, and who else would have done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.screening import Proposal

#: part of the cost that one more parameter must save
PARAMETER = 0.004


@dataclass(frozen=True)
class Rival:
    """A candidate fitted in the place of a cause, or beside the causes."""

    candidate: Candidate
    fit: Fit


def judged_cost(rival: Rival) -> float:
    """
    Return the cost of a fit, more where more parameters made it.

    :param rival: the fit.
    :return: squares in noise deviations.
    """
    return rival.fit.cost * (1.0 + PARAMETER * rival.candidate.price)


def best_of[T: (Proposal, Rival)](tried: Sequence[T]) -> list[T]:
    """
    Return the best proposal, or the best fit, of each candidate.

    :param tried: best first.
    :return: best first.
    """
    best: dict[Candidate, T] = {}
    for one in tried:
        best.setdefault(one.candidate, one)
    return list(best.values())


@dataclass
class Found:
    """
    Everything a search leaves behind.

    ``states``: the start, then one for each cause that joins, most telling first. ``rivals``,
    ``without``: for each cause of the last state, who was fitted in its place, and the fit
    without it. ``unmet``: causes in whose place nobody was fitted, for want of time.
    ``proposals``: of the first screening, the best of each candidate. ``unweighed``: where it
    stopped early, since channels should weigh by what this state leaves of them.
    """

    states: list[Fit] = field(default_factory=list)
    rivals: list[list[Rival]] = field(default_factory=list)
    without: list[Fit] = field(default_factory=list)
    proposals: list[Proposal] = field(default_factory=list)
    unmet: list[Candidate] = field(default_factory=list)
    unweighed: Fit | None = None

    @property
    def start(self) -> Fit:
        """The instrument file, its numbers moved within their tolerances."""
        return self.states[0]

    @property
    def final(self) -> Fit:
        """All causes."""
        return self.states[-1]
