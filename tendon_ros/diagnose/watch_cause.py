"""Leading causes of a window's gap: where to look before there is a diagnosis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math

from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.screening import Screen
from tendon_ros.model.effect_use import units_at
from tendon_ros.model.instrument import EffectUse, Instrument

#: causes that are named
MOST = 5
#: proposals that are judged again at the size that they propose, and those that are then fitted
CORRECTED, FITTED = 12, 7
#: part of what the leading cause explains from which on another place may be it too
NEAR = 0.9
#: part of what it explains that an event is worth beside what acts all the time: with an instant
#: to choose, it takes credit for whatever happens in a few seconds
EVENT = 0.7


@dataclass(frozen=True)
class Suspect:
    """
    An effect at a place that would explain ``share`` of what is left, 0 to 1.

    ``values``: of its parameters; an event's times are left out. ``units``: of these.
    """

    effect: str
    place: str
    share: float
    values: Mapping[str, float]
    units: Mapping[str, str]

    def __str__(self) -> str:
        numbers = ', '.join(
            f'{name} {value:.3g}' + ('' if self.units[name] == '1' else f' {self.units[name]}')
            for name, value in self.values.items()
        )
        return f'{self.effect} at {self.place} ({numbers}; explains {self.share:.0%})'


def suspects_of(problem: Problem, candidates: Sequence[Candidate]) -> tuple[Suspect, ...]:
    """
    Return which effects would explain most of what a window leaves, tolerances moved.

    :param problem: the window.
    :param candidates: all that may be named.
    :return: the leading ones, most first; empty where nothing explains anything.
    """
    fit = problem.fitted(problem.empty, rounds=4, accuracy=1e-2)
    if not math.isfinite(fit.cost) or fit.cost <= 0.0:
        return ()
    screen = Screen(problem, fit)
    first = [p for c in candidates for p in screen.proposals(c)[:1] if p.gain > 0.0]
    first.sort(key=lambda p: -p.gain)
    second = [screen.corrected(p) for p in first[:CORRECTED]]
    second.sort(key=lambda p: -p.gain)
    known = problem.slopes(fit)
    found = []
    for proposal in second[:FITTED]:
        candidate = proposal.candidate
        model = fit.model.joined(candidate, proposal.values)
        fitted = problem.fitted(model, known, rounds=3, accuracy=3e-2)
        if not fitted.cost < fit.cost:
            continue
        timed = {p.name for p in candidate.parameters if p.search in ('instant', 'duration')}
        share = (1.0 - fitted.cost / fit.cost) * (EVENT if timed else 1.0)
        values = {n: v for n, v in fitted.model.values(-1).items() if n not in timed}
        units = units_at(problem.rollouts.instrument, candidate.effect, candidate.place)
        found.append(Suspect(candidate.effect, candidate.place, share, values, units))
    return tuple(sorted(found, key=lambda s: -s.share)[:MOST])


def places_of(suspects: Sequence[Suspect]) -> tuple[str, ...]:
    """
    Return where the gap lies: the leading cause's place, and those that explain nearly as much.

    :param suspects: most first.
    :return: places, most first.
    """
    near = [s.place for s in suspects if s.share >= NEAR * suspects[0].share]
    return tuple(dict.fromkeys(near))


def as_lasting(instrument: Instrument) -> tuple[Instrument, tuple[str, ...]]:
    """
    Return an instrument whose effects hold at any time.

    Instants of a diagnosis count from the start of its recordings: what slipped then has slipped,
    and what lasted a while is over.

    :param instrument: with the effects of a diagnosis.
    :return: the instrument, and sentences on what was changed.
    """
    kept, said = [], []
    for use in instrument.effects:
        kinds = {p.search: p.name for p in find(use.effect).parameters}
        if 'duration' in kinds:
            said.append(f'{use.effect} at {use.place} is over: left out')
        elif 'instant' in kinds:
            name = kinds['instant']
            said.append(f'{use.effect} at {use.place} has happened: {name} is 0')
            kept.append(EffectUse(use.effect, use.place, {**use.parameters, name: 0.0}))
        else:
            kept.append(use)
    return replace(instrument, effects=tuple(kept)), tuple(said)
