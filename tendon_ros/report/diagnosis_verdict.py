"""The verdict of a diagnosis in a sentence with numbers."""

from __future__ import annotations

from collections.abc import Mapping

from tendon_ros.diagnose.result import Cause, Diagnosis, Where
from tendon_ros.diagnose.together import alone
from tendon_ros.effects import find
from tendon_ros.report.diagnosis_sums import by_place, fitted_alone, floor_of, in_floors, overall
from tendon_ros.report.diagnosis_words import (
    channel_words,
    count,
    effect_words,
    inside,
    joined,
    number,
    percent,
    place_words,
    scale,
    sized,
)

#: the verdict as a label
LABELS: Mapping[str, str] = {
    'no_gap': 'No gap',
    'explained': 'Explained',
    'partly_explained': 'Partly explained',
    'unexplained': 'Unexplained',
}

#: what the numbers of a verdict count in
UNIT = (
    'One noise deviation is the noise floor of a channel: as good as it gets. All gaps are on '
    'data that no fit has seen.'
)

#: noise deviations above which a channel is said to be off; and the probability from which on what
#: stays is said to have a cause that was not named
CLEARLY, LIKELY = 1.3, 0.5

#: part of a gap that goes by numbers within their tolerances, or by what is not certain, which a
#: verdict has to say first
MOST = 0.5

MUCH = 1.5  # noise deviations that a reader would call a gap
_NAMED = 3  # more effects than that make a sentence unreadable


def beside_words(diagnosis: Diagnosis) -> str:
    """
    Return what is used beside the named causes.

    :param diagnosis: the answer, with effects that hold although they are not named.
    :return: plain text with numbers.
    """
    before, after = overall(diagnosis)
    effects = [inside(effect_words(c.effect, c.place)) for c in diagnosis.beside]
    many = len(effects) > 1
    names = joined(effects)
    return (
        f'{names[:1].upper()}{names[1:]} {"hold" if many else "holds"} on what no fit has '
        f'seen, but may stand in for something else. instrument.yaml has '
        f'{"them" if many else "it"}: with all that it has, the gap of {number(before)} noise '
        f'deviations {_does(diagnosis)} to {number(after)}.'
    )


def where_words(where: tuple[Where, ...]) -> tuple[str, str]:
    """
    Return where most of the gap lies.

    :param where: shares by place and regime, not empty.
    :return: the place, and its share with the regime that weighs most there.
    """
    place, share = next(iter(by_place(where).items()))
    most = max((w for w in where if w.place == place), key=lambda w: w.share)
    text = f'{percent(min(share, 1.0))} of the gap'
    if most.regime and sum(w.place == place for w in where) > 1:
        text += f', mostly {most.regime}'
    elif most.regime:
        text += f', {most.regime}'
    return place_words(place), text


def headline(diagnosis: Diagnosis) -> str:
    """
    Return the verdict in a sentence.

    :param diagnosis: the answer.
    :return: plain text with numbers.
    """
    before, after = (number(x) for x in overall(diagnosis))
    if diagnosis.verdict == 'no_gap':
        return _no_gap(diagnosis)
    gap = _gap(diagnosis)
    if diagnosis.verdict == 'explained' and diagnosis.causes:
        return f'The {gap} is explained by {_named(diagnosis)}; {_shrinks(diagnosis)} to {after}.'
    lies = ''
    if diagnosis.where:
        place, share = where_words(diagnosis.where)
        lies = f' The largest part lies at {place} ({share}).'
    if not diagnosis.causes:
        if not diagnosis.beside:
            return f'Nothing in the catalogue explains the {gap}.{lies}'
        like = f'What acts like {likenesses(diagnosis.beside)} {_does(diagnosis)}'
        if _does_most(diagnosis):
            return (
                f'{like} the {gap} to {after}, but nothing in the catalogue explains it with any '
                f'certainty.{lies}'
            )
        nothing = f'Nothing in the catalogue explains the {gap} with any certainty.'
        # where numbers alone foretell as well, nothing else has shrunk it
        if after != before and not _by_numbers(diagnosis):
            nothing += f' {like} it to {after}.'
        return nothing + lies
    named = _named(diagnosis)
    does = 'explains' if len(diagnosis.causes) == 1 else 'explain'
    if diagnosis.verdict == 'unexplained':
        return (
            f'The {gap} stays unexplained: {named} {does} too little '
            f'of it or too uncertainly, {after} remain.{lies}'
        )
    rest = diagnosis.unexplained.where
    during = f' ({diagnosis.unexplained.regime})' if diagnosis.unexplained.regime else ''
    at = f', most likely at {place_words(rest[0])}{during},' if rest else during
    shrinks = (
        f'{_shrinks(diagnosis)} from {before}{_fitted(diagnosis)} to {after} noise deviations'
    )
    return (
        f'{named[:1].upper()}{named[1:]} {does} part of the gap: {shrinks}. The rest{at} is of no '
        'known cause.'
    )


def rest_words(diagnosis: Diagnosis) -> str:
    """
    Return why much may stay without another cause, or next to nothing with one.

    :param diagnosis: the answer.
    :return: a sentence; empty where size and probability of what stays say the same.
    """
    above = any(in_floors(g)[1] > CLEARLY for g in diagnosis.gap)
    likely = diagnosis.unexplained.probability >= LIKELY
    if above and not likely and diagnosis.causes:
        return (
            'What remains is no more than the laws of the named causes may be wrong by, and no '
            'sign of another one.'
        )
    if likely and diagnosis.gap and not above:
        if diagnosis.beside:
            return (
                'What remains with the effects beside is hardly more than noise: one of them may '
                'be it, but it is not certain which.'
            )
        return 'What remains is hardly more than noise, but has a form that noise has not.'
    return ''


def _gap(diagnosis: Diagnosis) -> str:
    """Return the gap in words, with what of it stays once numbers are fitted."""
    before, _ = overall(diagnosis)
    return f'gap of {number(before)} noise deviations{_fitted(diagnosis)}'


def _fitted(diagnosis: Diagnosis) -> str:
    """Return what stays of a gap once numbers are fitted, in parentheses, where most goes."""
    before, _ = overall(diagnosis)
    alone = fitted_alone(diagnosis)
    if alone >= MOST * before:
        return ''
    return f' ({number(alone)} once what is guessed, or within its tolerance, is fitted)'


def _does_most(diagnosis: Diagnosis) -> bool:
    """Return whether what is not certain explains most of what numbers leave."""
    _, after = overall(diagnosis)
    alone = fitted_alone(diagnosis)
    return alone**2 - after**2 > MOST * max(alone**2 - 1.0, 0.0)


def _by_numbers(diagnosis: Diagnosis) -> bool:
    """Return whether a gap shrinks, and by no more than fitted numbers alone do."""
    before, after = overall(diagnosis)
    return fitted_alone(diagnosis) <= after < before


def _shrinks(diagnosis: Diagnosis) -> str:
    it = 'with what is only likely it' if diagnosis.beside else 'it'
    return f'{it} {_does(diagnosis)}'


def _does(diagnosis: Diagnosis) -> str:
    """Return what becomes of the gap: what fits where it was fitted may not hold elsewhere."""
    before, after = overall(diagnosis)
    return 'shrinks' if after < before else 'grows'


def _no_gap(diagnosis: Diagnosis) -> str:
    channels = count(len(diagnosis.gap), 'channel')
    if not diagnosis.gap:
        return 'No gap: no channel disagrees with the model.'
    worst = max(diagnosis.gap, key=lambda g: in_floors(g)[0])
    name = channel_words(worst.channel)
    before, after = in_floors(worst)
    off = number(before)
    if before > MUCH and after < 0.5 * before:
        return (
            f'No gap that has a cause: with the numbers of the file {name} is off by {off} noise '
            f'deviations, and by {number(after)} once what is guessed, or within its tolerance, '
            'is fitted.'
        )
    if before > MUCH:
        return (
            f'No gap that has a form: {name} is off by {off} noise deviations, {number(after)} '
            'once numbers are fitted within their tolerances, but what is left is like noise, or '
            'no more than the laws of the file may be wrong by.'
        )
    if len(diagnosis.gap) == 1:
        return f'No gap: {name} is off by {off} noise deviations.'
    return (
        f'No gap: the model predicts all {channels} to within their noise; the worst, '
        f'{name}, is off by {off} noise deviations.'
    )


def _named(diagnosis: Diagnosis) -> str:
    causes = diagnosis.causes
    said = [_cause(diagnosis, cause) for cause in causes[:_NAMED]]
    if len(causes) > _NAMED:
        return f'{count(len(causes), "effect")}, first of all {joined(said)}'
    return joined(said)


def likenesses(causes: tuple[Cause, ...]) -> str:
    """
    Return what effects that may stand in for something are like: dry frictions are one.

    :param causes: the effects.
    :return: plain text.
    """
    said = [
        f'friction on {place_words(cause.place)}'
        if find(cause.effect).dry
        else inside(effect_words(cause.effect, cause.place))
        for cause in causes
    ]
    names = [*dict.fromkeys(said)]
    more = len(names) - _NAMED
    return joined([*names[:_NAMED], f'{count(more, "effect")} more'] if more > 0 else names)


def _cause(diagnosis: Diagnosis, cause: Cause) -> str:
    text = inside(effect_words(cause.effect, cause.place))
    others = alone(diagnosis, cause)
    if len(others) == 1:
        text += f' or {inside(effect_words(others[0].effect, others[0].place))}'
    elif others:
        text += f' or one of {len(others)} that look the same'
    return f'{text} ({percent(cause.probability)})'


def sizes(cause: Cause) -> str:
    """
    Return the parameters of a cause with their intervals.

    :param cause: an effect that was found.
    :return: plain text; empty where it has none.
    """
    return ', '.join(
        f'{name} {sized(found.value, found.ci95, found.unit)}'
        for name, found in cause.parameters.items()
    )


def worth(diagnosis: Diagnosis, cause: Cause) -> tuple[str, str]:
    """
    Return what a cause is worth in the channel where it shows most.

    :param diagnosis: the answer that the cause is part of.
    :param cause: an effect that was found.
    :return: the channel, and its RMSE without and with the cause; empty where none was judged.
    """
    shrink = cause.shrink
    if not shrink.channel:
        return '', ''
    floor = floor_of(diagnosis, shrink.channel)
    factor, unit = scale(shrink.unit, max(shrink.after, floor))
    values = [number(factor * x, 3) for x in (shrink.without_this, shrink.after)]
    text = f'{values[0]} {unit} RMSE without it, {values[1]} with it'
    if floor > 0.0:
        text += f' (noise floor {number(factor * floor, 3)})'
    return channel_words(shrink.channel), text
