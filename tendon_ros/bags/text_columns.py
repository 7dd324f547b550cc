"""Files of text as columns of numbers by name: CSV and JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
import csv
from dataclasses import dataclass
import json
from pathlib import Path
from typing import Any

import numpy as np

from tendon_ros.base.recording import FloatArray

#: what may stand between the cells of a CSV file; commas, which are decimal signs too, last
DELIMITERS = ';\t,'
#: rows that tell what it is
LOOKED_AT = 20
#: characters of a line that a message shows
SHOWN = 40


@dataclass(frozen=True)
class TextColumns:
    """
    The columns of a file of text.

    ``columns`` by name, each shape (n,); ``faults`` says of those that hold more than numbers what
    is wrong with them; ``warnings`` what was left out.
    """

    columns: dict[str, FloatArray]
    faults: dict[str, str]
    warnings: tuple[str, ...] = ()


def read_csv(path: Path) -> TextColumns:
    """
    Return the columns of a CSV file.

    They are named by the first line where a cell of it is anything but empty or a number. Between
    semicolons or tabs, a comma is taken for the decimal sign. The last row of a logger that was
    stopped may be cut off, and is left out then.

    :param path: the file.
    :return: the columns.
    :raises ValueError: where it holds no table; the libraries raise others.
    """
    with path.open(newline='', encoding='utf-8-sig') as stream:
        every = [line for line in stream if line.strip()]
    lines = [line for line in every if not line.startswith('#')]
    if not lines:
        raise ValueError('it is empty')
    delimiter = _delimiter(lines[:LOOKED_AT])
    rows = list(csv.reader(lines, delimiter=delimiter, skipinitialspace=True))
    comma = '' if delimiter == ',' else ','
    try:
        [_number(cell, comma) for cell in rows[0] if cell.strip()]
        names, first = [str(i) for i in range(len(rows[0]))], 0
    except ValueError:
        names, first = [cell.strip() for cell in rows[0]], 1
    if first and len(rows) > 2 and len(rows[1]) == len(rows[2]) != len(names):
        raise ValueError(
            f'its first line names {len(names)} columns ({lines[0].strip()[:SHOWN]}), the next '
            f'has {len(rows[1])} cells; delete what stands above the names of the columns'
        )
    doubled = [name for name, count in Counter(names).items() if count > 1]
    if doubled:
        at = ' and '.join(str(i + 1) for i, name in enumerate(names) if name == doubled[0])
        raise ValueError(
            f'columns {at} are both called {doubled[0]!r} in its first line; rename one of them'
        )
    warnings: tuple[str, ...] = ()
    if not first and every[0].startswith('#'):
        warnings = (
            f'no names of columns, they go by number from 0; {every[0].strip()[:SHOWN]!r} was '
            'taken for a comment',
        )
    if len(rows) > first + 1 and len(rows[-1]) < len(names) and not lines[-1].endswith('\n'):
        warnings += (
            f'the last row, {len(rows)}, is cut off after {len(rows[-1])} of {len(names)} cells; '
            'left out',
        )
        del rows[-1]
    table = np.full((len(rows) - first, len(names)), np.nan)
    faults: dict[str, str] = {}
    for i, row in enumerate(rows[first:]):
        if len(row) != len(names):
            raise ValueError(f'row {i + first + 1} has {len(row)} cells for {len(names)} columns')
        for j, cell in enumerate(row):
            if cell.strip():
                try:
                    table[i, j] = _number(cell, comma)
                except ValueError:
                    fault = f'row {i + first + 1}, column {names[j]}: {cell!r} is not a number'
                    faults.setdefault(names[j], fault)
    return TextColumns({name: table[:, j] for j, name in enumerate(names)}, faults, warnings)


def _delimiter(lines: Sequence[str]) -> str:
    """Return what stands between the cells: what makes rows of one length, longer than one."""
    present = [d for d in DELIMITERS if d in lines[0]]
    for delimiter in present:
        rows = csv.reader(lines, delimiter=delimiter, skipinitialspace=True)
        lengths = {len(row) for row in rows}
        if len(lengths) == 1 and lengths != {1}:
            return delimiter
    return present[0] if present else ','


def read_json(path: Path) -> TextColumns:
    """
    Return the columns of a JSON file.

    The samples are the longest list of objects in the file, or the longest lists of numbers in it.
    A sample that lacks a column, or has null in it, was not taken there.

    :param path: the file.
    :return: the columns.
    :raises ValueError: where it holds no samples; the libraries raise others.
    """
    document = json.loads(path.read_text(encoding='utf-8-sig'))
    parts = list(document.values()) if isinstance(document, dict) else [document]
    lists = [part for part in parts if isinstance(part, list) and part]
    samples = [part for part in lists if all(isinstance(sample, dict) for sample in part)]
    cells: dict[str, list[Any]]
    if samples:
        longest = max(samples, key=len)
        names = dict.fromkeys(name for sample in longest for name in sample)
        cells = {name: [sample.get(name) for sample in longest] for name in names}
    elif isinstance(document, dict) and lists:
        length = max(map(len, lists))
        cells = {
            str(name): part
            for name, part in document.items()
            if isinstance(part, list) and len(part) == length
        }
    else:
        raise ValueError('it holds no list of samples')
    columns: dict[str, FloatArray] = {}
    faults: dict[str, str] = {}
    for name, column in cells.items():
        columns[name] = np.full(len(column), np.nan)
        for i, cell in enumerate(column):
            if isinstance(cell, int | float):
                try:
                    columns[name][i] = cell
                except OverflowError:
                    faults.setdefault(name, f'sample {i}, {name}: too large a number')
            elif cell is not None:
                faults.setdefault(name, f'sample {i}, {name}: {str(cell)[:40]!r} is not a number')
    return TextColumns(columns, faults)


def _number(cell: str, comma: str) -> float:
    return float(cell.replace(comma, '.') if comma else cell)
