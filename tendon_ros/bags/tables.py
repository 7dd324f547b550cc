"""Read foreign files as tables: one table a run, columns by number or by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.npyio import NpzFile
from numpy.typing import NDArray
import scipy.io

from tendon_ros.bags.mapping import Runs
from tendon_ros.bags.text_columns import read_csv, read_json
from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.recording import FloatArray


@dataclass(frozen=True)
class Table:
    """
    The columns of one run.

    ``columns`` by name, in the order of the file, each shape (n,); ``header`` is the text that the
    file keeps beside the run; ``faults`` says of a column why it cannot be used, ``warnings`` what
    was left out.
    """

    key: str
    columns: Mapping[str, FloatArray]
    header: str = ''
    faults: Mapping[str, str] = field(default_factory=dict)
    warnings: Sequence[str] = ()
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
    found = _whole(path, kind) if kind in ('csv', 'json') else _parts(path, kind, runs)

    def reader(read: Callable[[], Table]) -> Callable[[], Table]:
        def table() -> Table:
            with _explained(path, kind):
                return read()

        return table

    return {key: reader(read) for key, read in found.items()}


def _whole(path: Path, kind: str) -> dict[str, Callable[[], Table]]:
    """Return the one run of a file of text, which is read at once."""
    with _explained(path, kind):
        text = read_csv(path) if kind == 'csv' else read_json(path)
    table = Table(path.stem, text.columns, faults=text.faults, warnings=text.warnings)
    return {path.stem: lambda: table}


def _parts(path: Path, kind: str, runs: Runs | None) -> dict[str, Callable[[], Table]]:
    """Return the runs of a file of arrays."""
    arrays: Mapping[str, Any]
    with _explained(path, kind):
        if kind == 'npz':
            arrays = _Npz(path)
        else:
            found = scipy.io.loadmat(path, squeeze_me=True)
            arrays = {name: value for name, value in found.items() if not name.startswith('__')}
    if runs is None:
        return {path.stem: lambda: _one_run(path, arrays)}
    keys = [
        name
        for name in arrays
        if fnmatchcase(name, runs.include) and not fnmatchcase(name, runs.exclude)
    ]
    if not keys:
        raise RecordingError(
            f'{path}: no run matches runs.include {runs.include!r}; it has {listed(arrays)}'
        )
    return {key: partial(_run, path, arrays, key, runs) for key in keys}


@contextmanager
def _explained(path: Path, kind: str) -> Iterator[None]:
    """Turn what the libraries raise on a damaged file, which is nearly anything, into one line."""
    try:
        yield
    except RecordingError:
        raise
    except PermissionError as error:
        raise RecordingError(f'{path}: may not be read ({error.strerror}); allow it') from error
    except Exception as error:
        detail = ' '.join(str(error).split()).rstrip('.') or type(error).__name__
        raise RecordingError(
            f'{path}: not readable as {kind} ({detail}); check that the file is whole, and the '
            'format in the mapping'
        ) from error


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
            try:
                return arrays[name]
            except ValueError:
                # Python objects would have to be unpickled, which runs whatever the file says.
                return np.empty(0, dtype=np.object_)

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
        if array.ndim == 2 and array.shape[1] == 1:  # a column as MATLAB and pandas write it
            array = array[:, 0]
        if array.ndim == 1 and array.dtype.kind in 'fiub':
            columns[name] = array.astype(np.float64)
    most = max((array.size for array in columns.values()), default=0)
    # Constants and look-up tables live beside the signals: the longest are the signals.
    faults = {
        name: f'{name} has {a.size} numbers, and the longest array {most}'
        for name, a in columns.items()
        if a.size < most
    }
    columns = {name: a for name, a in columns.items() if name not in faults}
    if not columns:
        raise RecordingError(
            f'{path}: no column of numbers among {listed(arrays)}; name the tables under runs'
        )
    return Table(path.stem, columns, faults=faults)


def _run(path: Path, arrays: Mapping[str, Any], key: str, runs: Runs) -> Table:
    """Return a run that is one table of the file."""
    table = _numbers(path, key, arrays[key])
    if table.ndim != 2 or not table.size:
        raise RecordingError(
            f'{path}: {key} has the shape {table.shape}; a run is a table, narrow runs.include'
        )
    name = runs.header.replace('{key}', key)
    text = np.asarray(arrays[name] if name and name in arrays else '')
    header = str(text) if text.size else ''
    return Table(key, {str(i): table[:, i] for i in range(table.shape[1])}, header)
