"""The paper reproduced: every experiment run, its figures, the table of numbers, and the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import csv
from io import StringIO
from pathlib import Path

from tendon_ros import __version__
from tendon_ros.model.paper.rig import paper_rig
from tendon_ros.model.paper.statement import Statement, Use
from tendon_ros.model.paper.table_one import table_one
from tendon_ros.report.page import html, markdown, Page, Prose, Section, Table, write
from tendon_ros.report.paper_parts import PARTS

HEADER = ('figure', 'what', 'the paper', 'here', 'used for', 'holds', 'remark')


def reproduce(folder: Path, progress: Callable[[str, float], None]) -> tuple[Statement, ...]:
    """
    Run the paper's experiments and write figures, tables and page.

    :param folder: gets the PNG files, ``table.csv``, ``table.md`` and ``index.html``.
    :param progress: called after each part with its title and the part of all that is done.
    :return: every statement, in the paper's order.
    :raises ReportError: where a file cannot be written.
    """
    rig = paper_rig()
    statements = list(table_one(rig))
    sections = []
    for number, made in enumerate(PARTS, start=1):
        part = made(rig)
        for name, png in part.pictures.items():
            write(folder / name, png)
        sections.append(part.section)
        statements += part.statements
        progress(part.section.title, number / len(PARTS))
    table = statement_table(statements)
    write(folder / 'table.csv', _csv(table))
    write(folder / 'table.md', markdown(table))
    write(folder / 'index.html', html(_page(table, sections)))
    return tuple(statements)


def statement_table(statements: Sequence[Statement]) -> Table:
    """
    Return statements as a table.

    :param statements: what the paper says and what was found.
    :return: a row each, those that do not hold marked.
    """
    return Table(
        HEADER,
        tuple(
            (s.figure, s.what, s.said, s.found_text, s.use, 'ok' if s.holds else 'not', s.note)
            for s in statements
        ),
        marks=tuple('good' if s.holds else 'bad' for s in statements),
        marked=HEADER.index('holds'),
    )


def _page(table: Table, sections: Sequence[Section]) -> Page:
    checks = [row for row in table.rows if row[4] == Use.CHECK]
    held = sum(row[5] == 'ok' for row in checks)
    return Page(
        'The paper, reproduced',
        (
            'The simulations of "Dynamic Modeling of Coupled Tendon-Driven System for Surgical '
            'Robot Instrument", run again on the model of this package, and each number that it '
            'states about its rig beside the one found here.',
            f'{held} of {len(checks)} statements that nothing was made from hold. What does not '
            'is marked, with the reason.',
        ),
        (*sections, Section('Every number', (Prose(_ABOUT_TABLE), table))),
        f'Made by tendon reproduce, tendon_ros {__version__}.',
    )


_ABOUT_TABLE = (
    'Used for: "input" was taken over, "identification" went into the curve of the cable and so '
    'tests nothing, "check" was used for nothing. In parentheses: follows from the paper without '
    'being printed.'
)


def _csv(table: Table) -> str:
    text = StringIO()
    csv.writer(text, lineterminator='\n').writerows((table.header, *table.rows))
    return text.getvalue()
