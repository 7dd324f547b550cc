"""The summary of a diagnosis for a terminal: verdict, where, which, how far, what next."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from textwrap import wrap

from tendon_ros.diagnose.evidence import Moved
from tendon_ros.diagnose.result import Cause, ChannelGap, Diagnosis
from tendon_ros.diagnose.together import alone
from tendon_ros.report.diagnosis_sums import by_place, in_floors, overall
from tendon_ros.report.diagnosis_together import together
from tendon_ros.report.diagnosis_verdict import (
    beside_words,
    headline,
    LIKELY,
    MUCH,
    rest_words,
    sizes,
    worth,
)
from tendon_ros.report.diagnosis_words import (
    channel_words,
    effect_words,
    gap_scale,
    inside,
    known_words,
    likely_at,
    moved_words,
    number,
    percent,
    place_words,
)

_WIDTH = 96
_INDENT = 8
_PLACES, _CAUSES, _CHANNELS, _NUMBERS, _NEXT = 3, 4, 6, 6, 2
_SOME = 1.0  # deviations by which a number moves that has taken up a gap


def summary(diagnosis: Diagnosis, moved: Sequence[Moved] = ()) -> str:
    """
    Return what a terminal shows of a diagnosis: some ten to twenty-five lines.

    :param diagnosis: the answer.
    :param moved: numbers of the file as they were fitted; guesses, and what was measured and has
        moved far, are told, and what has moved at all where that is what became of a gap.
    :return: plain text, lines of at most 96 characters, ending in a newline.
    """
    lines = wrap(headline(diagnosis), _WIDTH)
    lines += _part('but', list(diagnosis.doubts))
    if diagnosis.verdict != 'no_gap':
        lines += _part('where', _where(diagnosis), len(by_place(diagnosis.where)) - _PLACES)
    which = [line for cause in diagnosis.causes[:_CAUSES] for line in _cause(diagnosis, cause)]
    lines += _part('which', which, len(diagnosis.causes) - _CAUSES)
    lines += _part(
        'gap',
        channel_rows(diagnosis.gap[:_CHANNELS], diagnosis.fitted),
        len(diagnosis.gap) - _CHANNELS,
    )
    if diagnosis.verdict != 'no_gap':
        lines += _part('rest', _rest(diagnosis))
    taken = diagnosis.verdict == 'no_gap' and overall(diagnosis)[0] > MUCH
    lines += _numbers(
        [one for one in moved if one.guessed or one.strained or (taken and one.off > _SOME)]
    )
    if diagnosis.beside:
        lines += _part('beside', [beside_words(diagnosis)])
    lines += _part('next', [_next(n.do, n.add_channel) for n in diagnosis.next_experiment[:_NEXT]])
    lines += _part('note', list(diagnosis.left_out[:3]))
    # blanks that kept numbers and units on one line have done their work
    return '\n'.join(lines).replace('\u00a0', ' ') + '\n'


def _part(name: str, texts: Sequence[str], more: int = 0) -> list[str]:
    lines: list[str] = []
    for text in texts:
        said = text.lstrip()
        if '  ' in said:  # a row of a table
            lines.append(text)
            continue
        first = ' ' * (len(text) - len(said))
        lines += wrap(said, _WIDTH - _INDENT, initial_indent=first, subsequent_indent='  ')
    if more > 0:
        lines.append(f'and {more} more, in the report')
    head = name.ljust(_INDENT)
    return [f'{head if k == 0 else " " * _INDENT}{line}' for k, line in enumerate(lines)]


def _numbers(moved: Sequence[Moved]) -> list[str]:
    texts = []
    told = [one for one in moved if not one.untold]
    # who measured something wants to hear of it before who guessed
    for one in sorted(told, key=lambda number: number.guessed)[:_NUMBERS]:
        quantity, by, interval = moved_words(one)
        texts.append(f'{quantity} of {place_words(one.place)} {by} ({interval}){known_words(one)}')
    lines = _part('file', texts, len(told) - _NUMBERS)
    anything: dict[str, list[str]] = {}
    for one in moved:
        if one.untold:
            anything.setdefault(moved_words(one)[0], []).append(place_words(one.place))
    unknown = '; '.join(f'{what} of {", ".join(places)}' for what, places in anything.items())
    if unknown:
        said = [f'{unknown}: a guess of which these recordings tell nothing']
        lines += _part('' if lines else 'file', said)
    return lines


def _where(diagnosis: Diagnosis) -> list[str]:
    texts = []
    for place, share in list(by_place(diagnosis.where).items())[:_PLACES]:
        regimes = [w for w in diagnosis.where if w.place == place and w.regime][:3]
        parts = '; '.join(f'{w.regime} {percent(w.share)}' for w in regimes)
        texts.append(
            f'{place_words(place)} {percent(min(share, 1.0))}' + f': {parts}' * bool(parts)
        )
    return texts


def _cause(diagnosis: Diagnosis, cause: Cause) -> Iterable[str]:
    words = effect_words(cause.effect, cause.place)
    yield f'{percent(cause.probability)} {words}: {sizes(cause)}'.rstrip(' :')
    if cause.recording:
        yield f'  in {cause.recording} alone'
    others = [inside(effect_words(c.effect, c.place)) for c in alone(diagnosis, cause)]
    if others:
        yield f'  these channels cannot tell it from {", ".join(others)}'
    if same := together(diagnosis, cause):
        yield f'  {same}'
    channel, text = worth(diagnosis, cause)
    if channel:
        yield f'  {channel}: {text}'


def channel_rows(
    gaps: Sequence[ChannelGap], fitted: Mapping[str, float] | None = None
) -> list[str]:
    """
    Return a table of gaps.

    :param gaps: one row each.
    :param fitted: RMSE with fitted numbers alone, by channel; no column without.
    :return: lines with a head; none without gaps.
    """
    if not gaps:
        return []
    rows: list[tuple[str, ...]] = [
        ('channel', 'before', 'fitted', 'after', 'floor', '', 'before/floor', 'after/floor')
    ]
    for gap in gaps:
        factor, unit = gap_scale(gap)
        between = fitted[gap.channel] if fitted else gap.before
        rmse = (number(factor * x, 3) for x in (gap.before, between, gap.after, gap.noise_floor))
        rows.append((channel_words(gap.channel), *rmse, unit, *map(_ratio, in_floors(gap))))
    if not fitted:
        rows = [(*row[:2], *row[3:]) for row in rows]
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    left = (0, len(rows[0]) - 3)
    return [
        '  '.join(
            cell.ljust(w) if k in left else cell.rjust(w)
            for k, (cell, w) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _ratio(value: float) -> str:
    return number(value) if isfinite(value) else '–'


def _rest(diagnosis: Diagnosis) -> list[str]:
    rest = diagnosis.unexplained
    likely = rest.probability >= LIKELY
    at = f', {likely_at(rest.where)}' if rest.where and likely else ''
    during = f' ({rest.regime})' if rest.regime and likely else ''
    said = [f'{percent(rest.probability)} that something not named is behind it{at}{during}']
    why = rest_words(diagnosis)
    return [*said, why] if why else said


def _next(do: str, add_channel: str) -> str:
    if not add_channel or add_channel in do:
        return do
    return f'{do}, and record {add_channel}' if do else f'record {add_channel}'
