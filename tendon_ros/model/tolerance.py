"""
How well a number is known: ``0.04 kg*m^2 +- 3 %``, ``5 N ± 0.5 N``, ``0.9 N*m*s/rad guessed``.

A tolerance is one standard deviation. It is kept relative to the number, but in its own unit for
an angle, whose zero is a matter of choice; infinite for what was only guessed. Whoever fits reads
it as: what was guessed may move, what was measured may not.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from difflib import get_close_matches
import math
import re

from tendon_ros.base.quantity import parsed, written

GUESSED = 'guessed'
#: how alike a word is that was meant for it
ALIKE = 0.75
_SIGN = re.compile(r'\+/?-|±')


@dataclass(frozen=True)
class Stated:
    """A number in SI units and, where the file says so, its tolerance."""

    value: float
    tolerance: float | None = None


def read_stated(text: object, unit: str) -> Stated:
    """
    Return a quantity and what is said of how well it is known.

    :param text: a quantity, perhaps followed by ``guessed`` or by ``+-`` and a tolerance.
    :param unit: the SI unit asked for.
    :return: number and tolerance.
    :raises ValueError: on anything else; the message says what to write.
    """
    if not isinstance(text, str):
        return Stated(parsed(text, unit))
    if text.strip() == GUESSED:
        own = '' if unit == '1' else f', in {unit}'
        raise ValueError(f'{text!r}: write the number that is {GUESSED} before it{own}')
    number, spread = _parts(text)
    *_, last = number.split() or ['']
    if spread is not None and last == GUESSED:
        raise ValueError(f'{text!r}: what is {GUESSED} has no tolerance; write one or the other')
    if last != GUESSED and get_close_matches(last, [GUESSED], cutoff=ALIKE):
        raise ValueError(f'{text!r}: did you mean {GUESSED!r}?')
    value = parsed(number, unit)
    if spread is None:
        return Stated(value)
    return Stated(
        value, math.inf if spread == GUESSED else _read_spread(text, spread, value, unit)
    )


def without_tolerance(text: str) -> str:
    """
    Return the number of a text alone.

    :param text: as for :func:`read_stated`.
    :return: what stands before the tolerance; the text itself where there is none.
    """
    number, _ = _parts(text)
    return number


def read_tolerance(text: object) -> float:
    """
    Return a relative tolerance that stands alone, of a number that is written elsewhere.

    :param text: ``guessed``, or ``+- 3 %``.
    :return: the tolerance.
    :raises ValueError: on anything else; the message says what to write.
    """
    said = str(text).strip()
    if said == GUESSED:
        return math.inf
    sign = _SIGN.match(said)
    if sign is None or not said.endswith('%'):
        raise ValueError(
            f"{said!r} is no tolerance; write '+- 3 %' or '{GUESSED}', for the number itself "
            "stands elsewhere (a loop's stiffness is the scale of its curve)"
        )
    return _positive(said, parsed(said[sign.end() :].strip(), '1'))


def written_stated(value: float, unit: str, tolerance: float | None) -> str:
    """
    Return a text that :func:`read_stated` reads as exactly this.

    :param value: in SI units.
    :param unit: its SI unit.
    :param tolerance: as in :class:`Stated`.
    :return: the text.
    """
    text = written(value, unit)
    if tolerance is None:
        return text
    if unit == 'rad' and math.isfinite(tolerance):
        return f'{text} ± {written(tolerance, unit)}'
    return f'{text} {written_tolerance(tolerance)}'


def written_tolerance(tolerance: float) -> str:
    """
    Return a text that :func:`read_tolerance` reads as exactly this.

    :param tolerance: relative.
    :return: the text.
    """
    if math.isinf(tolerance):
        return GUESSED
    return f'± {(Decimal(repr(float(tolerance))) * 100).normalize():f} %'


def _parts(text: str) -> tuple[str, str | None]:
    """Return a number and what is said of it: ``guessed``, what follows the sign, or None."""
    if text.rstrip().endswith(f' {GUESSED}'):
        return text.rstrip().removesuffix(GUESSED).rstrip(), GUESSED
    number, *rest = _SIGN.split(text, maxsplit=1)
    return (number.rstrip(), rest[0].strip()) if rest and number.strip() else (text, None)


def _read_spread(text: str, spread: str, value: float, unit: str) -> float:
    """Return the tolerance behind the sign: a share of the number, or in its unit."""
    if unit == 'rad':
        if spread.endswith('%'):
            raise ValueError(f"{text!r}: a share of an angle means nothing; write '+- 0.5 deg'")
        return _positive(text, parsed(spread, unit))
    if value == 0.0:
        raise ValueError(
            f"{text!r}: 0 has no relative tolerance; leave it out, or write '{GUESSED}'"
        )
    if spread.endswith('%'):
        return _positive(text, parsed(spread, '1'))
    try:
        return _positive(text, parsed(spread, unit) / abs(value))
    except ValueError as error:
        raise ValueError(f"{error}, or a share such as '3 %'") from None


def _positive(text: str, tolerance: float) -> float:
    if tolerance <= 0.0:
        raise ValueError(f'{text!r}: a tolerance must be positive; write, say, 0.1 %')
    return tolerance
