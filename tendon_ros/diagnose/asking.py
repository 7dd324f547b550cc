"""Whom a search has to ask: who left a trace, or may once others act; whose sign may be lost."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.screening import Proposal

#: norm of a signature in noise deviations, imitations taken off, that leaves a trace
TRACE = 2.0
#: part of the range of a reading that noise may make negative, and errors of its sensor
BELOW, FAR = 0.05, 6.0
#: what may shift readings below zero that have no sign
SHIFT = 'load_cell_bias'


def asked_again(
    candidates: Sequence[Candidate], proposals: Sequence[Proposal]
) -> tuple[Candidate, ...]:
    """
    Return whom to ask again once something has been found.

    :param candidates: all that may be named.
    :param proposals: of them beside nothing.
    :return: those that left a trace at a typical size, or may once others act.
    """
    traced = {(p.candidate.effect, p.candidate.place) for p in proposals if p.own > TRACE}
    return tuple(
        c
        for c in candidates
        if c.instants or c.switches or c.by_others or (c.effect, c.place) in traced
    )


def lost(model: Model, candidate: Candidate) -> Model:
    """
    Return a model in which a sensor knows no sign.

    :param model: in which it does.
    :param candidate: the lost sign.
    :return: the larger model.
    """
    return model.joined(candidate, find(candidate.effect).typical)


def signless(problem: Problem, candidates: Sequence[Candidate]) -> list[Candidate]:
    """
    Return the lost signs among candidates, of sensors that may have lost theirs.

    :param problem: the data.
    :param candidates: all that may be named.
    :return: those.
    """
    return [c for c in candidates if may_be_signless(problem, c)]


def may_be_signless(problem: Problem, candidate: Candidate) -> bool:
    """
    Return whether a candidate is a lost sign, and of a sensor that may have lost it.

    :param problem: the data.
    :param candidate: any effect at any place.
    :return: whether no reading of the sensor is negative by more than noise, and by the file some
        would be: a load cell on which the tip can only press has no sign to lose.
    """
    if not candidate.switches or _reads_below_zero(problem, candidate.place):
        return False
    without = lost(problem.empty, candidate)
    return not np.allclose(problem.left(without), problem.left(problem.empty))


def signed(problem: Problem, candidates: Sequence[Candidate]) -> list[Candidate]:
    """
    Return the lost signs among candidates that nobody has to ask, since readings show the sign.

    :param problem: the data.
    :param candidates: all that may be named.
    :return: those of sensors that read below zero by more than noise, and that no bias shifts.
    """
    return [
        c
        for c in candidates
        if c.switches
        and not any(one.effect == SHIFT and one.place == c.place for one in candidates)
        and _reads_below_zero(problem, c.place)
    ]


def _reads_below_zero(problem: Problem, sensor: str) -> bool:
    """Return whether a sensor reads below zero by more than noise."""
    own = [
        measured
        for segment in problem.rollouts.segments
        for measured in segment.measured
        if measured.sensor.name == sensor
    ]
    read = np.concatenate([m.value[np.isfinite(m.value)] for m in own]) if own else np.zeros(0)
    if not read.size:
        return False
    noise = max(BELOW * float(np.ptp(read)), FAR * max(m.floor for m in own))
    return float(read.min()) <= -noise
