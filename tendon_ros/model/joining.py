"""
Joins the kernel's files and the laws of the effects into the text of one file.

The files are read, never imported: their names are bound only in the joined text, which begins
with the constants of one network structure.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
import inspect
from pathlib import Path
import textwrap

from tendon_ros.base.effect import Effect
from tendon_ros.effects import catalogue
from tendon_ros.model.laws import law_numbers
from tendon_ros.model.structure import Structure

#: the kernel's files, in the order in which they are joined; they are read, never imported
PARTS = ('loops', 'bristles', 'forces', 'linear', 'rosenbrock', 'events', 'sensing', 'motion')

#: how a law of each hook is called, and what "no law" returns
CALLS = {
    'torque': ('theta, omega, t', 3),
    'budget': ('speed, side, load', 3),
    'elongation': ('delta, t', 2),
    'relaxation': ('delta, z', 7),
    'tension': ('delta, rate, z, t', 8),
    'winding': ('theta', 3),
}

#: how the annotations of entries are written for the compiler; inside, arrays are bare pointers,
#: which halves the time of the whole
TYPES = {'Floats': 'float64[::1]', 'Ints': 'int64[::1]', 'float': 'float64', 'int': 'int64'}

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
OPTIONS = "nogil=True, error_model='numpy', fastmath={'reassoc', 'contract', 'arcp', 'nsz'}"


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
    definitions = list(_definitions())
    exact = _Exact(definitions)
    for node in definitions:
        if not isinstance(node, ast.FunctionDef):
            lines.append(ast.unparse(node))
            continue
        if compiled:
            exact.visit(node)
        if compiled and node.name in ENTRIES:
            entries.append(node)
            continue
        lines.append('')
        if compiled:
            inline = node.name in INSIDE_CALLERS or node.name.endswith('_law')
            more = ', forceinline=True' if inline else ''
            lines.append(f'@njit(no_cpython_wrapper=True, no_cfunc_wrapper=True{more}, {OPTIONS})')
        _strip(node)
        lines.append(ast.unparse(node))
    return '\n'.join(lines) + (_entered(entries) if entries else '') + '\n'


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


def _entered(entries: Sequence[ast.FunctionDef]) -> str:
    """
    Return a compiled function with the bodies of all entries, and one by each one's name.

    A function is optimised with all that it calls, so that one function takes much less time to
    compile than one for each entry. Arrays come in; inside they are bare pointers.
    """
    kinds = {
        argument.arg: ast.unparse(argument.annotation or _FLOAT)
        for entry in entries
        for argument in entry.args.args
    }
    hand = {'Floats': 'floats', 'Ints': 'ints'}
    taken = [f'{name}_array' if kind in hand else name for name, kind in kinds.items()]
    types = ', '.join(TYPES[kind] for kind in kinds.values())
    lines = [f'\n\n@njit((int64, {types}), cache=True, {OPTIONS})']
    lines += [f'def entered(entry, {", ".join(taken)}):']
    lines += [f'    {n} = {hand[kind]}({n}_array)' for n, kind in kinds.items() if kind in hand]
    wrappers = []
    for number, entry in enumerate(entries):
        own = [argument.arg for argument in entry.args.args]
        _strip(entry)
        body = '\n'.join(ast.unparse(statement) for statement in entry.body)
        lines += [f'    if entry == {number}:', textwrap.indent(body, 8 * ' ')]
        # what an entry does not take, it gets any of the same kind
        spare = {kind: next((n for n in own if kinds[n] == kind), '0') for kind in TYPES}
        given = [name if name in own else spare[kind] for name, kind in kinds.items()]
        wrappers += [
            f'\ndef {entry.name}({", ".join(own)}):',
            f'    return entered({number}, {", ".join(given)})',
        ]
    return '\n'.join([*lines, '    return 0', *wrappers])


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


class _Exact(ast.NodeTransformer):
    """
    Hands whole numbers to the functions of a kernel as what they are, not as literals.

    A function is compiled once then, not once more for every literal that it is called with; and
    only where the machine code of the whole is not known yet.

    :param definitions: of the kernel.
    """

    def __init__(self, definitions: Sequence[ast.stmt]) -> None:
        self._whole = {
            node.name: [
                n
                for n, argument in enumerate(node.args.args)
                if ast.unparse(argument.annotation or _FLOAT) == 'int'
            ]
            for node in definitions
            if isinstance(node, ast.FunctionDef)
        }

    def visit_Call(self, node: ast.Call) -> ast.Call:
        """Return a call whose whole numbers are no literals."""
        self.generic_visit(node)
        if isinstance(node.func, ast.Name):
            for n in self._whole.get(node.func.id, ()):
                node.args[n] = ast.Call(ast.Name('int64'), [node.args[n]], [])
        return node


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
