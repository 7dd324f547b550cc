"""The evidence of a diagnosis as sections: traces, closed loop, candidates, noise, the run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tendon_ros.diagnose.evidence import Evidence, Moved, Told, Trace
from tendon_ros.diagnose.result import ChannelGap, Diagnosis, Judged
from tendon_ros.effects import find
from tendon_ros.report.blocks import Block, Columns, Details, Listing
from tendon_ros.report.diagnosis_figures import channel_bars, rival_bars
from tendon_ros.report.diagnosis_sums import in_floors
from tendon_ros.report.diagnosis_traces import rmse, telling, trace_figure, trace_words
from tendon_ros.report.diagnosis_words import (
    channel_words,
    count,
    effect_words,
    gap_scale,
    inside,
    known_words,
    moved_words,
    number,
    percent,
    place_words,
    scale,
    sized,
    with_interval,
    with_unit,
)
from tendon_ros.report.page import Picture, Prose, Section, Table

_MOST_RIVALS = 12
_ABREAST = 5  # recordings that fit side by side
_OPEN, _CLOSED = 6, 2  # pictures of traces: more would bury the telling ones


def evidence_sections(diagnosis: Diagnosis, evidence: Evidence) -> tuple[Section, ...]:
    """
    Return what the report shows below its answers.

    :param diagnosis: the answer.
    :param evidence: what it rests on.
    :return: the sections, without those that have nothing to show.
    """
    floors = {floor.channel: floor.value for floor in evidence.floors}
    sections: list[Section] = []
    if evidence.traces:
        open_loop = (
            'The model is driven with the measured motion of the motors and predicts every other '
            'channel. Shaded: data that no fit has seen.'
        )
        blocks = _pictures(evidence.traces, floors, open_loop, _OPEN)
        sections.append(Section('Measured and predicted', blocks, 'traces'))
    if diagnosis.closed_loop or evidence.closed_loop:
        sections.append(_closed_loop(diagnosis, evidence, floors))
    if evidence.rivals or diagnosis.candidates:
        sections.append(_considered(diagnosis, evidence))
    if evidence.told:
        sections.append(_by_recording(evidence))
    if evidence.floors or evidence.moved:
        sections.append(_basis(evidence))
    sections.append(_run(diagnosis, evidence))
    return tuple(sections)


def gap_table(gaps: Sequence[ChannelGap], fitted: Mapping[str, float] | None = None) -> Table:
    """
    Return the gap of each channel in numbers.

    :param gaps: by channel.
    :param fitted: RMSE with fitted numbers alone, by channel; no column without.
    :return: a row each: RMSE in the channel's unit and by its noise floor.
    """
    header = (
        'channel',
        'before',
        *(('numbers fitted',) if fitted else ()),
        'after',
        '95 %',
        'noise floor',
        'before / floor',
        'after / floor',
    )
    rows = []
    for gap in gaps:
        factor, unit = gap_scale(gap)
        after, interval = with_interval(factor * gap.after, _scaled(gap.ci95, factor), '1')
        rows.append(
            (
                channel_words(gap.channel),
                *(
                    f'{number(factor * x, 3)}\u00a0{unit}'
                    for x in (gap.before, *([fitted[gap.channel]] if fitted else []))
                ),
                f'{after}\u00a0{unit}',
                interval,
                f'{number(factor * gap.noise_floor, 3)}\u00a0{unit}',
                *(number(x) if gap.noise_floor > 0.0 else '–' for x in in_floors(gap)),
            )
        )
    said = 'RMSE on data that no fit has seen.'
    if fitted:
        said += ' Numbers fitted: the file within its tolerances, without any effect.'
    return Table(header, tuple(rows), said)


def _pictures(
    traces: Sequence[Trace], floors: Mapping[str, float], text: str, most: int
) -> tuple[Block, ...]:
    shown = telling(traces, floors, most)
    if len(shown) < len(traces):
        text += f' Of {len(traces)} traces, the {len(shown)} that show most; the rest in numbers.'
    pictures = []
    for trace in shown:
        light, dark = trace_figure(trace, floors.get(trace.channel))
        before, after = rmse(trace)
        factor, unit = scale(trace.unit, max(after, floors.get(trace.channel, 0.0)))
        rmses = f'{number(factor * before, 3)} → {number(factor * after, 3)}\u00a0{unit}'
        caption = f'{trace.recording}: RMSE {rmses}'
        alt = f'{trace_words(trace)}: measured, predicted before and after, and what remains'
        pictures.append(Picture(light, alt, caption, dark))
    blocks: list[Block] = [Prose(text), Columns(tuple(pictures))]
    if len(shown) < len(traces):
        blocks.append(Details('Every trace in numbers', (_trace_table(traces),)))
    return tuple(blocks)


def _trace_table(traces: Sequence[Trace]) -> Table:
    rows = []
    for trace in traces:
        before, after = (with_unit(x, trace.unit, 3) for x in rmse(trace))
        rows.append((trace.recording, channel_words(trace.channel), before, after))
    return Table(('recording', 'channel', 'RMSE before', 'after'), tuple(rows), wraps=True)


def _closed_loop(diagnosis: Diagnosis, evidence: Evidence, floors: Mapping[str, float]) -> Section:
    text = (
        'The command drives the simulated instrument and its controllers: the gap that a user of '
        'the simulator sees.'
    )
    blocks: list[Block] = [Prose(text)]
    if diagnosis.closed_loop:
        blocks.append(channel_bars(diagnosis.closed_loop, 'Channel by channel, closed loop'))
        blocks.append(Details('The same in numbers', (gap_table(diagnosis.closed_loop),)))
    if evidence.closed_loop:
        text = 'The same command, measured and simulated.'
        blocks += _pictures(evidence.closed_loop, floors, text, _CLOSED)
    return Section('Closed loop', tuple(blocks), 'closed-loop')


def _considered(diagnosis: Diagnosis, evidence: Evidence) -> Section:
    blocks: list[Block] = []
    named = {(cause.effect, cause.place) for cause in diagnosis.causes}
    if evidence.rivals:
        blocks.append(rival_bars(evidence.rivals, named, _MOST_RIVALS))
    hidden = [c for c in diagnosis.candidates if not c.identifiable]
    if hidden:
        said = f'{count(len(hidden), "candidate")} that these data cannot show'
        title = f'{said}: present or not, they leave too little trace.'
        rows = _grouped(hidden, diagnosis.candidates)
        blocks.append(Table(('effect', 'places', 'why not'), rows, title, wraps=True))
    visible = [c for c in diagnosis.candidates if c.identifiable]
    if visible:
        said = f'{count(len(visible), "candidate")} that these data would have shown'
        rows = _by_probability(visible)
        table = Table(('effect', 'places', 'probability'), rows, wraps=True)
        blocks.append(Details(said, (table,)))
    return Section('What was considered', tuple(blocks), 'considered')


def _grouped(
    hidden: Iterable[Judged], candidates: Iterable[Judged]
) -> tuple[tuple[str, str, str], ...]:
    """Return a row for each effect and reason, with all its places; reasons name candidates."""
    called = {
        f'{c.effect} at {c.place}': inside(effect_words(c.effect, c.place)) for c in candidates
    }
    names = sorted(called, key=len, reverse=True)  # pulley_1 begins pulley_12
    places: dict[tuple[str, str], list[str]] = {}
    for judged in hidden:
        why = judged.why_not
        for name in names:
            why = why.replace(name, called[name])
        places.setdefault((judged.effect, why), []).append(judged.place)
    return tuple(
        (find(effect).title, ', '.join(map(place_words, at)), why or 'no reason was given')
        for (effect, why), at in places.items()
    )


def _by_probability(visible: Iterable[Judged]) -> tuple[tuple[str, str, str], ...]:
    """Return a row for each effect and probability, the likeliest first."""
    places: dict[tuple[str, str], list[str]] = {}
    for judged in sorted(visible, key=lambda c: -c.probability):
        places.setdefault((judged.effect, percent(judged.probability)), []).append(judged.place)
    return tuple(
        (find(effect).title, ', '.join(map(place_words, at)), probability)
        for (effect, probability), at in places.items()
    )


def _by_recording(evidence: Evidence) -> Section:
    """Return what each recording alone says of each cause: where it shows, and where it cannot."""
    sizes = list(dict.fromkeys((t.effect, t.place, t.parameter) for t in evidence.told))
    recordings = list(dict.fromkeys(t.recording for t in evidence.told))
    said = {(t.recording, t.effect, t.place, t.parameter): _told(t) for t in evidence.told}
    names = [f'{effect_words(e, p)}: {name}' for e, p, name in sizes]
    cells = [[said.get((r, *size), 'not there') for size in sizes] for r in recordings]
    if len(recordings) > _ABREAST:
        header = ('recording', *names)
        rows = tuple((r, *row) for r, row in zip(recordings, cells, strict=True))
    else:  # what is compared stands side by side
        header = ('size', *recordings)
        across = zip(*cells, strict=True)
        rows = tuple((name, *row) for name, row in zip(names, across, strict=True))
    text = (
        'Each recording on its own, one step from the fit to all of them. Sizes that differ by '
        'more than their intervals say that a law is not quite the machine’s. Where nothing can '
        'be told: the cause leaves no trace there, or tolerances and other causes do the same.'
    )
    table = Table(header, rows, wraps=True)
    return Section('What each recording tells', (Prose(text), table), 'recordings')


def _told(told: Told) -> str:
    """Return a size with its interval, or why there is none."""
    return told.why or sized(told.value, told.ci95, told.unit)


def _basis(evidence: Evidence) -> Section:
    blocks: list[Block] = []
    if evidence.floors:
        rows = tuple(
            (channel_words(f.channel), with_unit(f.value, f.unit), f.how) for f in evidence.floors
        )
        title = 'Noise floors: what no model could do better than.'
        blocks.append(Table(('channel', 'floor', 'how it was found'), rows, title, wraps=True))
    if evidence.moved:
        header = ('number', 'place', 'moved', '95 % interval')
        title = 'Numbers of the instrument file that moved within their tolerances.'
        moved = tuple(_moved(number) for number in evidence.moved)
        blocks.append(Table(header, moved, title, wraps=True))
    return Section('Noise and tolerances', tuple(blocks), 'basis')


def _moved(moved: Moved) -> tuple[str, str, str, str]:
    quantity, by, interval = moved_words(moved)
    return f'{quantity}{known_words(moved)}', place_words(moved.place), by, interval


def _run(diagnosis: Diagnosis, evidence: Evidence) -> Section:
    blocks: list[Block] = [
        Prose(
            f'{count(len(evidence.recordings), "recording")}: {", ".join(evidence.recordings)}. '
            f'Instrument: {evidence.instrument}. Time: {number(evidence.seconds, 2)} s.'
        ),
        Prose(
            'Beside this page: diagnosis.json has the same in numbers; instrument.yaml is the '
            'instrument file with the effects that were found, as simulator, estimator and '
            'diagnosis take it.'
        ),
    ]
    if diagnosis.left_out:
        blocks += [Prose('Of the recordings:'), Listing(diagnosis.left_out)]
    return Section('About this run', tuple(blocks), 'run')


def _scaled(ci95: tuple[float, float], factor: float) -> tuple[float, float]:
    return factor * ci95[0], factor * ci95[1]
