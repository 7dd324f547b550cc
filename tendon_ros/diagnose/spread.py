"""
How well the file's numbers are known, told by how far off those are that the recordings tell.

A file that says nothing may be a careful nameplate or a first guess. Where a recording tells ten
of its numbers, and most are off by three per cent, one that is off by eight is no fault of the
machine; beside numbers that are off by one per cent, it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.intervals import parameter_intervals
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.tolerance import MEASURED, REACH

FloatArray = NDArray[np.float64]

#: numbers off by as much as is usual that stand for what is known before any data
USUAL = 4.0
#: density of how far off a number is that is a fault, times the odds of one: one of twenty, evenly
#: up to 50 % either way
FAULTY = 0.05 * MEASURED
ROUNDS = 50  # of expectation and maximization
#: times what a number is off that its tolerance reaches, so that it does not lie at its end
ROOM = 1.1
#: part of a deviation squared that data leave of a number, at least and at most
KNOWS = 1e-6, 1.0 - 1e-6
NORMAL = 1.96  # deviations of a 95 % interval


@dataclass(frozen=True)
class Loose:
    """
    Causes that are none: the file's numbers are no better known.

    ``looser``: times what is usual that its numbers are off; ``causes``: what is no fault, then.
    """

    looser: float
    causes: tuple[Candidate, ...]

    def begun(self, ready: Prepared, found: Found) -> Model:
        """
        Return where to search on from.

        :param ready: the problem that was searched, by its tolerances.
        :param found: what was found.
        :return: the last state without the causes that are none.
        """
        model = found.final.model
        gone = [k for k, cause in enumerate(model.causes) if cause in self.causes]
        wider = [self.looser / ready.looser if t.supposed else 1.0
                 for t in ready.problem.tolerances]  # fmt: skip
        return replace(model.without(*gone), moved=model.moved / np.array(wider))


def known_words(looser: float) -> str:
    """
    Return what a user should know of numbers that are known less well than is usual.

    :param looser: times what is usual.
    :return: a sentence.
    """
    return (
        'the instrument file does not say how well its numbers are known, and those that the '
        f'recordings tell are off by more than is usual: {looser * MEASURED:.1%} were taken for '
        'one standard deviation (where they are known better, write "± 1 %" behind them)'
    )


def loose(ready: Prepared, found: Found) -> Loose | None:
    """
    Return which causes are none, since the file's other numbers are off as far.

    :param ready: the problem.
    :param found: what the search has found.
    :return: them, and how far numbers are off; None where no cause is one of these.
    """
    owned = ready.problem.owned(found.final.model)
    known = zip(ready.problem.tolerances, owned, strict=True)
    if not any(moves and t.supposed for t, moves in known):
        return None
    fit = ready.problem.centred(found.final)
    within = _within(ready.problem, fit)
    beyond = _beyond(ready.problem, fit)
    # what is usual, and what is a fault, does not change with what was supposed this time
    off = np.array([*(off for off, _ in within), *(off for _, off, _ in beyond)]) * ready.looser
    variance = np.array([*(v for _, v in within), *(v for _, _, v in beyond)]) * ready.looser**2
    spread, nuisance = _spread(off, variance)
    # a number that is hardly known need not move farther than it surely is off
    nearest = np.abs(off) - NORMAL * np.sqrt(variance)
    late = slice(len(within), None)
    gone = [
        (cause, float(far))
        for (cause, _, _), far, likely in zip(beyond, nearest[late], nuisance[late], strict=True)
        if likely > 0.5
    ]
    if not gone:
        return None
    looser = max(ready.looser, spread, ROOM * max(far for _, far in gone) / REACH)
    return Loose(looser, tuple(cause for cause, _ in gone))


def _within(problem: Problem, fit: Fit) -> list[tuple[float, float]]:
    """
    Return how far numbers are off that no cause moves, in their usual deviations.

    By the data alone: what is supposed of each before is taken off again. With the variances.
    """
    first = fit.slope.shape[1] - len(problem.tolerances)
    variance = np.diag(problem.covariance(fit)) * problem.prior(fit.model)
    owned = problem.owned(fit.model)
    found = []
    for n, tolerance in enumerate(problem.tolerances):
        if tolerance.supposed and not owned[n]:
            part = float(np.clip(variance[first + n], *KNOWS))
            found.append((float(fit.model.moved[n]) / (1.0 - part), part / (1.0 - part)))
    return found


def _beyond(problem: Problem, fit: Fit) -> list[tuple[Candidate, float, float]]:
    """Return the causes that move one number of the file: how far it is off, and the variance."""
    intervals = parameter_intervals(problem, fit)
    found = []
    for k, cause in enumerate(fit.model.causes):
        for t in problem.tolerances:
            if t.supposed and t.is_moved_by(cause):
                low, high = (t.axis.place(end) for end in intervals[k][t.parameter])
                off = t.axis.place(fit.model.values(k)[t.parameter])
                found.append((cause, off, ((high - low) / (2.0 * NORMAL)) ** 2))
    return found


def _spread(off: FloatArray, variance: FloatArray) -> tuple[float, FloatArray]:
    """
    Return how far numbers are usually off, and how likely each is off by no more than chance.

    By expectation and maximization: whoever is far beyond all others does not count.
    """
    square = 1.0
    for _ in range(ROUNDS):
        total = square + variance
        density = np.exp(-0.5 * off**2 / total) / np.sqrt(2.0 * np.pi * total)
        chance = density / (density + FAULTY)
        # how far each is off, by the data and by what is usual
        part = square / total
        expected = (part * off) ** 2 + part * variance
        square = float((USUAL + chance @ expected) / (USUAL + chance.sum()))
    return float(np.sqrt(square)), chance
