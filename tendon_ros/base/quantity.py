"""
Quantities: text with a unit, such as ``30 mm``, to and from SI numbers.

A number is converted as a decimal, so ``0.7 mm`` is exactly the float ``0.0007`` and what
:func:`written` writes is read back as the same float.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal
from functools import cache
import math
import re
import tokenize
from types import MappingProxyType
from typing import Any

#: a value worth showing in an error message, by SI unit
EXAMPLES: Mapping[str, str] = MappingProxyType(
    {
        'kg*m^2': '2.25e-4 kg*m^2',
        'N*m*s/rad': '0.9 N*m*s/rad',
        'N*m*s': '0.9 N*m*s/rad',
        'N*m/rad': '20 N*m/rad',
        'N*m/(rad*s)': '150 N*m/(rad*s)',
        'N*m': '0.5 N*m',
        'N*s/m': '10 N*s/m',
        'N/m': '200 N/mm',
        'N': '5 N',
        'm': '30 mm',
        'rad': '17 deg',
        'rad/s': '2 rad/s',
        's': '2 ms',
        's/m': '10 s/m',
        'Hz': '1 kHz',
        '1': '0.12',
    }
)

#: units that read better than the SI unit, best first
_READABLE: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {'m': ('mm',), 'rad': ('deg',), 's': ('ms',), 'N/m': ('N/mm',), 'Hz': ('kHz',)}
)

_QUANTITY = re.compile(r'([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)', re.DOTALL)
_NOT_FINITE = re.compile(r'[+-]?\.?(nan|inf|infinity)\b', re.IGNORECASE)


def parsed(text: object, unit: str) -> float:
    """
    Return a quantity in SI units.

    :param text: a number and its unit, such as ``30 mm``; a bare number only where ``unit`` is 1.
    :param unit: the SI unit asked for, such as ``N m s/rad``; ``1`` for a plain number.
    :return: the value, finite.
    :raises ValueError: on anything else; the message says what to write.
    """
    unit = _normal(unit)
    mend = f'write {_article(unit)} such as {EXAMPLES.get(unit, f"1 {unit}")!r}'
    written_text = str(text).strip()
    match = _QUANTITY.fullmatch(written_text)
    if match is None:
        fault = 'not finite' if _NOT_FINITE.match(written_text) else 'not a number with a unit'
        raise ValueError(f'{_quoted(text)} is {fault}; {mend}')
    number, own = match.groups()
    if not own and unit != '1':
        raise ValueError(f'{written_text!r} has no unit; {mend}')
    try:
        one = _factor(own, unit)
    except ValueError as error:
        raise ValueError(f'{written_text!r} {error}; {mend}') from None
    try:
        value = float(Decimal(number) * one)
    except ArithmeticError:
        value = math.inf
    if not math.isfinite(value):
        raise ValueError(f'{written_text!r} is too large; {mend}')
    return value


def factor(text: str, unit: str) -> float:
    """
    Return what one of a unit is in SI units, where the unit may have numbers in it.

    :param text: such as ``turn / 4096``, ``3.98e-5 N m`` or ``mA * 0.08 N m/A``.
    :param unit: the SI unit asked for.
    :return: the factor, finite and not 0.
    :raises ValueError: on anything else; angles follow the rule of :func:`parsed`.
    """
    unit = _normal(unit)
    try:
        value = float(_converted(_reduced_expression(text), unit))
    except ValueError as error:
        raise ValueError(f'{text!r} {error}') from None
    if not 0.0 < abs(value) < math.inf:
        raise ValueError(f'{text!r} is {value:g} {unit}; give what one step of the number is')
    return value


def written(value: float, unit: str) -> str:
    """
    Return a readable text that :func:`parsed` reads as exactly this value.

    :param value: in SI units, finite.
    :param unit: its SI unit; ``1`` for a plain number.
    :return: the shortest of the texts in the usual units.
    """
    unit = _normal(unit)
    if unit == '1':
        return repr(float(value))
    texts = [
        f'{value / float(_factor(own, unit)):.12g} {own}'
        for own in (*_READABLE.get(unit, ()), unit)
    ]
    exact = [text for text in texts if parsed(text, unit) == value]
    return min(exact, key=len, default=f'{float(value)!r} {unit}')


def readable_unit(values: tuple[float, ...], unit: str) -> str:
    """
    Return the unit in which a column of values reads best and still exactly.

    :param values: in SI units.
    :param unit: their SI unit.
    :return: the unit to write them in.
    """
    for own in _READABLE.get(unit, ()):
        if all(parsed(column_text(v, own, unit) + ' ' + own, unit) == v for v in values):
            return own
    return unit


def column_text(value: float, own: str, unit: str) -> str:
    """
    Return one number of a column.

    :param value: in the SI unit.
    :param own: the unit to write it in.
    :param unit: the SI unit.
    :return: the number alone.
    """
    return repr(float(value)) if own == unit else f'{value / float(_factor(own, unit)):.12g}'


def _normal(unit: str) -> str:
    """Return a unit as this module writes it: ``N m`` becomes ``N*m``, none becomes ``1``."""
    return unit.strip().replace(' ', '*').replace('**', '^') or '1'


def _article(unit: str) -> str:
    return 'a plain number' if unit == '1' else 'a quantity'


def _quoted(text: object) -> str:
    return repr(text) if isinstance(text, str) else f'{type(text).__name__} {text!r}'


@cache
def _registry() -> Any:
    """Return pint's registry, made when the first unit is read: it takes a third of a second."""
    import pint

    return pint.UnitRegistry()


#: factor to base units, dimensions without the angle, and the power of the radian
_Reduced = tuple[float, Mapping[str, int | float], float]


@cache
def _reduced(unit: str) -> _Reduced:
    """Return a unit without numbers in it, reduced."""
    if unit in {'', '1'}:
        return 1.0, {}, 0.0
    registry = _registry()
    with _explained(unit):
        return _split(*registry.get_base_units(registry.parse_units(_known_to_pint(unit))))


@cache
def _reduced_expression(text: str) -> _Reduced:
    """Return a unit that may have numbers in it, reduced."""
    registry = _registry()
    with _explained(text):
        one = registry.Quantity(1.0, 'dimensionless') * registry.parse_expression(
            _known_to_pint(text)
        )
        base = one.to_base_units()
        return _split(base.magnitude, base.units)


def _known_to_pint(unit: str) -> str:
    return unit.replace('·', '*').replace('%', 'percent')


def _split(factor: float, base: Any) -> _Reduced:
    """Return a factor and a base unit with the radian apart."""
    powers = dict(base._units)
    radian = float(powers.pop('radian', 0))
    powers = {u: p for u, p in powers.items() if _registry().get_dimensionality(u)}  # no counts
    return float(factor), powers, radian


@contextmanager
def _explained(unit: str) -> Iterator[None]:
    """Turn all that pint raises on what is no unit into one sentence."""
    import pint

    try:
        yield
    except (
        pint.PintError,
        ArithmeticError,
        AssertionError,
        AttributeError,
        SyntaxError,
        tokenize.TokenError,
        TypeError,
        ValueError,
    ):
        raise ValueError(f'has a unit that does not exist, {unit!r}') from None


@cache
def _factor(own: str, unit: str) -> Decimal:
    """Return what a number in one unit is multiplied by to be in the other, which is SI."""
    return _converted(_reduced(own), unit)


def _converted(reduced: _Reduced, unit: str) -> Decimal:
    """Return what one of a reduced unit is in another, which is SI."""
    one, powers, radian = reduced
    _, wanted, wanted_radian = _reduced(unit)
    # An angle is a ratio: N*m*s is as good as N*m*s/rad. But 5 is no angle, and rad/s no rate.
    same = radian == wanted_radian or (radian == 0 and wanted != {} and unit != 'rad/s')
    if powers != wanted or not same:
        hint = _hint(powers, wanted, radian, unit)
        raise ValueError(f'is not in {unit}{hint}' if unit != '1' else 'is not a plain number')
    # Powers of ten come out of pint with rounding errors in the last bit.
    short = float(f'{one:.12g}')
    return Decimal(repr(short if abs(short - one) <= 4e-16 * abs(one) else one))


def _hint(
    powers: Mapping[str, int | float], wanted: Mapping[str, int | float], radian: float, unit: str
) -> str:
    """Return what may be wrong with a unit, in parentheses; empty where nobody knows."""
    if powers == wanted:
        return ' (its angle has no place there)' if radian else ' (it names no angle)'
    turning = 'rad' in unit or unit in {'N*m', 'kg*m^2'}
    if turning and powers and {**powers, 'meter': 0} == {**wanted, 'meter': 0}:
        return ' (on a straight axis, let 1 rad stand for 1 m)'
    return ''
