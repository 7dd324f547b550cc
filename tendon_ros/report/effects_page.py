"""
The catalogue of effects as Markdown: the page ``docs/effects.md`` and its sections.

Everything comes from the effects' files: the text from their docstrings, the tables from what they
declare. So the page cannot say anything else than the code does.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tendon_ros.base.errors import TendonError
from tendon_ros.base.parameter import Parameter
from tendon_ros.effects import catalogue, data_sheet, find

INTRODUCTION = """\
# The catalogue of effects

What a real instrument does and its file does not say: each effect acts at a place of the
instrument and has a few parameters, in SI units. At their neutral values they change nothing; a
parameter without one (–) only gives shape to what the others bring.

Written by `tendon effects --markdown docs/effects.md --overwrite` from the files in
`tendon_ros/effects`. To add an effect, add a file there and write this page again.
"""


class PageError(TendonError):
    """A page that cannot be written where it should be."""


def overview() -> str:
    """
    Return a table of all effects.

    :return: Markdown, one row an effect.
    """
    rows = (
        (f'[`{effect.id}`](#{effect.id})', ', '.join(effect.kinds), _summary(effect.id))
        for effect in catalogue().values()
    )
    return _table(('effect', 'acts at', 'meaning'), rows)


def section(name: str) -> str:
    """
    Return the data sheet of one effect.

    :param name: the effect's id.
    :return: Markdown: what it means, its equation and source, its parameters.
    :raises EffectError: where there is no such effect.
    """
    effect = find(name)
    notes = [f'Acts at: {", ".join(effect.kinds)}.']
    if effect.sensors:
        notes.append(f'Kinds of sensor: {", ".join(effect.sensors)}.')
    if effect.dissipative:
        notes.append('Never gives power.')
    if effect.stateful:
        notes.append('Has a memory: one state.')
    header = ('parameter', 'unit', 'meaning', 'neutral', 'from', 'to', 'typical')
    parts = (
        f'## {effect.id}',
        _markdown(data_sheet(name)),
        ' '.join(notes),
        _table(header, (_row(parameter) for parameter in effect.parameters)),
    )
    return '\n\n'.join(parts)


def page() -> str:
    """
    Return the whole page.

    :return: Markdown, ending in a newline.
    """
    return '\n\n'.join((INTRODUCTION.rstrip(), overview(), *map(section, catalogue()))) + '\n'


def write_page(path: Path) -> None:
    """
    Write the page to a file.

    :param path: the file; its folder must exist.
    :raises PageError: where it cannot be written.
    """
    try:
        path.write_text(page(), encoding='utf-8')
    except OSError as error:
        raise PageError(
            f'{path}: cannot be written ({error.strerror}); name a file in a folder that exists'
        ) from error


def _summary(name: str) -> str:
    """Return what the first line of a data sheet says after the effect's title."""
    return data_sheet(name).partition('\n')[0].partition(': ')[2].rstrip('.')


def _markdown(sheet: str) -> str:
    """Turn the literals of a docstring into those of Markdown; indented blocks are the same."""
    lines = (line.removesuffix(':') if line.endswith('::') else line for line in sheet.split('\n'))
    return '\n'.join(lines).replace('``', '`')


def _row(parameter: Parameter) -> tuple[str, ...]:
    neutral = '–' if parameter.shapes_only else f'{parameter.neutral:g}'
    ends = (parameter.low, parameter.high, parameter.typical)
    return (
        f'`{parameter.name}`',
        parameter.unit,
        parameter.meaning,
        neutral,
        *(f'{value:g}' for value in ends),
    )


def _table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    titles = tuple(header)
    lines = (titles, ('---',) * len(titles), *rows)
    return '\n'.join(f'| {" | ".join(line)} |' for line in lines)
