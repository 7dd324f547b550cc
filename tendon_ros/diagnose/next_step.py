"""The next experiment: what would separate the explanations that these data cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tendon_ros.base.errors import TendonError
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import equals
from tendon_ros.diagnose.result import NextExperiment
from tendon_ros.identify.excitation import separating, Suggestion, together
from tendon_ros.identify.fit import Problem
from tendon_ros.model.instrument import Instrument

PAIRS = 2  # rivals of one cause that an experiment is sought for
SHOWN = 2  # experiments for one cause
LONGEST = 600.0  # [s] beyond which an experiment is not worth proposing


def next_experiments(
    instrument: Instrument, measured: Sequence[str], problem: Problem, found: Found, jobs: int
) -> tuple[NextExperiment, ...]:
    """
    Return what to measure next, the most telling first.

    :param instrument: the network.
    :param measured: channels that were measured.
    :param problem: the fitted bins.
    :param found: what the search has found.
    :param jobs: threads.
    :return: experiments; none where nothing is left to separate.
    """
    chosen: list[tuple[Suggestion, NextExperiment]] = []
    model = found.final.model
    for k, cause in enumerate(model.causes):
        rivals = equals(problem, found, k)[:PAIRS]
        others = [c.use(model.values(n)) for n, c in enumerate(model.causes) if n != k]
        settled = replace(instrument, effects=(*instrument.effects, *others))
        pairs = [((cause, model.values(k)), (r.candidate, r.fit.model.values(-1))) for r in rivals]
        if not pairs:
            continue
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
