"""
A whole diagnosis: from recordings and an instrument file to the verdict and what it rests on.

Intake, preparation, search, judgement; then what was held out tells how far the gap shrinks, and
the patched instrument is run in closed loop along the recorded commands.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import time

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.closed_loop import closed_loop_gap
from tendon_ros.diagnose.evidence import Evidence, Floor, Moved, Rival, Step, Trace
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intervals import (
    deviations,
    mean_square_interval,
    parameter_intervals,
)
from tendon_ros.diagnose.judge import equals, left_over, probability, Signs, signs_of
from tendon_ros.diagnose.locate import whereabouts
from tendon_ros.diagnose.memory import Memory
from tendon_ros.diagnose.next_step import next_experiments
from tendon_ros.diagnose.patch import patched
from tendon_ros.diagnose.prepare import BLOCK, Prepared, prepared
from tendon_ros.diagnose.result import (
    Candidate as Named,
)
from tendon_ros.diagnose.result import (
    Cause,
    ChannelGap,
    Diagnosis,
    FittedParameter,
    Judged,
    Shrink,
    Unexplained,
    Verdict,
)
from tendon_ros.diagnose.search import form_power, Found, Search
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.fit import Fit, Model, Problem
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]
Report = Callable[[str, float], None]

#: a cause is named from here on
NAMED = 0.5


@dataclass(frozen=True)
class Weighed:
    """A cause that was considered to the end, whoever equals it, and what speaks for it."""

    cause: Candidate
    equal: tuple[Candidate, ...]
    signs: Signs


@dataclass(frozen=True)
class Outcome:
    """
    The verdict, what it rests on, and the instrument with the accepted effects.

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
    :return: the outcome.
    :raises RecordingError: on recordings that cannot be diagnosed.
    """
    began = time.monotonic()
    report('looking at the recordings', 0.0)
    intake = admitted(recordings, instrument)
    ready = prepared(intake.recordings, instrument)
    measured = {name for r in intake.recordings for name in r.channels}
    candidates = everyone(instrument, sorted(measured), withhold)
    search = Search(ready.problem, candidates, jobs, report, memory)
    found = search.run()
    report('judging', 0.85)
    weighed = tuple(
        Weighed(
            cause,
            tuple(r.candidate for r in equals(search.problem, found, k)),
            signs_of(search.problem, found, k, search.gains(found.without[k], found.final)),
        )
        for k, cause in enumerate(found.final.model.causes)
    )
    chances = [probability(w.signs) for w in weighed]
    accepted = [k for k, p in enumerate(chances) if p >= NAMED]
    model = found.final.model
    for k in reversed([k for k, p in enumerate(chances) if p < NAMED]):
        model = model.without(k)
    believed = found.final
    if len(accepted) < len(chances):
        believed = search.problem.fitted(model, rounds=6)
    left = search.problem.structured(believed.left)
    heard = ready.heard_again(model)
    final = heard.problem.fitted(model, rounds=6, accuracy=1e-4)
    form = form_power(search.problem, found.start, believed)
    causes = _causes(heard, found, final, [weighed[k] for k in accepted])
    places = whereabouts(ready, found, chances, left)
    beyond = left_over(left, form)
    gaps = _gaps(heard, final.model)
    repaired = patched(heard.problem, final.model, instrument)
    report('running the patched instrument in closed loop', 0.92)
    segments = heard.problem.rollouts.segments
    loops = closed_loop_gap(intake.recordings, instrument, repaired, segments)
    verdict = _verdict(causes, beyond)
    report('looking for what would separate the rest', 0.95)
    ahead = (
        next_experiments(instrument, sorted(measured), ready.problem, found, jobs) if plan else ()
    )
    diagnosis = Diagnosis(
        verdict=verdict,
        gap=gaps,
        closed_loop=loops.gaps,
        where=places.listed,
        causes=tuple(sorted(causes, key=lambda c: -c.probability)),
        candidates=_judged(found, causes, chances, candidates),
        unexplained=Unexplained(
            probability=beyond, where=places.unexplained, regime=places.unexplained_regime
        ),
        next_experiment=ahead,
        left_out=intake.left_out,
    )
    evidence = Evidence(
        instrument=instrument.name,
        recordings=tuple(r.name for r in intake.recordings),
        traces=_traces(heard, final.model),
        closed_loop=loops.traces,
        steps=_steps(heard, found),
        floors=_floors(heard.problem),
        moved=_moved(heard.problem, final),
        rivals=_rivals(found),
        seconds=time.monotonic() - began,
    )
    report('done', 1.0)
    return Outcome(diagnosis, evidence, repaired, weighed)


def _causes(heard: Prepared, found: Found, final: Fit, accepted: Sequence[Weighed]) -> list[Cause]:
    intervals = parameter_intervals(heard.problem, final)
    order = list(found.final.model.causes)
    causes = []
    for n, weighed in enumerate(accepted):
        cause = weighed.cause
        values = final.model.values(n)
        without = found.without[order.index(cause)].model
        names = dict.fromkeys((c.effect, c.place) for c in weighed.equal)
        causes.append(
            Cause(
                effect=cause.effect,
                place=cause.place,
                probability=probability(weighed.signs),
                parameters={
                    p.name: FittedParameter(
                        value=values[p.name], unit=p.unit, ci95=intervals[n][p.name]
                    )
                    for p in cause.parameters
                },
                indistinguishable=tuple(Named(effect=e, place=p) for e, p in names),
                shrink=_shrink(heard.held, found.start.model, without, final.model),
            )
        )
    return causes


def _shrink(held: Problem, start: Model, without: Model, final: Model) -> Shrink:
    """Return what a cause is worth in the channel where it shows most."""
    rows = [_by_channel(held, model) for model in (start, without, final)]
    channels = list(rows[0])
    if not channels:
        return Shrink(channel='', unit='', before=0.0, without_this=0.0, after=0.0)

    def shows(channel: str) -> float:
        return rows[1][channel][1] ** 2 - rows[2][channel][1] ** 2

    channel = max(channels, key=shows)
    return Shrink(
        channel=channel,
        unit=_units(held)[channel],
        before=rows[0][channel][0],
        without_this=rows[1][channel][0],
        after=rows[2][channel][0],
    )


def _units(problem: Problem) -> dict[str, str]:
    kinds = {
        'angle': 'rad', 'velocity': 'rad/s', 'motor_torque': 'N m', 'contact_force': 'N',
        'contact_torque': 'N m', 'loop_torque': 'N m',
    }  # fmt: skip
    return {
        m.sensor.channel: kinds[m.sensor.kind]
        for s in problem.rollouts.segments
        for m in s.measured
    }


def _by_channel(problem: Problem, model: Model) -> dict[str, tuple[float, float]]:
    """Return RMSE in the channel's unit and in noise deviations, by channel."""
    found: dict[str, tuple[float, float]] = {}
    for channel, (squares, noisy, _) in _squares(problem, model).items():
        found[channel] = (float(np.sqrt(np.mean(squares))), float(np.sqrt(np.mean(noisy))))
    return found


def _squares(
    problem: Problem, model: Model
) -> dict[str, tuple[FloatArray, FloatArray, list[float]]]:
    """Return squares in units, in noise deviations, and means of blocks in units, by channel."""
    predicted = problem.rollouts.predicted(problem.uses(model))
    parts: dict[str, list[tuple[FloatArray, FloatArray, FloatArray]]] = {}
    for n, segment in enumerate(problem.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            mask = problem.masks[n][c]
            if not mask.any():
                continue
            off = (measured.value - predicted[n][c])[mask]
            block = np.floor(segment.time[mask] / BLOCK) + 1e4 * n
            parts.setdefault(measured.sensor.channel, []).append(
                (off**2, (off / measured.noise[mask]) ** 2, block)
            )
    found = {}
    for channel, rows in parts.items():
        squares = np.concatenate([r[0] for r in rows])
        noisy = np.concatenate([r[1] for r in rows])
        block = np.concatenate([r[2] for r in rows])
        means = [float(squares[block == b].mean()) for b in np.unique(block)]
        found[channel] = (squares, noisy, means)
    return found


def _noise_of(problem: Problem) -> dict[str, float]:
    parts: dict[str, list[FloatArray]] = {}
    for n, segment in enumerate(problem.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            parts.setdefault(measured.sensor.channel, []).append(
                measured.noise[problem.masks[n][c]] ** 2
            )
    return {
        channel: float(np.sqrt(np.mean(np.concatenate(rows)))) if sum(map(len, rows)) else 0.0
        for channel, rows in parts.items()
    }


def _gaps(ready: Prepared, final: Model) -> tuple[ChannelGap, ...]:
    held = ready.held
    before = _squares(held, held.empty)
    after = _squares(held, final)
    noise = _noise_of(held)
    units = _units(held)
    rows = [
        ChannelGap(
            channel=channel,
            unit=units[channel],
            before=float(np.sqrt(np.mean(before[channel][0]))),
            after=float(np.sqrt(np.mean(after[channel][0]))),
            noise_floor=noise[channel],
            ci95=mean_square_interval(after[channel][2]),
        )
        for channel in before
    ]
    return tuple(sorted(rows, key=lambda g: -g.before / max(g.noise_floor, 1e-30)))


def _verdict(causes: Sequence[Cause], beyond: float) -> Verdict:
    if beyond < NAMED:
        return 'explained' if causes else 'no_gap'
    return 'partly_explained' if causes else 'unexplained'


def _judged(
    found: Found,
    causes: Sequence[Cause],
    chances: Sequence[float],
    candidates: Sequence[Candidate],
) -> tuple[Judged, ...]:
    """Return every candidate with its probability, and whether these data could have shown it."""
    named = {(c.effect, c.place): c for c in causes}
    shared: dict[tuple[str, str], float] = {
        (c.effect, c.place): p for c, p in zip(found.final.model.causes, chances, strict=True)
    }
    for cause in causes:
        for other in cause.indistinguishable:
            part = cause.probability / (1 + len(cause.indistinguishable))
            shared[other.effect, other.place] = max(shared.get((other.effect, other.place), 0.0),
                                                    part)  # fmt: skip
    seen = {(p.candidate.effect, p.candidate.place): p for p in found.proposals}
    rows = []
    for candidate in candidates:
        key = (candidate.effect, candidate.place)
        proposal = seen.get(key)
        why = ''
        if key in named and named[key].indistinguishable:
            others = ', '.join(f'{o.effect} at {o.place}' for o in named[key].indistinguishable)
            why = f'the data cannot tell it from {others}'
        elif proposal is None or proposal.seen < SHOWS:
            why = 'at a size worth looking for it leaves no trace in these channels and motions'
        elif proposal.own < 0.05 * proposal.seen:
            why = 'what it does, the tolerances of the file do as well'
        chance = named[key].probability if key in named else shared.get(key, 0.0)
        rows.append(
            Judged(
                effect=candidate.effect,
                place=candidate.place,
                probability=chance,
                identifiable=not why,
                why_not=why,
            )
        )
    return tuple(sorted(rows, key=lambda r: (-r.probability, r.identifiable)))


#: norm of a signature in noise deviations below which an effect cannot be seen
SHOWS = 5.0


def _traces(ready: Prepared, final: Model) -> tuple[Trace, ...]:
    whole = ready.whole
    before = whole.rollouts.predicted(whole.uses(whole.empty))
    after = whole.rollouts.predicted(whole.uses(final))
    units = _units(whole)
    found = []
    for n, segment in enumerate(whole.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            known = np.isfinite(measured.value)
            if not known.any():
                continue
            found.append(
                Trace(
                    recording=segment.name,
                    channel=measured.sensor.channel,
                    unit=units[measured.sensor.channel],
                    time=segment.time[known],
                    measured=measured.value[known],
                    before=before[n][c][known],
                    after=after[n][c][known],
                    held_out=ready.held.masks[n][c][known],
                )
            )
    return tuple(found)


def _steps(ready: Prepared, found: Found) -> tuple[Step, ...]:
    rows = []
    known: set[Candidate] = set()
    for state in found.states:
        new = [c for c in state.model.causes if c not in known]
        known |= set(new)
        held = ready.held.left(state.model)
        rows.append(
            Step(
                effect=', '.join(c.effect for c in new),
                place=', '.join(c.place for c in new),
                gap=float(np.sqrt(np.mean(state.left**2))),
                held_out=float(np.sqrt(np.mean(held**2))) if len(held) else 0.0,
            )
        )
    return tuple(rows)


def _floors(problem: Problem) -> tuple[Floor, ...]:
    units = _units(problem)
    return tuple(
        Floor(
            channel,
            units[channel],
            value,
            'differences between neighbouring bins, and the counts of the motor encoders '
            'sent through the model',
        )
        for channel, value in _noise_of(problem).items()
    )


def _moved(problem: Problem, final: Fit) -> tuple[Moved, ...]:
    spread = deviations(problem, final)
    own = len(spread) - len(problem.tolerances)
    owned = {(c.effect, c.place) for c in final.model.causes}
    return tuple(
        Moved(
            t.place,
            t.quantity,
            t.axis.value(z),
            (t.axis.value(z - 2.0 * s), t.axis.value(z + 2.0 * s)),
            t.axis.unit,
        )
        for t, z, s in zip(problem.tolerances, final.model.moved, spread[own:], strict=True)
        if (t.effect, t.place) not in owned
    )


def _rivals(found: Found) -> tuple[Rival, ...]:
    total = max(found.start.cost, 1e-30)
    return tuple(
        Rival(p.candidate.effect, p.candidate.place, min(1.0, p.gain / total))
        for p in found.proposals[:30]
    )
