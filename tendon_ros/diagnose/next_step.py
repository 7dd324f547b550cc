"""The next experiment: what would separate the explanations that these data cannot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

from tendon_ros.base.errors import TendonError
from tendon_ros.diagnose.belief import Belief
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.judge import equals
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.result import NextExperiment
from tendon_ros.diagnose.steps import Report
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.excitation import separating, Suggestion, together
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.instrument import Instrument

#: a cause with its parameters
type Sized = tuple[Candidate, Mapping[str, float]]
#: how probable a cause is, which of the last state are in question with it, and the pairs that an
#: experiment separates
type Question = tuple[float, Set[int], list[tuple[Sized, Sized]]]

ASKED = 4  # causes in question, the most probable ones: those of a machine may be ten
PAIRS = 2  # rivals of one cause that an experiment is sought for
SHOWN = 2  # experiments for one cause
PLANS = 0.95  # part of a diagnosis that is done before experiments are sought
LONGEST = 600.0  # [s] beyond which an experiment is not worth proposing


def next_experiments(
    instrument: Instrument,
    measured: Sequence[str],
    problem: Problem,
    found: Found,
    held: Belief,
    jobs: int,
    patience: Patience,
    report: Report,
) -> tuple[NextExperiment, ...]:
    """
    Return what to measure next, the most telling first.

    The most probable causes are asked about, while there is time.

    :param instrument: the network.
    :param measured: channels that were measured.
    :param problem: the fitted bins.
    :param found: what the search has found.
    :param held: what is believed of it.
    :param jobs: threads.
    :param patience: once all of its time is up, no more is asked.
    :param report: called with what is being done and the part that is done.
    :return: experiments; none where nothing is left to separate.
    """
    chosen: list[tuple[Suggestion, NextExperiment]] = []
    model = found.final.model
    questions = [*_rivals(problem, found, held), *_members(found, held)]
    for _, open_ones, pairs in sorted(questions, key=lambda question: -question[0])[:ASKED]:
        if patience.ended:
            break
        first = pairs[0][0][0]
        report(
            f'looking for what would separate {first.effect} at {first.place} from others', PLANS
        )
        others = [model.use(n) for n in range(len(model.causes)) if n not in open_ones]
        settled = replace(instrument, effects=in_force(instrument.effects, others))
        try:
            effort = problem.rollouts.effort
            suggestions = together(separating(settled, measured, pairs, jobs, effort))
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
    return _merged([one for _, one in chosen])


def _merged(experiments: Sequence[NextExperiment]) -> tuple[NextExperiment, ...]:
    """Return each thing to do once, with all that it separates."""
    found: dict[tuple[str, str], NextExperiment] = {}
    for one in experiments:
        same = found.get(key := (one.do, one.add_channel))
        separates = dict.fromkeys([*(same.separates if same else ()), *one.separates])
        found[key] = one.model_copy(update={'separates': tuple(separates)})
    return tuple(found.values())


def _rivals(problem: Problem, found: Found, held: Belief) -> list[Question]:
    """Return each cause with the rivals that do as well in its place."""
    model = found.final.model
    questions: list[Question] = []
    for k, cause in enumerate(model.causes):
        rivals = [r for r in equals(problem, found, k) if _alone(r, cause, found.final)][:PAIRS]
        if rivals:
            own: Sized = cause, model.values(k)
            pairs: list[tuple[Sized, Sized]] = [
                (own, (r.candidate, r.fit.model.values(-1))) for r in rivals
            ]
            questions.append((held.weighed[k].chance, {k}, pairs))
    return questions


def _alone(rival: Rival, cause: Candidate, state: Fit) -> bool:
    """Return whether a rival takes the place of one cause, and takes it alone."""
    before, after = set(state.model.causes), set(rival.fit.model.causes)
    return before - after == {cause} and after - before == {rival.candidate}


def _members(found: Found, held: Belief) -> list[Question]:
    """Return the first cause of each company with others, each fitted without the other."""
    causes = found.final.model.causes
    questions: list[Question] = []
    for first, *others in held.companies:
        for other in others[:PAIRS]:
            alone = found.without[other].model.values(first - (other < first))
            instead = found.without[first].model.values(other - (first < other))
            pair = (causes[first], alone), (causes[other], instead)
            questions.append((held.named[first].chance, {first, other}, [pair]))
    return questions
