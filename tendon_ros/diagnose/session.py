"""
A whole diagnosis: from recordings and an instrument file to the verdict and what it rests on.

Intake, preparation, search, judgement; then what was held out tells how far the gap shrinks, and
the patched instrument is run in closed loop along the recorded commands.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import time

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose import gather, telling
from tendon_ros.diagnose.alike import leaning
from tendon_ros.diagnose.apart import apart_words, disagreement
from tendon_ros.diagnose.asking import signed
from tendon_ros.diagnose.belief import belief
from tendon_ros.diagnose.bodies import alone
from tendon_ros.diagnose.clock import early_words
from tendon_ros.diagnose.closed_loop import closed_loop_gap
from tendon_ros.diagnose.creeping import beside_chance
from tendon_ros.diagnose.doubts import (
    absurd_words,
    brief_words,
    ended_words,
    lost_words,
    scaled_words,
    SCALING,
    unheard_words,
    weak_words,
)
from tendon_ros.diagnose.ends import end_of_all
from tendon_ros.diagnose.evidence import Evidence
from tendon_ros.diagnose.further import foretells
from tendon_ros.diagnose.gap import gaps, offs
from tendon_ros.diagnose.hidden import coarse_words, loud_words
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intake.limits import strong_words
from tendon_ros.diagnose.intervals import unsized
from tendon_ros.diagnose.locate import whereabouts
from tendon_ros.diagnose.logged import logged_words
from tendon_ros.diagnose.memory import Memory
from tendon_ros.diagnose.naming import causes_of, judged, NAMED, strained, verdict_of, Weighed
from tendon_ros.diagnose.next_step import next_experiments
from tendon_ros.diagnose.patch import doubted, patched
from tendon_ros.diagnose.patience import Patience, USUAL
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.result import Diagnosis, NextExperiment, Unexplained
from tendon_ros.diagnose.rivals import contested
from tendon_ros.diagnose.search_passes import Looks
from tendon_ros.diagnose.spread import known_words
from tendon_ros.diagnose.unexplained import unexplained
from tendon_ros.diagnose.zero_order_hold import as_set
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.driving import as_recorded, drives, said_of_torque, with_encoders
from tendon_ros.identify.magnitude import magnitude_of
from tendon_ros.model.instrument import Instrument

Report = Callable[[str, float], None]

#: said where numbers of the file were not moved
ASTRAY = (
    'the numbers of the file are left as they are: moved within their tolerances to what nothing '
    'explains, they foretell what was held out worse than the file does'
)


@dataclass(frozen=True)
class Outcome:
    """
    The verdict, what it rests on, and the instrument with all that holds.

    ``weighed`` are all causes that the search ended with, believed or not: calibration needs them.
    """

    diagnosis: Diagnosis
    evidence: Evidence
    instrument: Instrument
    weighed: tuple[Weighed, ...]


def diagnose(
    recordings: Sequence[Recording],
    instrument: Instrument,
    *,
    withhold: Sequence[str] = (),
    jobs: int = 2,
    plan: bool = True,
    report: Report = lambda _what, _done: None,
    memory: Memory | None = None,
    seconds: float = USUAL,
) -> Outcome:
    """
    Say where the gap between recordings and model lies, what causes it, how far it shrinks.

    :param recordings: of one rig.
    :param instrument: its file.
    :param withhold: effects to do without, ``EFFECT`` or ``EFFECT@PLACE``.
    :param jobs: threads.
    :param plan: whether to look for the next experiment.
    :param report: called with what is being done and the part that is done, 0 to 1.
    :param memory: keeps the steps, so that an interrupted run goes on.
    :param seconds: of two cores that it may take, about: the search is cut short for that.
    :return: the outcome.
    :raises RecordingError: on recordings that cannot be diagnosed.
    """
    began = time.monotonic()
    report('looking at the recordings', 0.0)
    given = instrument
    instrument = as_recorded(given, {name for r in recordings for name in r.channels})
    intake = admitted(recordings, instrument)
    runs, instrument = intake.recordings, intake.instrument
    ready, instrument, held_on = as_set(prepared(runs, instrument, jobs), runs, instrument, jobs)
    measured = {name for r in runs for name in r.channels}
    candidates = everyone(instrument, sorted(measured), withhold, magnitude_of(runs, instrument))
    patience = Patience(seconds, ready.problem.rollouts.effort)
    seen = signed(ready.problem, candidates)
    asked = [c for c in candidates if c not in seen]
    ready = leaning(ready, asked, report)
    ready, found = Looks(ready, asked, jobs, report, memory, patience).taken()
    problem = ready.problem
    report('judging', 0.85)
    held = belief(ready, found)
    model = held.model(found, held.accepted)
    believed = found.final
    if len(model.causes) < len(believed.model.causes):
        believed = problem.fitted(model, rounds=6)
    left = problem.structured(believed.left)
    beyond = unexplained(ready, found, believed)
    places = whereabouts(ready, found, held.accepted, believed, left)
    # where there is no gap, there is nothing that anything could stand in for
    kept = held.kept if held.named or beyond >= NAMED else held.logged
    model = held.model(found, kept)
    heard = ready.heard_again(model).unleant()
    # nor do numbers have to make up for what is touched where the file has nothing
    end = end_of_all(problem, believed)
    clear = heard.problem.leaving_out(end.bins) if end else heard.problem
    final = clear.fitted(model, rounds=6, accuracy=1e-4)
    if end:
        final = heard.problem.fitted(final.model, rounds=0)
    else:
        heard, final = beside_chance(heard, found.start.model, final)
    file = heard.problem.written
    # numbers that went along with something unknown say nothing of the machine
    astray = not kept and foretells(heard.held, final.model, file)
    final = heard.problem.centred(heard.problem.fitted(file, rounds=0) if astray else final)
    # beside the noise of all channels as it is in the end
    nothing = unsized(heard.problem, final)
    held = held.doubting([k for n, k in enumerate(kept) if n in nothing])
    weighed = [held.named.get(k, held.weighed[k]) for k in kept]
    told = causes_of(heard, found.start, final, weighed)
    causes = [cause for k, cause in zip(kept, told, strict=True) if k in held.named]
    beside = [cause for k, cause in zip(kept, told, strict=True) if k not in held.named]
    channels = gaps(heard.held, file, final.model)
    repaired = doubted(patched(heard.problem, final.model, given), channels)
    report('running the patched instrument in closed loop', 0.92)
    segments = heard.problem.rollouts.segments
    each = [patched(heard.problem, final.model, instrument, s.name) for s in segments]
    loops = closed_loop_gap(runs, instrument, each, segments)
    verdict = verdict_of(causes, beyond)
    settled = verdict in ('no_gap', 'explained')
    ahead: tuple[NextExperiment, ...] = ()
    if plan and verdict != 'no_gap':
        names = sorted(measured)
        rig = with_encoders(instrument, given)
        ahead = next_experiments(rig, names, problem, found, held, jobs, patience, report)
    others = [*gather.alternatives(problem, found, held), *gather.read_right(heard, final)]
    moved = gather.moved(heard.problem, final, others)
    differs = disagreement(heard, final, asked, beyond)
    diagnosis = Diagnosis(
        verdict=verdict,
        gap=channels,
        fitted={name: off.rms for name, off in offs(heard.held, found.start.model).items()},
        closed_loop=loops.gaps,
        where=places.listed,
        causes=tuple(sorted(causes, key=lambda c: -c.probability)),
        beside=tuple(sorted(beside, key=lambda c: c.shrink.after - c.shrink.without_this)),
        candidates=judged(
            found,
            causes,
            [w.chance for w in held.weighed],
            candidates,
            strained(heard.problem, final.model),
            alone(instrument),
            seen,
            {f'motor_{d.motor}' for d in drives(instrument) if d.by_torque},
        ),
        unexplained=Unexplained(
            probability=beyond, where=places.unexplained, regime=places.unexplained_regime
        ),
        next_experiment=ahead,
        doubts=(
            *unheard_words(recordings, runs, given),
            *strong_words(runs, instrument),
            *weak_words(heard, final.model),
            *scaled_words(final.model, contested(problem, found)),
            *lost_words(heard, final.model),
            *([end.words] if end else brief_words(heard, final.model)),
            *absurd_words([m for m in moved if m.quantity in SCALING]),
            *([apart_words(differs)] if differs else []),
            *(ended_words(moved) if beyond >= NAMED and not (differs or end) else []),
            *(loud_words(heard) if settled else []),
            *(coarse_words(heard, much=True) if verdict == 'no_gap' else []),
        ),
        left_out=(
            *([] if settled else loud_words(heard)),
            *(coarse_words(heard) if verdict == 'no_gap' else []),
            *intake.left_out,
            *said_of_torque(instrument),
            *held_on,
            *([early_words(held.early)] if held.early else []),
            *([logged_words(found.final.model, held.logged)] if held.logged else []),
            *([known_words(ready.looser)] if ready.looser > 1.0 else []),
            *([ASTRAY] if astray else []),
            *loops.left_out,
            *gather.pushed_words(heard),
            *gather.worse_words(channels),
            *absurd_words([m for m in moved if m.quantity not in SCALING]),
            *patience.words(found.unmet),
        ),
    )
    evidence = Evidence(
        instrument=instrument.name,
        recordings=tuple(r.name for r in runs),
        traces=gather.traces(heard, final.model),
        closed_loop=loops.traces,
        steps=gather.steps(heard, found),
        floors=gather.floors(heard.problem),
        moved=moved,
        told=telling.told(heard.problem, final),
        rivals=gather.rivals(found),
        seconds=time.monotonic() - began,
    )
    report('done', 1.0)
    return Outcome(diagnosis, evidence, repaired, held.weighed)
