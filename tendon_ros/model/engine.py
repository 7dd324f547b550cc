"""
Joins the kernel's files and the effects' laws into one file, and runs it compiled or plain.

The file is written once for each network structure and catalogue, under a name that is the hash of
its content, so that a change of any law makes another file and no stale machine code can be
loaded. Where numba is installed the file is compiled and its machine code is kept beside it; where
not, the same file runs as plain Python, slower and to the same numbers within rounding.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
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

#: how the kernel's annotations are written for the compiler: inside, arrays are bare pointers,
#: which halves the time of the whole; at the entries they are arrays
TYPES = {'Floats': 'FLOATS', 'Ints': 'INTS', 'float': 'float64', 'int': 'int64'}
ENTRY_TYPES = {**TYPES, 'Floats': 'float64[::1]', 'Ints': 'int64[::1]'}

#: functions that are called from outside
ENTRIES = ('rollout', 'glide', 'weigh')

#: small functions and laws become part of their callers
INSIDE_CALLERS = frozenset(
    [
        'clipped',
        'smooth',
        'cable',
        'wind',
        'pull',
        'touch',
        'rub',
        'drive',
        'still',
        'load',
        'due',
        'prescribe',
        'longest',
    ]
)

#: the beginning of a compiled kernel
COMPILER = """
import numpy as np
from numba import float64, int64, njit, types
from numba.extending import intrinsic

FLOATS = types.CPointer(float64)
INTS = types.CPointer(int64)

def first_of(pointer):
    @intrinsic
    def first(typing, array):
        def generate(context, builder, signature, arguments):
            whole = context.make_array(signature.args[0])(context, builder, arguments[0])
            return whole.data
        return pointer(array), generate
    return first

floats = first_of(FLOATS)
ints = first_of(INTS)
"""
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
    lines += ['import math', COMPILER if compiled else '']
    for name, value in structure.constants.items():
        if isinstance(value, tuple) and compiled:
            lines.append(f'{name} = np.array({list(value)}, dtype=np.int64)')
        else:
            lines.append(f'{name} = {value}')
    entries = []
    for node in _definitions():
        if not isinstance(node, ast.FunctionDef):
            lines.append(ast.unparse(node))
            continue
        lines.append('')
        if compiled:
            if node.name in ENTRIES:
                entries.append(_entry(node))
                node.name += '_inside'
            inline = node.name in INSIDE_CALLERS or node.name.endswith('_law')
            more = ', forceinline=True' if inline else ''
            options = f'no_cpython_wrapper=True{more}, {OPTIONS}'
            lines.append(f'@njit(({_types(node, TYPES)}), {options})')
        _strip(node)
        lines.append(ast.unparse(node))
    return '\n'.join(lines + entries) + '\n'


def _entry(function: ast.FunctionDef) -> str:
    """Return a function that takes arrays and hands their first elements to the one inside."""
    names = [argument.arg for argument in function.args.args]
    hand = {'Floats': 'floats({})', 'Ints': 'ints({})'}
    handed = [
        hand.get(ast.unparse(argument.annotation or _FLOAT), '{}').format(argument.arg)
        for argument in function.args.args
    ]
    return (
        f'\n@njit(({_types(function, ENTRY_TYPES)}), {OPTIONS})\n'
        f'def {function.name}({", ".join(names)}):\n'
        f'    return {function.name}_inside({", ".join(handed)})'
    )


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


def _types(function: ast.FunctionDef, types: Mapping[str, str]) -> str:
    """
    Return the types of a function's arguments as numba writes them.

    With the types given, each function is compiled once, not once more for every literal that it
    is called with; that makes the first start three times faster.
    """
    names = [types[ast.unparse(argument.annotation or _FLOAT)] for argument in function.args.args]
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
