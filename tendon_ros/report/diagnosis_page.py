"""The page of a diagnosis: the verdict, then where, which and how far, then the evidence."""

from __future__ import annotations

from collections.abc import Mapping

from tendon_ros import __version__
from tendon_ros.diagnose.evidence import Evidence
from tendon_ros.diagnose.result import Cause, Diagnosis
from tendon_ros.diagnose.together import alone
from tendon_ros.effects import find
from tendon_ros.report.blocks import (
    Banner,
    Block,
    Card,
    Columns,
    Details,
    Listing,
    Tile,
    Tone,
)
from tendon_ros.report.diagnosis_evidence import evidence_sections, gap_table
from tendon_ros.report.diagnosis_figures import (
    cause_bars,
    channel_bars,
    OTHER,
    step_bars,
    where_map,
    worth_bars,
)
from tendon_ros.report.diagnosis_sums import in_floors, overall
from tendon_ros.report.diagnosis_together import together
from tendon_ros.report.diagnosis_verdict import (
    beside_words,
    CLEARLY,
    headline,
    LABELS,
    LIKELY,
    likenesses,
    rest_words,
    sizes,
    UNIT,
    where_words,
    worth,
)
from tendon_ros.report.diagnosis_words import (
    channel_words,
    count,
    effect_words,
    inside,
    joined,
    likely_at,
    number,
    percent,
    place_words,
    with_interval,
)
from tendon_ros.report.page import html, Page, Prose, Section, Table

_TONES: Mapping[str, Tone] = {
    'no_gap': 'good',
    'explained': 'good',
    'partly_explained': 'fair',
    'unexplained': 'bad',
}


def diagnosis_page(diagnosis: Diagnosis, evidence: Evidence) -> str:
    """
    Return the report of a diagnosis.

    :param diagnosis: the answer.
    :param evidence: what it rests on.
    :return: the HTML of a self-contained file.
    """
    sections = [_which(diagnosis), _how_far(diagnosis, evidence)]
    if _placed(diagnosis):
        sections.insert(0, _where(diagnosis))
    if diagnosis.verdict != 'no_gap':
        sections.append(_rest(diagnosis))
    if diagnosis.next_experiment:
        sections.append(_next(diagnosis))
    page = Page(
        f'Sim-to-real gap of {evidence.instrument}',
        (_data(diagnosis, evidence),),
        (*sections, *evidence_sections(diagnosis, evidence)),
        f'Made by tendon diagnose, tendon_ros {__version__}.',
        Banner(
            LABELS[diagnosis.verdict],
            headline(diagnosis),
            UNIT,
            _tone(diagnosis),
            _tiles(diagnosis),
            [f'But {doubt}.' for doubt in diagnosis.doubts],
        ),
    )
    return html(page)


def _tone(diagnosis: Diagnosis) -> Tone:
    tone = _TONES[diagnosis.verdict]
    return 'fair' if diagnosis.doubts and tone == 'good' else tone


def _data(diagnosis: Diagnosis, evidence: Evidence) -> str:
    names = evidence.recordings
    shown = ', '.join(names[:4]) + (', …' if len(names) > 4 else '')
    text = f'{count(len(names), "recording")} ({shown}), {count(len(diagnosis.gap), "channel")}.'
    if diagnosis.left_out:
        text += ' Notes on it: see About this run.'
    return text


def _tiles(diagnosis: Diagnosis) -> tuple[Tile, ...]:
    before, after = (number(x) for x in overall(diagnosis))
    where = ('nowhere', 'no cause to be placed')
    if _placed(diagnosis):
        where = where_words(diagnosis.where)
    if diagnosis.causes:
        first, *others = diagnosis.causes
        which = effect_words(first.effect, first.place)
        text = percent(first.probability)
        if same := alone(diagnosis, first):
            text += f', or {count(len(same), "other")} that look the same'
        if others:
            text += f', and {count(len(others), "more cause")}'
    elif diagnosis.verdict == 'no_gap':
        which, text = 'None', f'{count(len(diagnosis.candidates), "candidate")} weighed'
    else:
        which = 'Nothing certain' if diagnosis.beside else 'None of the catalogue'
        text = f'{percent(diagnosis.unexplained.probability)} that it is something else'
        if diagnosis.beside:
            text = f'it acts like {likenesses(diagnosis.beside)}; {text}'
    far, unit = f'{before} → {after}', 'noise deviations; the floor is 1'
    if diagnosis.verdict == 'no_gap':
        far = before
    return (
        Tile('WHERE', where[0][:1].upper() + where[0][1:], where[1], _anchor(diagnosis)),
        Tile('WHICH', which, text, 'which'),
        Tile('HOW FAR', far, unit, 'how-far'),
    )


def _anchor(diagnosis: Diagnosis) -> str:
    return 'where' if _placed(diagnosis) else 'how-far'


def _placed(diagnosis: Diagnosis) -> bool:
    """Return whether the page says where the gap lies: shares of noise would mislead."""
    return bool(diagnosis.where) and diagnosis.verdict != 'no_gap'


def _where(diagnosis: Diagnosis) -> Section:
    place, share = where_words(diagnosis.where)
    blocks: list[Block] = [Prose(f'{place[:1].upper()}{place[1:]} has most: {share}.')]
    figure = where_map(diagnosis.where)
    blocks.append(figure)
    if OTHER in (*figure.rows, *figure.columns):
        header = ('place', 'regime', 'share')
        rows = tuple((place_words(w.place), w.regime, percent(w.share)) for w in diagnosis.where)
        blocks.append(Details('Every place and regime', (Table(header, rows),)))
    return Section('Where it lies', tuple(blocks), 'where')


def _which(diagnosis: Diagnosis) -> Section:
    bars = cause_bars(diagnosis)
    cards: list[Block] = [_card(diagnosis, cause) for cause in diagnosis.causes]
    blocks: list[Block] = []
    if not cards:
        weighed = count(len(diagnosis.candidates), 'candidate')
        none = (
            f'{weighed} of the catalogue, each effect at each place where it can act, were '
            'weighed. None is named as a cause.'
        )
        blocks.append(Prose(none))
    if len(cards) == 1:
        blocks.append(Columns((*((bars,) if bars.rows else ()), *cards)))
    else:
        blocks += [bars] if bars.rows else []
        blocks += [Columns(tuple(cards))] if cards else []
    if diagnosis.beside:
        blocks += [Prose(beside_words(diagnosis)), _beside(diagnosis)]
    return Section('Which effects cause it', tuple(blocks), 'which')


def _beside(diagnosis: Diagnosis) -> Table:
    rows = []
    for cause in diagnosis.beside:
        channel, text = worth(diagnosis, cause)
        rows.append(
            (
                effect_words(cause.effect, cause.place),
                percent(cause.probability),
                sizes(cause),
                f'{channel}: {text}' if channel else '',
            )
        )
    header = ('effect', 'probability', 'parameters', 'where it shows most')
    return Table(header, tuple(rows), 'Used, though not named.', wraps=True)


def _card(diagnosis: Diagnosis, cause: Cause) -> Card:
    blocks: list[Block] = []
    known = {p.name: p for p in find(cause.effect).parameters}
    rows = []
    for name, found in cause.parameters.items():
        value, interval = with_interval(found.value, found.ci95, found.unit)
        if known[name].neutral == 1.0:
            value = f'× {value}'
        rows.append((f'{name}: {known[name].meaning}', value, interval))
    if rows:
        blocks.append(Table(('parameter', 'value', '95 % interval'), tuple(rows), wraps=True))
    if cause.recording:
        blocks.append(Prose(f'It happened in {cause.recording} alone.'))
    channel, text = worth(diagnosis, cause)
    if channel:
        blocks.append(Prose(f'It shows most in {channel}: {text}.'))
    same = [inside(effect_words(c.effect, c.place)) for c in alone(diagnosis, cause)]
    if same:
        blocks.append(Prose(f'These channels cannot tell it from {joined(same)}.'))
    if both := together(diagnosis, cause):
        blocks.append(Prose(f'{both[:1].upper()}{both[1:]}.'))
    return Card(effect_words(cause.effect, cause.place), percent(cause.probability), tuple(blocks))


def _how_far(diagnosis: Diagnosis, evidence: Evidence) -> Section:
    blocks: list[Block] = [channel_bars(diagnosis.gap, 'Channel by channel')]
    steps = [step_bars(evidence.steps)] if evidence.steps and diagnosis.causes else []
    if diagnosis.causes:
        steps.append(worth_bars(diagnosis))
    if diagnosis.gap:
        blocks.append(
            Details('The same in numbers', (gap_table(diagnosis.gap, diagnosis.fitted),))
        )
    if steps:
        blocks.append(Columns(tuple(steps)))
    return Section('How far it shrinks', tuple(blocks), 'how-far')


def _rest(diagnosis: Diagnosis) -> Section:
    rest = diagnosis.unexplained
    text = (
        f'With a probability of {percent(rest.probability)} something is at work that the '
        'catalogue does not have.'
    )
    if rest.where and rest.probability >= LIKELY:
        text += f' What remains lies {likely_at(rest.where)}'
        text += f' ({rest.regime}).' if rest.regime else '.'
    blocks: list[Block] = [Prose(text)]
    above = [g for g in diagnosis.gap if in_floors(g)[1] > CLEARLY]
    if above:
        lines = tuple(
            f'{channel_words(g.channel)}: {number(in_floors(g)[1])} noise deviations remain'
            for g in sorted(above, key=lambda g: -in_floors(g)[1])
        )
        blocks.append(Listing(lines))
    elif diagnosis.gap:
        blocks.append(
            Prose(
                'No channel is clearly above its noise floor any more: all remain below '
                f'{number(CLEARLY)} noise deviations.'
            )
        )
    if why := rest_words(diagnosis):
        blocks.append(Prose(why))
    return Section('What is left', tuple(blocks), 'left')


def _next(diagnosis: Diagnosis) -> Section:
    cards = []
    for step in diagnosis.next_experiment:
        blocks: list[Block] = []
        if step.do:
            blocks.append(Prose(f'Do: {step.do}'))
        if step.add_channel and step.add_channel not in step.do:
            blocks.append(Prose(f'Channel to record: {step.add_channel}'))
        names = [inside(effect_words(*pair)) for pair in step.separates]
        title = f'Tells apart {joined(names)}' if len(names) > 1 else f'Shows {joined(names)}'
        cards.append(Card(title if names else 'To know more', '', tuple(blocks), 'pale'))
    return Section('Next experiment', (Columns(tuple(cards)),), 'next')
