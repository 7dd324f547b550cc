"""The next experiment: what would separate the explanations that these data cannot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

from tendon_ros.base.errors import TendonError
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import equals
from tendon_ros.diagnose.result import NextExperiment
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.excitation import separating, Suggestion, together
from tendon_ros.identify.fit import Problem
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.instrument import Instrument

#: a cause with its parameters
type Sized = tuple[Candidate, Mapping[str, float]]
#: which causes of the last state are in question, and the pairs that an experiment separates
type Question = tuple[Set[int], list[tuple[Sized, Sized]]]

PAIRS = 2  # rivals of one cause that an experiment is sought for
SHOWN = 2  # experiments for one cause
LONGEST = 600.0  # [s] beyond which an experiment is not worth proposing


def next_experiments(
    instrument: Instrument,
    measured: Sequence[str],
    problem: Problem,
    found: Found,
    companies: Sequence[Sequence[int]],
    jobs: int,
) -> tuple[NextExperiment, ...]:
    """
    Return what to measure next, the most telling first.

    :param instrument: the network.
    :param measured: channels that were measured.
    :param problem: the fitted bins.
    :param found: what the search has found.
    :param companies: causes that make up for one another, by their place in the last state.
    :param jobs: threads.
    :return: experiments; none where nothing is left to separate.
    """
    chosen: list[tuple[Suggestion, NextExperiment]] = []
    model = found.final.model
    for open_ones, pairs in (*_rivals(problem, found), *_members(found, companies)):
        others = [model.use(n) for n in range(len(model.causes)) if n not in open_ones]
        settled = replace(instrument, effects=in_force(instrument.effects, others))
        try:
            suggestions = together(separating(settled, measured, pairs, jobs))
        except TendonError:
            continue
        worth = [s for s in suggestions if s.seconds <= LONGEST]
        seen: set[str] = set()
        for s in worth:
            if s.add_channel in seen:
                continue
            seen.add(s.add_channel)
            chosen.append(
                (s, NextExperiment(separates=s.separates, do=s.do, add_channel=s.add_channel))
            )
            if len(seen) == SHOWN:
                break
    chosen.sort(key=lambda pair: pair[0].order)
    return tuple(dict.fromkeys(one for _, one in chosen))


def _rivals(problem: Problem, found: Found) -> list[Question]:
    """Return each cause with the rivals that do as well in its place."""
    model = found.final.model
    questions: list[Question] = []
    for k, cause in enumerate(model.causes):
        rivals = equals(problem, found, k)[:PAIRS]
        if rivals:
            own = cause, model.values(k)
            questions.append(({k}, [(own, (r.candidate, r.fit.model.values(-1))) for r in rivals]))
    return questions


def _members(found: Found, companies: Sequence[Sequence[int]]) -> list[Question]:
    """Return the first cause of each company with others, each fitted without the other."""
    causes = found.final.model.causes
    questions: list[Question] = []
    for first, *others in companies:
        for other in others[:PAIRS]:
            alone = found.without[other].model.values(first - (other < first))
            instead = found.without[first].model.values(other - (first < other))
            pair = (causes[first], alone), (causes[other], instead)
            questions.append(({first, other}, [pair]))
    return questions
