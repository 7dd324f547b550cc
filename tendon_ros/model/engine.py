"""
Joins the kernel's files and the effects' laws into one file, and runs it compiled or plain.

The file is written once for each network structure and catalogue, under a name that is the hash of
its content, so that a change of any law makes another file and no stale machine code can be
loaded. Where numba is installed the file is compiled and its machine code is kept beside it; where
not, the same file runs as plain Python, slower and to the same numbers within rounding.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
import fcntl
from functools import lru_cache
import hashlib
import importlib.util
import os
from pathlib import Path
import subprocess
import sys
import tempfile
from threading import Lock
from types import ModuleType
from typing import Any

import numpy as np

from tendon_ros import __version__
from tendon_ros.base.errors import listed, SimulationError
from tendon_ros.model import loading
from tendon_ros.model.joining import decorated_source, joined_source
from tendon_ros.model.loading import imported
from tendon_ros.model.structure import Structure

#: what an engine may be asked for
KINDS = ('auto', 'compiled', 'plain')


def compiler_installed() -> bool:
    """Return whether numba can be imported."""
    return importlib.util.find_spec('numba') is not None


@dataclass(frozen=True)
class Engine:
    """
    A kernel ready to run for one structure.

    ``array`` turns numpy arrays into what the kernel works on: themselves where it is compiled,
    lists of Python numbers where it is plain (ten times faster there than numpy scalars).
    """

    module: ModuleType
    compiled: bool

    @property
    def name(self) -> str:
        """``compiled`` or ``plain``."""
        return 'compiled' if self.compiled else 'plain'

    def array(self, values: Any) -> Any:
        """Return an array of floats or of ints in the form that the kernel works on."""
        given = np.asarray(values)
        kind = np.float64 if given.dtype.kind == 'f' else np.int64
        own = np.array(given, dtype=kind, order='C')
        return own if self.compiled else own.tolist()

    def zeros(self, count: int) -> Any:
        """Return so many zeros in the form that the kernel works on."""
        return np.zeros(count) if self.compiled else [0.0] * count


@lru_cache(maxsize=32)
def engine_for(structure: Structure, kind: str = 'auto') -> Engine:
    """
    Return the engine of a structure, joined and loaded on first use.

    :param structure: what the kernel is specialised to.
    :param kind: ``compiled``, ``plain``, or ``auto``: compiled where numba is installed.
    :return: the engine.
    :raises SimulationError: where the compiled one is asked for and numba is missing.
    """
    compiled = _is_compiled(kind)
    return Engine(_stored(joined_source(structure, compiled=compiled), ahead=compiled), compiled)


@lru_cache(maxsize=8)
def engine_of(files: tuple[Path, ...], kind: str = 'auto') -> Engine:
    """
    Return the functions of some files, compiled where that is possible.

    The files stand alone together: constants, and functions over floats and arrays that need
    nothing but ``math`` and numpy. They are compiled when they are first called; the machine code
    is kept under the hash of the text.

    :param files: of Python functions, in the order in which they are joined; read, not imported.
    :param kind: as for :func:`engine_for`.
    :return: the engine; its ``module`` has all functions.
    :raises SimulationError: where the compiled one is asked for and numba is missing.
    """
    compiled = _is_compiled(kind)
    return Engine(_stored(decorated_source(files, compiled=compiled), ahead=False), compiled)


def _is_compiled(kind: str) -> bool:
    """Return whether an engine of this kind is compiled here."""
    if kind not in KINDS:
        raise SimulationError(f'engine: {kind!r}; give {listed(KINDS)}')
    if kind == 'compiled' and not compiler_installed():
        raise SimulationError(
            "engine 'compiled' needs numba, which is not installed: pip install numba, "
            "or use engine 'plain'"
        )
    return kind == 'compiled' or (kind == 'auto' and compiler_installed())


def _stored(source: str, *, ahead: bool) -> ModuleType:
    """Return the module of a source text, which is kept under its hash."""
    title = f'"""tendon_ros {__version__} kernel, written by the engine: not to be edited."""'
    source = f'{title}\n{source}'
    digest = hashlib.sha256(source.encode()).hexdigest()[:20]
    path = _cache_folder() / f'kernel_{digest}.py'
    if not path.exists() or path.read_text(encoding='utf-8') != source:
        _write_atomically(path, source)
    return _load(path, ahead=ahead)


def _cache_folder() -> Path:
    """Return a folder for kernels that can be written to."""
    root = os.environ.get('XDG_CACHE_HOME') or str(Path.home() / '.cache')
    folder = Path(root) / 'tendon_ros'
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    folder = Path(tempfile.gettempdir()) / f'tendon_ros_{os.getuid()}'
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return folder


def _write_atomically(path: Path, text: str) -> None:
    """Write so that another process sees either no file or the whole one."""
    handle, name = tempfile.mkstemp(dir=path.parent, suffix='.tmp')
    with os.fdopen(handle, 'w', encoding='utf-8') as file:
        file.write(text)
    Path(name).replace(path)


#: two threads that ask for a new kernel must not be given one that is half loaded
_LOADING = Lock()


def _load(path: Path, *, ahead: bool) -> ModuleType:
    """
    Import a file; ``ahead``: what is compiled when it is imported, is compiled before that.

    All processes but one wait for that: nodes that start together would each compile the same
    kernel, half a minute of a core.
    """
    with _LOADING, path.open('rb') as file:
        if ahead and not _machine_code(path):
            with contextlib.suppress(OSError):  # not every file system has locks
                fcntl.flock(file, fcntl.LOCK_EX)
            if not _machine_code(path):
                _compile(path)
        return imported(path)


def _machine_code(path: Path) -> bool:
    """Return whether machine code of a file is kept beside it."""
    return any((path.parent / '__pycache__').glob(f'{path.stem}.*.nbi'))


def _compile(path: Path) -> None:
    """
    Let another process compile a file, see :mod:`tendon_ros.model.loading`.

    Where that fails the file is compiled by who imports it, and says what is wrong.
    """
    command = [sys.executable, '-P', loading.__file__, str(path)]
    with contextlib.suppress(OSError):
        subprocess.run(command, capture_output=True, check=False)
