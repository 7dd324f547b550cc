"""
The paper's Figs. 13 to 15 told by a diagnosis: what its authors found by hand, by machine.

The ladder runs the paper's own experiment in closed loop with what the diagnosis found, joined in
the order of the paper: preload, friction by tension, static friction, then whatever else it named.
Nothing here helps the diagnosis, and what it named wrongly is said to be wrong.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.result import Cause, Diagnosis
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.paper.force_profile import RESTS
from tendon_ros.model.paper.rig import mean_between, under_control
from tendon_ros.model.paper.withheld_rig import Use3, WITHHELD
from tendon_ros.model.trajectory_profiles import paper_fig12
from tendon_ros.report.diagnosis_words import effect_words, inside, joined, percent, with_interval

FloatArray = NDArray[np.float64]

#: until then, the paper says, its adjusted model agrees with the rig [s]
AGREES = 5.0


@dataclass(frozen=True)
class Claim:
    """What the authors concluded, and the effect and places that it means here."""

    said: str
    figure: str
    effect: str
    places: tuple[str, ...]


#: in the order of the paper
CLAIMS = (
    Claim('10 % lower pretension between L and 3', 'Fig. 15', 'pretension', ('cable_L3',)),
    Claim(
        'friction opposite to the velocity and proportional to tension',
        'Fig. 15',
        'tension_friction',
        ('pulley_1', 'pulley_2', 'pulley_3'),
    ),
    Claim(
        'static friction between joint pulley and stand plate',
        'Fig. 15, after 5 s',
        'stribeck_friction',
        ('pulley_3',),
    ),
)


@dataclass(frozen=True)
class Finding:
    """
    One withheld effect and what the diagnosis says of it.

    ``cause`` is the one that names it, or that it is said to be indistinguishable from; None where
    there is none. ``instead`` are the causes named at its place that are not true; ``chance`` is
    the probability that it was given, named or not.
    """

    claim: Claim
    truth: Use3
    cause: Cause | None
    instead: tuple[Cause, ...]
    chance: float

    @property
    def exactly(self) -> bool:
        """Whether it is named itself, not one that looks the same."""
        return self.cause is not None and _key(self.cause) == self.truth[:2]


@dataclass(frozen=True)
class Rung:
    """
    The paper's experiment with some of what was found.

    ``force`` [N] at the stamps of the load cell; ``rests`` [N] by the keys of RESTS; RMSE [N]
    until and after :data:`AGREES`.
    """

    label: str
    force: FloatArray
    rests: dict[str, float]
    until: float
    after: float


@dataclass(frozen=True)
class Story:
    """The load cell over the profile, the ladder, what was found, and what is not true."""

    time: FloatArray
    measured: FloatArray
    measured_rests: dict[str, float]
    rungs: tuple[Rung, ...]
    findings: tuple[Finding, ...]
    wrong: tuple[Cause, ...]


def paper_story(
    stand: Instrument, found: Instrument, diagnosis: Diagnosis, profile: Recording
) -> Story:
    """
    Tell the paper's story with what a diagnosis found.

    :param stand: the instrument file that was given.
    :param found: the patched instrument that came out.
    :param diagnosis: what it says.
    :param profile: the recording of the paper's experiment, with the load cell.
    :return: the story.
    """
    cell = profile['load_cell/force']
    time = cell.time - profile.start

    def rung(label: str, rig: Instrument) -> Rung:
        rows = under_control(rig, paper_fig12(rig.motor_names))
        force = np.interp(time, rows.time, rows.contact_force[:, 0])
        off = force - cell.value
        late = time >= AGREES
        return Rung(label, force, _rests(time, force), _rms(off[~late]), _rms(off[late]))

    rungs = [rung('instrument file', stand)]
    rungs += [rung(*step) for step in _steps(found, diagnosis.causes)]
    return Story(
        time,
        np.asarray(cell.value),
        _rests(time, cell.value),
        tuple(rungs),
        tuple(_findings(diagnosis)),
        _wrong(diagnosis.causes),
    )


def told(story: Story) -> str:
    """
    Return the story in lines of text.

    :param story: of a diagnosis.
    :return: what was withheld and what was found, then the force step by step.
    """
    lines = []
    for finding in story.findings:
        lines.append(f'{_words(finding.truth)}: {_verdict(finding)}')
    for cause in story.wrong:
        words = effect_words(cause.effect, cause.place)
        lines.append(f'{words}: named with {percent(cause.probability)}, and not true')
    lines.append('force at rest [N]: ' + ', '.join(RESTS) + f'; RMSE until and after {AGREES:g} s')
    rests = ', '.join(f'{x:.2f}' for x in story.measured_rests.values())
    lines.append(f'  measured: {rests}')
    for rung in story.rungs:
        rests = ', '.join(f'{x:.2f}' for x in rung.rests.values())
        lines.append(f'  {rung.label}: {rests}; {rung.until:.2f}, {rung.after:.2f}')
    return '\n'.join(lines).replace('\u00a0', ' ')


def finding_rows(story: Story) -> tuple[tuple[str, ...], ...]:
    """
    Return a row for each withheld effect.

    :param story: of a diagnosis.
    :return: what the authors said, what was withheld, what the diagnosis says.
    """
    return tuple(
        (f'{f.claim.said} ({f.claim.figure})', _words(f.truth), _verdict(f))
        for f in story.findings
    )


def rung_rows(story: Story) -> tuple[tuple[str, ...], ...]:
    """
    Return a row for the load cell and one for each rung.

    :param story: of a diagnosis.
    :return: label, force at each rest, RMSE until and after 5 s, all in N.
    """
    measured = ('load cell', *(f'{x:.2f}' for x in story.measured_rests.values()), '', '')
    return (
        measured,
        *(
            (r.label, *(f'{x:.2f}' for x in r.rests.values()), f'{r.until:.2f}', f'{r.after:.2f}')
            for r in story.rungs
        ),
    )


def _steps(found: Instrument, causes: Sequence[Cause]) -> list[tuple[str, Instrument]]:
    """Return the patched instrument without causes, then with them, claim by claim."""
    named = {_key(c) for c in causes}
    # the angle over which friction builds up comes with the friction of its pulley
    bristles = {u.place: u for u in found.effects if _is_bristle(u, named)}
    plain = [u for u in found.effects if (u.effect, u.place) not in named]
    joined_ones = [u for u in plain if u not in bristles.values()]
    steps = [('numbers within tolerance', replace(found, effects=tuple(joined_ones)))]
    tests: list[tuple[str, Callable[[EffectUse], bool]]] = [
        (f'+ {inside(c.said)}', lambda u, c=c: u.effect == c.effect and u.place in c.places)  # type: ignore[misc]
        for c in CLAIMS
    ]
    tests.append(('+ what else was named', lambda _: True))
    left = [u for u in found.effects if (u.effect, u.place) in named]
    for label, belongs in tests:
        new = [u for u in left if belongs(u)]
        if not new:
            continue
        left = [u for u in left if u not in new]
        joined_ones += new
        joined_ones += [bristles.pop(u.place) for u in new if u.place in bristles]
        steps.append((label, replace(found, effects=tuple(joined_ones))))
    return steps


def _is_bristle(use: EffectUse, named: set[tuple[str, str]]) -> bool:
    return use.effect == 'presliding_friction' and (use.effect, use.place) not in named


def _findings(diagnosis: Diagnosis) -> list[Finding]:
    true = {use[:2] for use in WITHHELD}
    causes = diagnosis.causes
    chances = {(c.effect, c.place): c.probability for c in diagnosis.candidates}
    rows = []
    for claim in CLAIMS:
        for truth in WITHHELD:
            if truth[0] != claim.effect or truth[1] not in claim.places:
                continue
            exact = [c for c in causes if _key(c) == truth[:2]]
            same = [c for c in causes if truth[:2] in {(o.effect, o.place)
                                                       for o in c.indistinguishable}]  # fmt: skip
            instead = [c for c in causes if c.place == truth[1] and _key(c) not in true]
            cause = next(iter(exact + same), None)
            chance = chances.get((truth[0], truth[1]), 0.0)
            rows.append(Finding(claim, truth, cause, tuple(instead), chance))
    return rows


def _wrong(causes: Sequence[Cause]) -> tuple[Cause, ...]:
    true = {use[:2] for use in WITHHELD}
    return tuple(
        c
        for c in causes
        if _key(c) not in true and not {(o.effect, o.place) for o in c.indistinguishable} & true
    )


def _verdict(finding: Finding) -> str:
    cause = finding.cause
    if cause is None:
        text = f'not named ({percent(finding.chance)})'
        if finding.instead:
            said = [inside(effect_words(c.effect, c.place)) for c in finding.instead]
            text += f'; instead {joined(said)}'
        return text
    if not finding.exactly:
        words = inside(effect_words(cause.effect, cause.place))
        return f'said to look the same as {words} ({percent(cause.probability)})'
    values = []
    for name, true in finding.truth[2].items():
        fitted = cause.parameters[name]
        value, interval = with_interval(fitted.value, fitted.ci95, fitted.unit)
        values.append(f'{name} {value} ({interval}; true {true:g})')
    return f'named with {percent(cause.probability)}: {", ".join(values)}'


def _words(use: Use3) -> str:
    return effect_words(use[0], use[1])


def _key(cause: Cause) -> tuple[str, str]:
    return cause.effect, cause.place


def _rests(time: FloatArray, force: FloatArray) -> dict[str, float]:
    return {name: mean_between(time, force, *part) for name, part in RESTS.items()}


def _rms(off: FloatArray) -> float:
    return float(np.sqrt(np.mean(off**2)))
