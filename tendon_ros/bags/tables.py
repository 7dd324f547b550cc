"""Read foreign files as tables: one table a run, columns by number or by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
import csv
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
import json
from pathlib import Path
from typing import Any
import zipfile

import numpy as np
from numpy.lib.npyio import NpzFile
from numpy.typing import NDArray
import scipy.io

from tendon_ros.bags.mapping import Runs
from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.recording import FloatArray


@dataclass(frozen=True)
class Table:
    """
    The columns of one run.

    ``columns`` by name, in the order of the file, each shape (n,); ``header`` is the text that the
    file keeps beside the run; ``faults`` says of a column why it cannot be used.
    """

    key: str
    columns: Mapping[str, FloatArray]
    header: str = ''
    faults: Mapping[str, str] = field(default_factory=dict)
    names: Sequence[str] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'names', tuple(self.columns))

    def column(self, which: int | str, place: str) -> FloatArray:
        """
        Return a column.

        :param which: its number from 0, or its name.
        :param place: what asks for it, for the message.
        :return: shape (n,).
        :raises RecordingError: where there is none.
        """
        name = which
        if isinstance(which, int) and which < len(self.names):
            name = self.names[which]
        if isinstance(name, str) and name in self.faults:
            raise RecordingError(f'{place}: {self.faults[name]}; mend it or map another column')
        if isinstance(name, str) and name in self.columns:
            return self.columns[name]
        have = f'0 to {len(self.names) - 1}' if isinstance(which, int) else listed(self.names)
        raise RecordingError(f'{place}: no column {which!r} in run {self.key}; it has {have}')


def read_tables(path: Path, kind: str, runs: Runs | None) -> dict[str, Callable[[], Table]]:
    """
    Find the runs of a file; each is unpacked only when it is asked for.

    :param path: the foreign file.
    :param kind: ``npz``, ``csv``, ``mat`` or ``json``.
    :param runs: which arrays are runs; None where the whole file is one.
    :return: key → a function that reads the run.
    :raises RecordingError: where the file cannot be read, or holds no run.
    """
    if not path.is_file():
        raise RecordingError(f'{path}: no such file; give the file to import')
    try:
        arrays: Mapping[str, Any]
        if kind == 'csv':
            columns, faults = _read_csv(path)
            return {path.stem: lambda: Table(path.stem, columns, faults=faults)}
        if kind == 'json':
            columns, faults = _read_json(path)
            return {path.stem: lambda: Table(path.stem, columns, faults=faults)}
        if kind == 'npz':
            arrays = _Npz(path)
        else:
            found = scipy.io.loadmat(path, squeeze_me=True)
            arrays = {name: value for name, value in found.items() if not name.startswith('__')}
        names = list(arrays)
    except (OSError, ValueError, TypeError, NotImplementedError, zipfile.BadZipFile) as error:
        detail = ' '.join(str(error).split())
        raise RecordingError(
            f'{path}: not readable as {kind} ({detail}); check the format in the mapping'
        ) from error
    if runs is None:
        return {path.stem: lambda: _one_run(path, arrays)}
    keys = [
        name
        for name in names
        if fnmatchcase(name, runs.include) and not fnmatchcase(name, runs.exclude)
    ]
    if not keys:
        raise RecordingError(
            f'{path}: no run matches runs.include {runs.include!r}; it has {listed(names)}'
        )

    def reader(key: str) -> Callable[[], Table]:
        return lambda: _run(path, arrays, key, runs)

    return {key: reader(key) for key in keys}


class _Npz(Mapping[str, Any]):
    """The arrays of an npz file, each read when it is asked for; no file stays open."""

    def __init__(self, path: Path) -> None:
        self._path = path
        with self._open() as arrays:
            self._names = tuple(arrays.files)

    def _open(self) -> NpzFile:
        arrays = np.load(self._path, allow_pickle=False)
        if not isinstance(arrays, NpzFile):
            raise ValueError('it holds a single array')
        return arrays

    def __getitem__(self, name: str) -> Any:
        with self._open() as arrays:
            return arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def _numbers(path: Path, name: str, value: Any) -> FloatArray:
    array: NDArray[Any] = np.asarray(value)
    if array.dtype.kind not in 'fiub':
        raise RecordingError(f'{path}: {name} holds {array.dtype}, not numbers; map another one')
    return array.astype(np.float64)


def _one_run(path: Path, arrays: Mapping[str, Any]) -> Table:
    """Return a file in which each array is a column; what is not a column is left aside."""
    columns = {}
    for name in arrays:
        array = np.asarray(arrays[name])
        if array.ndim == 1 and array.dtype.kind in 'fiub':
            columns[name] = array.astype(np.float64)
    lengths = {array.size for array in columns.values()}
    if len(lengths) > 1:
        # Constants and look-up tables live beside the signals: the longest are the signals.
        columns = {name: a for name, a in columns.items() if a.size == max(lengths)}
    if not columns:
        raise RecordingError(
            f'{path}: no column of numbers among {listed(arrays)}; name the tables under runs'
        )
    return Table(path.stem, columns)


def _run(path: Path, arrays: Mapping[str, Any], key: str, runs: Runs) -> Table:
    """Return a run that is one table of the file."""
    table = _numbers(path, key, arrays[key])
    if table.ndim != 2 or not table.size:
        raise RecordingError(
            f'{path}: {key} has the shape {table.shape}; a run is a table, narrow runs.include'
        )
    name = runs.header.replace('{key}', key)
    header = str(np.asarray(arrays[name])) if name and name in arrays else ''
    return Table(key, {str(i): table[:, i] for i in range(table.shape[1])}, header)


#: what may stand between the cells of a CSV file; commas, which are decimal signs too, last
DELIMITERS = ';\t,'
#: rows that tell what it is
LOOKED_AT = 20


def _read_csv(path: Path) -> tuple[dict[str, FloatArray], dict[str, str]]:
    """
    Return the columns of a CSV file, and what is wrong with those that hold more than numbers.

    They are named by the first line where a cell of it is anything but empty or a number. Between
    semicolons or tabs, a comma is taken for the decimal sign.
    """
    with path.open(newline='', encoding='utf-8-sig') as stream:
        lines = [line for line in stream if line.strip() and not line.startswith('#')]
    if not lines:
        raise ValueError('it is empty')
    delimiter = _delimiter(lines[:LOOKED_AT])
    rows = list(csv.reader(lines, delimiter=delimiter))
    comma = '' if delimiter == ',' else ','
    try:
        [_number(cell, comma) for cell in rows[0] if cell.strip()]
        names, first = [str(i) for i in range(len(rows[0]))], 0
    except ValueError:
        names, first = [cell.strip() for cell in rows[0]], 1
    if len(set(names)) < len(names):
        raise ValueError('two columns have the same name')
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
    return {name: table[:, j] for j, name in enumerate(names)}, faults


def _delimiter(lines: Sequence[str]) -> str:
    """Return what stands between the cells: what makes rows of one length, longer than one."""
    present = [d for d in DELIMITERS if d in lines[0]]
    for delimiter in present:
        lengths = {len(row) for row in csv.reader(lines, delimiter=delimiter)}
        if len(lengths) == 1 and lengths != {1}:
            return delimiter
    return present[0] if present else ','


def _read_json(path: Path) -> tuple[dict[str, FloatArray], dict[str, str]]:
    """
    Return the columns of a JSON file, and what is wrong with those that hold more than numbers.

    The samples are the longest list of objects in the file, or the longest lists of numbers in it.
    A sample that lacks a column, or has null in it, was not taken there.
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
                columns[name][i] = cell
            elif cell is not None:
                faults.setdefault(name, f'sample {i}, {name}: {cell!r} is not a number')
    return columns, faults


def _number(cell: str, comma: str) -> float:
    return float(cell.replace(comma, '.') if comma else cell)
