"""
Calibration: what an instrument file says of one machine, fitted anew to another of its kind.

A diagnosis names effects on one tool; the next tool of the same make has the same effects in other
sizes. So no cause is looked for: the file's effects and what it leaves open are fitted to a short
recording. Each parameter that moves further than its interval did not carry over. How many seconds
it takes is found with the beginning of the recording alone, judged on what no fit has seen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.gap import gaps
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intervals import parameter_intervals
from tendon_ros.diagnose.patch import doubted, patched
from tendon_ros.diagnose.prepare import Prepared, prepared
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.identify.candidate import Candidate, opened
from tendon_ros.identify.driving import as_recorded, said_of_torque
from tendon_ros.identify.explanation import BENT, BRISTLES, is_bristle, Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.magnitude import Magnitude, magnitude_of, magnitudes
from tendon_ros.model.effect_use import units_at
from tendon_ros.model.instrument import EffectUse, Instrument

#: [s] from the beginning that are tried
SECONDS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
#: times the misfit after all data that is as good
AS_GOOD = 1.1


@dataclass(frozen=True)
class Carried:
    """One parameter of an effect in the file: what it was, and what it is here with its 95 %."""

    effect: str
    place: str
    parameter: str
    unit: str
    before: float
    after: float
    low: float
    high: float

    @property
    def holds(self) -> bool:
        """Whether the file's value lies within the interval."""
        return self.low <= self.before <= self.high


@dataclass(frozen=True)
class Beginning:
    """What the first seconds suffice for: misfit on what no fit has seen, in noise deviations."""

    seconds: float
    misfit: float


@dataclass(frozen=True)
class Calibration:
    """
    An instrument fitted to a machine.

    ``gap``: channels on what no fit has seen, with the file as it is and calibrated; ``misfit``:
    the same over all of them, in noise deviations; ``needed`` [s]: what suffices, None where only
    all of the recording does.
    """

    instrument: Instrument
    parameters: tuple[Carried, ...]
    gap: tuple[ChannelGap, ...]
    misfit: tuple[float, float]
    beginnings: tuple[Beginning, ...]
    needed: float | None
    left_out: tuple[str, ...]


def calibrate(
    recordings: Sequence[Recording],
    instrument: Instrument,
    report: Callable[[str, float], None] = lambda _what, _done: None,
) -> Calibration:
    """
    Fit what an instrument file has already to recordings of another machine.

    :param recordings: of one machine.
    :param instrument: with effects, as ``tendon diagnose`` writes it.
    :param report: called with what is being done and the part that is done, 0 to 1.
    :return: the calibrated instrument, what moved, and how much data it takes.
    :raises RecordingError: on recordings that cannot be used, or a file with nothing to fit.
    """
    fitted = tuple(use for use in instrument.effects if _is_fitted(use))
    rest = tuple(use for use in instrument.effects if use not in fitted)
    plain = replace(instrument, effects=tuple(use for use in rest if not is_bristle(use)))
    plain = as_recorded(plain, {name for r in recordings for name in r.channels})
    report('looking at the recordings', 0.0)
    intake = admitted(recordings, plain)
    plain = intake.instrument
    ready = prepared(intake.recordings, plain)
    start = _start(
        ready.problem,
        fitted,
        [use for use in instrument.effects if use.effect == BENT],
        magnitudes(plain, magnitude_of(intake.recordings, plain)),
    )
    if not start.causes and not ready.problem.tolerances:
        raise RecordingError(
            f'{instrument.name}: nothing to calibrate: the file has no effects and leaves no '
            'number open; give the instrument.yaml of a diagnosis'
        )
    report('fitting all of the recording', 0.1)
    ready = ready.heard_again(ready.problem.fitted(start, rounds=20).model)
    final = ready.problem.centred(ready.problem.fitted(start, rounds=20))
    beginnings = []
    length = min(float(s.time[-1]) for s in ready.problem.rollouts.segments)
    tried = [seconds for seconds in SECONDS if seconds < length]
    for n, seconds in enumerate(tried):
        report(f'fitting the first {seconds:g} s', 0.4 + 0.6 * n / len(tried))
        model = _beginning(ready, seconds).fitted(start, rounds=20).model
        beginnings.append(Beginning(seconds, _misfit(ready.held, model)))
    report('done', 1.0)
    misfit = _misfit(ready.held, final.model)
    left = gaps(ready.held, start, final.model)
    enough = [
        b.seconds
        for n, b in enumerate(beginnings)
        if all(later.misfit < AS_GOOD * misfit for later in beginnings[n:])
    ]
    return Calibration(
        instrument=doubted(
            patched(ready.problem, final.model, replace(plain, sensors=instrument.sensors)), left
        ),
        parameters=tuple(_carried(ready.problem, final, fitted)),
        gap=left,
        misfit=(_misfit(ready.held, start), misfit),
        beginnings=tuple(beginnings),
        needed=enough[0] if enough else None,
        left_out=(*intake.left_out, *said_of_torque(plain)),
    )


def _is_fitted(use: EffectUse) -> bool:
    """Return whether an effect has a size that may differ from machine to machine."""
    one = Candidate(use.effect, use.place)
    return one.scales and not one.instants and not is_bristle(use)


def _start(
    problem: Problem,
    effects: Sequence[EffectUse],
    bent: Sequence[EffectUse],
    large: Mapping[str, Magnitude],
) -> Model:
    """Return the model that the file is."""
    model = problem.empty
    for use in effects:
        candidate = Candidate(
            use.effect,
            use.place,
            magnitude=large[use.place],
            opened=opened(problem.rollouts.instrument, use.effect, use.place),
        )
        neutral = {p.name: p.neutral for p in candidate.parameters}
        model = model.joined(candidate, {**neutral, **use.parameters})
    known = {
        (use.place, name): axis.place(use.parameters[name])
        for use in bent
        for name, axis in BRISTLES.items()
        if use.parameters.get(name, 0.0) > 0.0
    }
    bristle = {key: known.get(key, z) for key, z in model.bristle.items()}
    return replace(model, bristle=bristle)


def _beginning(ready: Prepared, seconds: float) -> Problem:
    """Return the problem of the first seconds of each recording."""
    whole = ready.whole
    used = [
        mask.any(axis=0) & (segment.time < seconds)
        for mask, segment in zip(whole.masks, whole.rollouts.segments, strict=True)
    ]
    return Problem(whole.rollouts, whole.tolerances, used)


def _misfit(held: Problem, model: Model) -> float:
    left = held.left(model)
    return float(np.sqrt(np.mean(left**2))) if left.size else 0.0


def _carried(problem: Problem, final: Fit, effects: Sequence[EffectUse]) -> list[Carried]:
    rows = []
    intervals = parameter_intervals(problem, final)
    for k, use in enumerate(effects):
        values = final.model.values(k)
        units = units_at(problem.rollouts.instrument, use.effect, use.place)
        for p in final.model.causes[k].parameters:
            low, high = intervals[k][p.name]
            before = use.parameters.get(p.name, p.neutral)
            unit = units[p.name]
            row = Carried(use.effect, use.place, p.name, unit, before, values[p.name], low, high)
            rows.append(row)
    return rows
