"""The figures of a diagnosis: where the gap lies, which causes it has, how far it shrinks."""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.evidence import Rival, Step
from tendon_ros.diagnose.result import ChannelGap, Diagnosis, Where
from tendon_ros.diagnose.together import alone
from tendon_ros.report.blocks import Bar, Bars, HeatMap, Tone
from tendon_ros.report.diagnosis_sums import by_place, floor_of, in_floors
from tendon_ros.report.diagnosis_verdict import worth
from tendon_ros.report.diagnosis_words import (
    channel_words,
    count,
    effect_words,
    gap_scale,
    inside,
    joined,
    number,
    percent,
    place_words,
)

_MOST_ROWS, _MOST_COLUMNS = 10, 6
OTHER = 'other'  # what has no room in the map
_LIKELY = 0.05  # candidates less likely than that are no rivals of what was named
_MOST_CANDIDATES = 4
_FLOOR: tuple[Tone, str] = ('level', 'noise floor')


def where_map(where: Sequence[Where]) -> HeatMap:
    """
    Return the map of the gap: places down, regimes across, shares as shades.

    :param where: shares by place and regime; what has no room is summed up as 'other'.
    :return: the map.
    """
    regimes: dict[str, float] = {}
    for entry in where:
        regimes[entry.regime] = regimes.get(entry.regime, 0.0) + entry.share
    places = _kept(by_place(tuple(where)), _MOST_ROWS)
    columns = _kept(dict(sorted(regimes.items(), key=lambda item: -item[1])), _MOST_COLUMNS)
    shares = [[0.0] * len(columns) for _ in places]
    for entry in where:
        row = places.index(entry.place if entry.place in places else OTHER)
        column = columns.index(entry.regime if entry.regime in columns else OTHER)
        shares[row][column] += entry.share
    # regimes may overlap: then shares of a row are no parts of a whole, and have no sum
    parts = sum(entry.share for entry in where) < 1.02
    return HeatMap(
        'Share of the gap, by place and regime',
        tuple(place_words(place) for place in places),
        tuple(regime or 'all the time' for regime in columns),
        tuple(tuple(row) for row in shares),
        tuple(tuple(percent(x) if x > 0.0 else '' for x in row) for row in shares),
        tuple(percent(sum(row)) for row in shares) if parts and len(columns) > 1 else (),
        'Of the squared gap between measurement and instrument file. The darker, the more.',
    )


def cause_bars(diagnosis: Diagnosis) -> Bars:
    """
    Return how likely each cause is, with the likeliest of those that were not named.

    :param diagnosis: the answer.
    :return: a bar each; the last is the alternative that none of them is it.
    """
    rows = []
    named = {(c.effect, c.place) for c in diagnosis.causes}
    for cause in diagnosis.causes:
        same = [inside(effect_words(c.effect, c.place)) for c in alone(diagnosis, cause)]
        named |= {(c.effect, c.place) for c in cause.indistinguishable}
        note = f'Cannot be told from {joined(same)}.' if same else ''
        label = effect_words(cause.effect, cause.place)
        rows.append(Bar(label, cause.probability, percent(cause.probability), note, 'after'))
    others = [
        c
        for c in diagnosis.candidates
        if (c.effect, c.place) not in named and c.probability >= _LIKELY
    ]
    rows += [
        Bar(effect_words(c.effect, c.place), c.probability, percent(c.probability), '', 'pale')
        for c in sorted(others, key=lambda c: -c.probability)[:_MOST_CANDIDATES]
    ]
    if diagnosis.verdict != 'no_gap':
        rest = diagnosis.unexplained.probability
        label = 'None of these' if rows else 'Nothing in the catalogue'
        rows.append(Bar(label, rest, percent(rest), '', 'bad'))
    legend: list[tuple[Tone, str]] = [('after', 'named')] if diagnosis.causes else []
    if any(row.tone == 'pale' for row in rows):
        legend.append(('pale', 'considered, not named'))
    return Bars('How likely', tuple(rows), 1.0, legend=tuple(legend))


def channel_bars(gaps: Sequence[ChannelGap], title: str) -> Bars:
    """
    Return the gap of each channel before and after, against its noise floor.

    :param gaps: by channel; shown the worst first.
    :param title: of the figure.
    :return: bars in noise standard deviations, with the numbers in the channels' units.
    """
    known = [in_floors(gap)[0] for gap in gaps if gap.noise_floor > 0.0]
    full = max([1.2, *known])
    rows = [_channel_bar(g, full) for g in sorted(gaps, key=lambda g: -in_floors(g)[0])]
    return Bars(
        title,
        tuple(rows),
        full,
        'Numbers at the right: noise deviations. Thin line: 95 % interval of what remains.',
        (('before', 'instrument file'), ('after', 'with the effects'), _FLOOR),
    )


def step_bars(steps: Sequence[Step]) -> Bars:
    """
    Return how the gap shrinks as effects join.

    :param steps: from the instrument file to the whole explanation.
    :return: bars in noise standard deviations, on data that no fit has seen.
    """
    rows = []
    for k, step in enumerate(steps):
        label = _joining(step) if step.effect else _START if k == 0 else _AGAIN
        note = f'{number(step.gap)} on the data of the fit'
        tone: Tone = 'before' if k == 0 else 'after'
        rows.append(
            Bar(label, step.held_out, number(step.held_out), note, tone=tone, level=1.0),
        )
    full = max([1.2, *(step.held_out for step in steps)])
    return Bars(
        'Step by step',
        tuple(rows),
        full,
        'Noise deviations over all channels, on data that no fit has seen.',
        (_FLOOR,),
    )


def worth_bars(diagnosis: Diagnosis) -> Bars:
    """
    Return what each cause is worth: the gap without it in the channel where it shows most.

    :param diagnosis: the answer, with a cause at least.
    :return: bars in noise standard deviations of that channel.
    """
    rows = []
    for cause in diagnosis.causes:
        channel, text = worth(diagnosis, cause)
        floor = floor_of(diagnosis, cause.shrink.channel)
        if not channel or floor <= 0.0:
            continue
        without, after = cause.shrink.without_this / floor, cause.shrink.after / floor
        rows.append(
            Bar(
                f'without {inside(effect_words(cause.effect, cause.place))}',
                after,
                number(without),
                f'{channel}: {text}',
                'after',
                behind=max(without, after),
                level=1.0,
            )
        )
    full = max([1.2, *(bar.behind for bar in rows if bar.behind is not None)])
    return Bars(
        'What each is worth',
        tuple(rows),
        full,
        'Noise deviations of the channel where it shows most, when it is left out and the others '
        'are fitted again.',
        (('before', 'without it'), ('after', 'with all'), _FLOOR),
    )


def rival_bars(rivals: Sequence[Rival], named: set[tuple[str, str]], most: int) -> Bars:
    """
    Return what each candidate explains alone.

    :param rivals: every candidate that was tried.
    :param named: effect and place of the named causes.
    :param most: how many to show.
    :return: bars: the part of the squared gap that goes when this candidate alone is added.
    """
    shown = sorted(rivals, key=lambda r: -r.share)[:most]
    rows = tuple(
        Bar(
            effect_words(r.effect, r.place),
            r.share,
            percent(max(r.share, 0.0)),
            tone='after' if (r.effect, r.place) in named else 'pale',
        )
        for r in shown
    )
    text = f'The best {most} of {len(rivals)}.' if len(rivals) > most else ''
    return Bars(
        f'What {count(len(rivals), "candidate")} would explain alone',
        rows,
        1.0,
        f'Part of the squared gap that goes when this one alone is added. {text}'.strip(),
        (('after', 'named as a cause'), ('pale', 'not named')),
    )


_START = 'instrument file, numbers within tolerances'
_AGAIN = 'fitted again'


def _joining(step: Step) -> str:
    """Return what joined in a step, which may be several effects at their places."""
    pairs = zip(step.effect.split(', '), step.place.split(', '), strict=True)
    return f'+ {joined(inside(effect_words(*pair)) for pair in pairs)}'


def _channel_bar(gap: ChannelGap, full: float) -> Bar:
    factor, unit = gap_scale(gap)
    before, after, floor = (
        number(factor * x, 3) for x in (gap.before, gap.after, gap.noise_floor)
    )
    label = channel_words(gap.channel)
    if gap.noise_floor <= 0.0:
        # nothing to compare with but itself
        most = max(gap.before, gap.after) or 1.0
        value, behind = full * gap.after / most, full * gap.before / most
        text, note = f'{before} → {after}\u00a0{unit}', 'RMSE; no noise floor is known'
        return Bar(label, value, text, note, 'after', behind)
    low, high = (end / gap.noise_floor for end in gap.ci95)
    relative = in_floors(gap)
    return Bar(
        label,
        relative[1],
        f'{number(relative[0])} → {number(relative[1])}',
        f'{before} → {after} {unit} RMSE, noise floor {floor} {unit}',
        'after',
        behind=relative[0],
        level=1.0,
        span=(low, high),
    )


def _kept(sums: dict[str, float], most: int) -> list[str]:
    names = list(sums)
    return names if len(names) <= most else [*names[: most - 1], OTHER]
