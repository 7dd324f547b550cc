"""The scoreboard of the blind benchmark: page, tables and numbers."""

from __future__ import annotations

from dataclasses import asdict
import json
import math
from pathlib import Path
from typing import Any

from tendon_ros import __version__
from tendon_ros.blind.judge import FOREIGN, KNOWN
from tendon_ros.blind.score import EVERY, Row, Score
from tendon_ros.blind.statistics import error_by_chance, Fraction
from tendon_ros.report.blind_figures import calibration_figure, confusion_figure, shrink_figure
from tendon_ros.report.page import html, markdown, Page, Picture, Prose, Section, Table, write

_NONE = '–'
_MOST_MISSES = 200


def write_scoreboard(score: Score, folder: Path) -> None:
    """
    Write ``scoreboard.html``, ``scoreboard.md``, ``score.json`` and the figures.

    :param score: the score.
    :param folder: where to.
    :raises ReportError: where a file cannot be written.
    """
    pictures = {
        'confusion': confusion_figure(score.confusion),
        'calibration': calibration_figure(score.bins, score.calibration_error),
        'shrink': shrink_figure(score),
    }
    for name, png in pictures.items():
        write(folder / f'{name}.png', png)
    write(folder / 'scoreboard.html', html(_page(score, pictures)))
    write(folder / 'scoreboard.md', score_markdown(score))
    write(folder / 'score.json', json.dumps(_numbers(score), indent=1) + '\n')


def score_markdown(score: Score) -> str:
    """
    Return the tables of a score.

    :param score: the score.
    :return: Markdown.
    """
    parts = [f'{sentence}\n' for sentence in summary(score)]
    parts += [markdown(table) for table in (known_table(score), foreign_table(score))]
    return '\n'.join(parts)


def summary(score: Score) -> tuple[str, ...]:
    """
    Return what was scored and the numbers that are not by stratum.

    :param score: the score.
    :return: sentences.
    """
    about = score.about
    cases = len(score.judgements)
    idle = Fraction(sum(value < 1.1 for value in score.idle), len(score.idle))
    refused = sum(bool(j.refused) for j in score.judgements)
    lines = [
        f'{cases} cases of seed {about["seed"]} ({about["kind"]}), rig {about["bench"]}, '
        f"nuisance {100 * about['nuisance']:g} %. Intervals are Wilson's, 95 %.",
        f'Expected calibration error {_number(score.calibration_error, 3)} over '
        f'{sum(b.true.of for b in score.bins)} stated probabilities '
        f'({_number(error_by_chance(score.bins), 3)} on average, were each of so few right); '
        f'of {idle.of} wrong causes {idle} shrink the gap by less than 1.1.',
    ]
    if refused or score.missing:
        lines.append(f'{refused} cases were refused, {score.missing} have no result yet.')
    return tuple(lines)


def known_table(score: Score) -> Table:
    """
    Return the strata whose causes are in the catalogue, and the one without any.

    :param score: the score.
    :return: a row for each stratum and channel set.
    """
    header = (
        'stratum', 'channels', 'cases', 'verdict right', 'all right', 'said uncertain',
        'effects found', 'named are true', 'false alarm', 'set size', 'after / floor',
        'interval holds', 'median error', 'seconds',
    )  # fmt: skip
    rows = tuple(
        (
            *_head(row), str(row.verdict), str(row.right), str(row.uncertain), str(row.found),
            str(row.true), str(row.alarmed), _number(row.set_size, 2), _number(row.left, 2),
            str(row.inside), _percent(row.error), _number(row.seconds, 1),
        )
        for row in score.rows
        if row.stratum in {'none', *KNOWN}
    )  # fmt: skip
    return Table(header, rows)


def foreign_table(score: Score) -> Table:
    """
    Return the strata whose causes the catalogue does not have.

    :param score: the score.
    :return: a row for each stratum and channel set.
    """
    header = (
        'stratum', 'channels', 'cases', 'not explained', 'and no wrong cause', 'a wrong cause',
        'place first', 'place among three', 'seconds',
    )  # fmt: skip
    rows = tuple(
        (
            *_head(row), str(row.verdict), str(row.right), str(row.alarmed), str(row.place),
            str(row.place_near), _number(row.seconds, 1),
        )
        for row in score.rows
        if row.stratum in FOREIGN
    )  # fmt: skip
    return Table(header, rows)


def _head(row: Row) -> tuple[str, str, str]:
    name = row.stratum.replace('_', ' or ')
    return (name if row.channels == EVERY else '', row.channels, str(row.cases))


def _number(value: float, digits: int) -> str:
    return _NONE if math.isnan(value) else f'{value:.{digits}f}'


def _percent(value: float) -> str:
    return _NONE if math.isnan(value) else f'{100 * value:.1f} %'


def _page(score: Score, pictures: dict[str, bytes]) -> Page:
    misses = tuple(
        (
            j.case, j.stratum, j.channels, j.verdict,
            ', '.join(f'{a} → {b}' for a, b in j.pairs if a != b) or j.refused or 'verdict only',
        )
        for j in score.misses[:_MOST_MISSES]
    )  # fmt: skip
    return Page(
        'The blind benchmark',
        summary(score),
        (
            Section(
                'Causes that the catalogue has',
                (
                    known_table(score),
                    Prose(
                        'A cause is named from a probability of 0.5 on. It is true where effect '
                        'and place are those of the label, or where the label stands in the set '
                        'that it says it cannot be told from; set size counts both.'
                    ),
                ),
            ),
            Section(
                'Causes that it does not have',
                (foreign_table(score), Prose('Every cause named here is wrong.')),
            ),
            Section(
                'What was taken for what',
                (
                    Picture(
                        pictures['confusion'],
                        'matrix of true effects against named ones',
                        '"elsewhere" is the right effect at a wrong place.',
                    ),
                ),
            ),
            Section(
                'Probabilities',
                (Picture(pictures['calibration'], 'stated against true probabilities'),),
            ),
            Section(
                'What is left of the gap',
                (Picture(pictures['shrink'], 'distribution of the rest of the gap'),),
            ),
            Section(
                'Cases that are not right',
                (Table(('case', 'stratum', 'channels', 'verdict', 'true → named'), misses),),
            ),
        ),
        f'Made by tendon blind score, tendon_ros {__version__}.',
    )


def _numbers(score: Score) -> dict[str, Any]:
    """Return the score for programs: fractions with counts and intervals, NaN as null."""

    def plain(value: Any) -> Any:
        if isinstance(value, Fraction):
            return {'count': value.count, 'of': value.of, 'ci95': list(value.interval)}
        return None if isinstance(value, float) and math.isnan(value) else value

    return {
        'about': score.about,
        'rows': [{key: plain(value) for key, value in vars(row).items()} for row in score.rows],
        'calibration_error': plain(score.calibration_error),
        'calibration_error_by_chance': plain(error_by_chance(score.bins)),
        'bins': [{'stated': b.stated, 'true': plain(b.true)} for b in score.bins],
        'confusion': [list(entry) for entry in score.confusion],
        'wrong_causes_shrink': list(score.idle),
        'missing': score.missing,
        'cases': [
            {key: plain(value) for key, value in asdict(j).items()} for j in score.judgements
        ],
    }
