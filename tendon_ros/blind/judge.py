"""One answer against its label: what was named, what of it is true, what was missed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tendon_ros.diagnose.result import Cause, Diagnosis

#: a cause counts as named from this probability on
NAMED = 0.5
#: below it a candidate says nothing that could be wrong
LEAST = 0.05

KNOWN = ('one', 'two_three', 'weak', 'mixed')
FOREIGN = ('withheld', 'unknown')
#: how effects are called that no catalogue has
NAMELESS = 'unknown_'


@dataclass(frozen=True)
class Judgement:
    """
    What one case adds to the score.

    ``found`` of ``truths`` effects were named at their place, or stand in the set of what cannot
    be told from a named one; ``named`` counts causes, ``wrong`` those that are not true.
    ``chances`` are stated probabilities with whether they came true; ``sizes`` of the sets of
    what was found; ``left`` is the rest of the gap by the floor; ``inside`` whether intervals hold
    the true values; ``errors`` are relative; ``idle`` is what each wrong cause shrinks;
    ``pairs`` are true and named effects. ``refused`` says why there is no answer.
    """

    case: str
    stratum: str
    channels: str
    verdict: str
    verdict_right: bool
    truths: int
    found: int
    named: int
    wrong: int
    place_right: bool
    place_near: bool
    chances: tuple[tuple[float, bool], ...]
    sizes: tuple[int, ...]
    left: float
    inside: tuple[bool, ...]
    errors: tuple[float, ...]
    idle: tuple[float, ...]
    pairs: tuple[tuple[str, str], ...]
    seconds: float
    refused: str = ''

    @property
    def right(self) -> bool:
        """Whether all that is true was named and nothing else."""
        if self.stratum in FOREIGN:
            return self.verdict_right and self.wrong == 0 and not self.refused
        told = self.verdict_right or self.stratum != 'mixed'
        return told and self.found == self.truths and self.wrong == 0 and not self.refused

    @property
    def uncertain(self) -> bool:
        """Whether something was missed but nothing wrong was named."""
        return self.found < self.truths and self.wrong == 0 and not self.refused


def judged(case: str, label: Mapping[str, Any], result: Mapping[str, Any]) -> Judgement:
    """
    Judge one case.

    :param case: its name.
    :param label: the truth.
    :param result: of the run.
    :return: what it adds to the score.
    """
    stratum, channels = label['stratum'], label['channels']
    everything = [(effect['effect'], effect['place']) for effect in label['effects']]
    truths = everything
    if stratum == 'mixed':  # nobody can name the one that no catalogue has
        truths = [t for t in everything if not t[0].startswith(NAMELESS)]
    if 'diagnosis' not in result:
        pairs = tuple((effect, 'refused') for effect, _ in truths) or (('nothing', 'refused'),)
        return Judgement(
            case, stratum, channels, 'refused', False, len(truths), 0, 0, 0, False, False,
            (), (), float('nan'), (), (), (), pairs, result['seconds'], result['error'],
        )  # fmt: skip
    said = Diagnosis.model_validate(result['diagnosis'])
    named = [cause for cause in said.causes if cause.probability >= NAMED]
    # what the catalogue does not have cannot be named rightly
    nameable = set(truths) if stratum in KNOWN else set()
    found = [t for t in truths if t in nameable and any(t in _set(c) for c in named)]
    wrong = [c for c in named if not _set(c) & nameable]
    where = [*said.unexplained.where, *(w.place for w in said.where)]
    place = everything[-1 if stratum == 'mixed' else 0][1] if everything else ''
    return Judgement(
        case=case,
        stratum=stratum,
        channels=channels,
        verdict=said.verdict,
        verdict_right=said.verdict in _right_verdicts(stratum),
        truths=len(truths),
        found=len(found),
        named=len(named),
        wrong=len(wrong),
        place_right=bool(where) and where[0] == place,
        place_near=place in where[:3],
        chances=_chances(said, nameable),
        sizes=tuple(len(_set(c)) for c in named if _set(c) & nameable),
        left=_left(said),
        inside=tuple(_inside(label, named)),
        errors=tuple(_errors(label, named)),
        idle=tuple(c.shrink.without_this / max(c.shrink.after, 1e-9) for c in wrong),
        pairs=_pairs(truths, named, nameable),
        seconds=float(result['seconds']),
    )


def _set(cause: Cause) -> set[tuple[str, str]]:
    """Return a cause with what cannot be told from it."""
    return {(cause.effect, cause.place)} | {(o.effect, o.place) for o in cause.indistinguishable}


def _right_verdicts(stratum: str) -> tuple[str, ...]:
    if stratum == 'none':
        return ('no_gap',)
    if stratum in (*FOREIGN, 'mixed'):
        return ('partly_explained', 'unexplained')
    return ('explained',) if stratum != 'weak' else ('explained', 'partly_explained', 'no_gap')


def _chances(said: Diagnosis, true: set[tuple[str, str]]) -> tuple[tuple[float, bool], ...]:
    """Return stated probabilities, one for each set of effects that cannot be told apart."""
    result, seen = [], set()
    for cause in said.causes:
        result.append((cause.probability, bool(_set(cause) & true)))
        seen |= _set(cause)
    for other in said.candidates:
        pair = (other.effect, other.place)
        if pair not in seen:
            result.append((other.probability, pair in true))
    return tuple((p, came) for p, came in result if p >= LEAST)


def _left(said: Diagnosis) -> float:
    """Return the rest of the gap by the noise floor, over all channels."""
    parts = [gap.after / gap.noise_floor for gap in said.gap if gap.noise_floor > 0.0]
    return float(np.sqrt(np.mean(np.square(parts)))) if parts else float('nan')


def _matches(label: Mapping[str, Any], named: list[Cause]) -> list[tuple[Cause, str, float]]:
    """Return true values of parameters, where exactly the true effect was named."""
    return [
        (cause, key, truth)
        for effect in label['effects']
        for cause in named
        if (cause.effect, cause.place) == (effect['effect'], effect['place'])
        for key, truth in effect['values'].items()
        if key in cause.parameters
    ]


def _inside(label: Mapping[str, Any], named: list[Cause]) -> list[bool]:
    return [
        cause.parameters[key].ci95[0] <= truth <= cause.parameters[key].ci95[1]
        for cause, key, truth in _matches(label, named)
    ]


def _errors(label: Mapping[str, Any], named: list[Cause]) -> list[float]:
    return [
        abs(cause.parameters[key].value - truth) / abs(truth)
        for cause, key, truth in _matches(label, named)
        if truth
    ]


def _pairs(
    truths: list[tuple[str, str]], named: list[Cause], nameable: set[tuple[str, str]]
) -> tuple[tuple[str, str], ...]:
    """Return true and named effects: itself, another, the right one elsewhere, or nothing."""
    result = []
    others = [c for c in named if not _set(c) & nameable]
    for effect, place in truths:
        if (effect, place) in nameable and any((effect, place) in _set(c) for c in named):
            result.append((effect, effect))
        elif others:
            other = others.pop(0)
            elsewhere = other.effect == effect
            result.append((effect, 'elsewhere' if elsewhere else other.effect))
        else:
            result.append((effect, 'nothing'))
    result += [('nothing', other.effect) for other in others]
    return tuple(result or [('nothing', 'nothing')])
