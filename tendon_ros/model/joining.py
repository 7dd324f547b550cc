"""
Joins the kernel's files and the laws of the effects into the text of one file.

The files are read, never imported: their names are bound only in the joined text, which begins
with the constants of one network structure.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
import inspect
from pathlib import Path
import textwrap

from tendon_ros.base.effect import Effect
from tendon_ros.effects import catalogue
from tendon_ros.model.layout import law_numbers
from tendon_ros.model.structure import Structure

#: the kernel's files, in the order in which they are joined; they are read, never imported
PARTS = ('loops', 'forces', 'linear', 'rosenbrock', 'events', 'sensing', 'motion')

#: how a law of each hook is called, and what "no law" returns
CALLS = {
    'torque': ('theta, omega, t', 3),
    'budget': ('speed, side, load', 3),
    'elongation': ('delta, t', 2),
    'relaxation': ('delta, z', 7),
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
        'both',
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


def joined_source(structure: Structure, *, compiled: bool) -> str:
    """
    Return the text of the one file that holds a whole kernel.

    :param structure: what it is specialised to.
    :param compiled: whether its functions are decorated for numba.
    :return: Python source.
    """
    lines = ['import math', COMPILER if compiled else '']
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


def decorated_source(files: Sequence[Path], *, compiled: bool) -> str:
    """
    Return the text of files that stand alone together, their functions decorated for numba.

    :param files: in the order in which they are joined; what they import from each other is left
        out.
    :param compiled: whether functions are decorated.
    :return: Python source.
    """
    lines = ['from numba import njit'] if compiled else []
    for file in files:
        for node in ast.parse(file.read_text(encoding='utf-8')).body:
            if isinstance(node, ast.Expr):
                continue
            if isinstance(node, ast.ImportFrom) and (node.module or '').startswith('tendon_ros'):
                continue
            if isinstance(node, ast.FunctionDef):
                if compiled:
                    lines.append("@njit(cache=True, nogil=True, error_model='numpy')")
                _strip(node)
            lines.append(ast.unparse(node))
    return '\n'.join(lines) + '\n'


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
