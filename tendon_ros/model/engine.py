"""
Joins the kernel's files and the effects' laws into one file, and runs it compiled or plain.

The file is written once for each network structure and catalogue, under a name that is the hash of
its content, so that a change of any law makes another file and no stale machine code can be
loaded. Where numba is installed the file is compiled and its machine code is kept beside it; where
not, the same file runs as plain Python, slower and to the same numbers within rounding.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
import contextlib
from dataclasses import dataclass
from functools import lru_cache
import hashlib
import importlib.util
import inspect
import os
from pathlib import Path
import sys
import tempfile
import textwrap
from types import ModuleType
from typing import Any

import numpy as np

from tendon_ros import __version__
from tendon_ros.base.effect import Effect
from tendon_ros.base.errors import SimulationError
from tendon_ros.effects import catalogue
from tendon_ros.model.layout import law_numbers
from tendon_ros.model.structure import Structure

#: the kernel's files, in the order in which they are joined; they are read, never imported
PARTS = ('loops', 'forces', 'linear', 'rosenbrock', 'events', 'sensing', 'motion')

#: how a law of each hook is called, and what "no law" returns
CALLS = {
    'torque': ('theta, omega, t', 3),
    'budget': ('speed, side, load', 3),
    'elongation': ('delta, rate, z, t', 7),
    'tension': ('delta, rate, z, t', 8),
    'winding': ('theta', 3),
}

#: how the kernel's annotations are written for the compiler
TYPES = {'Floats': 'float64[::1]', 'Ints': 'int64[::1]', 'float': 'float64', 'int': 'int64'}
_FLOAT = ast.Name('float')

#: rounding may be reordered, but NaN and infinity keep their meaning: a divergence must be seen
OPTIONS = (
    "cache=True, nogil=True, error_model='numpy', fastmath={'reassoc', 'contract', 'arcp', 'nsz'}"
)


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
        flat = np.ascontiguousarray(values)
        if flat.dtype.kind == 'f':
            flat = flat.astype(np.float64)
        else:
            flat = flat.astype(np.int64)
        return flat.copy() if self.compiled else flat.tolist()


@lru_cache(maxsize=32)
def engine_for(structure: Structure, kind: str = 'auto') -> Engine:
    """
    Return the engine of a structure, joined and loaded on first use.

    :param structure: what the kernel is specialised to.
    :param kind: ``compiled``, ``plain``, or ``auto``: compiled where numba is installed.
    :return: the engine.
    :raises SimulationError: where the compiled one is asked for and numba is missing.
    """
    if kind == 'compiled' and not compiler_installed():
        raise SimulationError(
            "engine 'compiled' needs numba, which is not installed: pip install numba, "
            "or use engine 'plain'"
        )
    compiled = kind == 'compiled' or (kind == 'auto' and compiler_installed())
    source = joined_source(structure, compiled=compiled)
    digest = hashlib.sha256(source.encode()).hexdigest()[:20]
    path = _cache_folder() / f'kernel_{digest}.py'
    if not path.exists() or path.read_text(encoding='utf-8') != source:
        _write_atomically(path, source)
    return Engine(module=_load(path), compiled=compiled)


def joined_source(structure: Structure, *, compiled: bool) -> str:
    """
    Return the text of the one file that holds a whole kernel.

    :param structure: what it is specialised to.
    :param compiled: whether its functions are decorated for numba.
    :return: Python source.
    """
    lines = [f'"""tendon_ros {__version__} kernel, written by the engine: not to be edited."""']
    if compiled:
        lines += ['import math', 'import numpy as np', 'from numba import float64, int64, njit']
    else:
        lines += ['import math']
    for name, value in structure.constants.items():
        if isinstance(value, tuple) and compiled:
            lines.append(f'{name} = np.array({list(value)}, dtype=np.int64)')
        else:
            lines.append(f'{name} = {value}')
    for node in _definitions():
        if isinstance(node, ast.FunctionDef):
            lines.append('')
            if compiled:
                lines.append(f'@njit(({_types(node)}), {OPTIONS})')
            _strip(node)
        lines.append(ast.unparse(node))
    return '\n'.join(lines) + '\n'


def _definitions() -> Iterator[ast.stmt]:
    """Yield laws, their dispatchers, then the kernel's own constants and functions."""
    effects = catalogue()
    for hook, numbers in law_numbers().items():
        for name in numbers:
            yield _law(effects[name])
        yield from ast.parse(_dispatcher(hook, [effects[name] for name in numbers])).body
    for part in PARTS:
        text = (Path(__file__).parent / 'kernel' / f'{part}.py').read_text(encoding='utf-8')
        for node in ast.parse(text).body:
            if isinstance(node, (ast.FunctionDef, ast.Assign)):
                yield node


def _law(effect: Effect) -> ast.FunctionDef:
    assert effect.law is not None
    tree = ast.parse(textwrap.dedent(inspect.getsource(effect.law)))
    function = tree.body[0]
    assert isinstance(function, ast.FunctionDef)
    function.name = f'{effect.id}_law'
    return function


def _types(function: ast.FunctionDef) -> str:
    """
    Return the types of a function's arguments as numba writes them.

    With the types given, each function is compiled once, not once more for every literal that it
    is called with; that makes the first start three times faster.
    """
    names = [TYPES[ast.unparse(argument.annotation or _FLOAT)] for argument in function.args.args]
    return ''.join(f'{name}, ' for name in names)


def _strip(function: ast.FunctionDef) -> None:
    """Remove docstring and annotations, which the joined file does without."""
    function.returns = None
    for argument in function.args.args:
        argument.annotation = None
    first = function.body[0]
    if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
        function.body = function.body[1:]


def _dispatcher(hook: str, effects: Sequence[Effect]) -> str:
    arguments, count = CALLS[hook]
    lines = [f'def {hook}_law(law: int, {arguments}, m: Floats, o: int):']
    for number, effect in enumerate(effects):
        given = ''.join(f', m[o + {p}]' for p in range(len(effect.parameters)))
        lines.append(f'    if law == {number}:')
        lines.append(f'        return {effect.id}_law({arguments}{given})')
    lines.append(f'    return ({", ".join(["0.0"] * count)})')
    return '\n'.join(lines)


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


def _load(path: Path) -> ModuleType:
    name = f'tendon_ros_{path.stem}'
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    with contextlib.ExitStack() as undo:
        undo.callback(sys.modules.pop, name, None)
        spec.loader.exec_module(module)
        undo.pop_all()
    return module
