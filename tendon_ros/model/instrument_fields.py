"""
The fields of an instrument file: how the text in each is read.

Every scalar arrives as text (see :mod:`tendon_ros.model.yaml_text`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
import re
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, ValidationInfo

from tendon_ros.base.quantity import parsed
from tendon_ros.model.tolerance import (
    GUESSED,
    read_stated,
    read_tolerance,
    Stated,
    without_tolerance,
)


@dataclass(frozen=True)
class By:
    """A unit that another field of the section tells, ``key``, which stands before."""

    key: str
    units: Mapping[str, str]

    def told(self, info: ValidationInfo) -> str:
        """
        Return the unit.

        :param info: the fields that were read before.
        :return: any of them where that field is at fault, which has an error of its own.
        """
        return self.units.get(info.data.get(self.key, ''), next(iter(self.units.values())))


def quantity(unit: str | By, sign: str = '') -> BeforeValidator:
    """
    Return a validator that reads a quantity.

    :param unit: its SI unit.
    :param sign: ``positive``, ``not negative``, ``not zero`` or nothing.
    :return: the validator.
    """

    def read(text: object, info: ValidationInfo) -> float:
        own = unit.told(info) if isinstance(unit, By) else unit
        if isinstance(text, str) and (number := without_tolerance(text)) != text:
            raise ValueError(f'{text!r}: no tolerance may stand here; write {number!r}')
        value = text if isinstance(text, float) else parsed(text, own)
        _check_sign(text, value, sign)
        return value

    return BeforeValidator(read)


def stated(unit: str | By, sign: str = '') -> PlainValidator:
    """
    Return a validator that reads a quantity which may carry a tolerance.

    :param unit: its SI unit.
    :param sign: as for :func:`quantity`.
    :return: the validator.
    """

    def read(text: object, info: ValidationInfo) -> Stated:
        known = read_stated(text, unit.told(info) if isinstance(unit, By) else unit)
        _check_sign(text, known.value, sign)
        return known

    return PlainValidator(read)


def _check_sign(text: object, value: float, sign: str) -> None:
    holds = {'positive': value > 0, 'not negative': value >= 0, 'not zero': value != 0}
    if not holds.get(sign, True):
        raise ValueError(f'{text!r} must be {sign}')


def _read_name(text: str) -> str:
    if not re.fullmatch('[A-Za-z0-9_]+', text):
        raise ValueError(f'{text!r} is no name; use letters (a-z), digits and underscores')
    return text


def _read_zero(text: str) -> str:
    if text not in ('', GUESSED):
        raise ValueError(
            f'{text!r}: write {GUESSED!r} where it is another one in every recording, and leave '
            'it out where it is known; what homing leaves is found as the effect encoder_offset'
        )
    return text


def _read_count(text: object) -> int:
    number = str(text)
    if not number.isdecimal() or int(number) < 1:
        raise ValueError(f'{text!r} is not a whole number of at least 1; write one such as 28000')
    return int(number)


def column(unit: str) -> BeforeValidator:
    """
    Return a validator that reads ``{mm: [0, 0.1, ...]}`` as numbers.

    :param unit: the SI unit to read them in.
    :return: the validator.
    """

    def read(value: object) -> tuple[float, ...]:
        mend = f'write a unit and its numbers, such as {{{_COLUMN_UNITS[unit]}: [0, 0.5, 1]}}'
        if not isinstance(value, dict) or len(value) != 1:
            raise ValueError(f'is not one unit with a list; {mend}')
        [(own, numbers)] = value.items()
        if not isinstance(numbers, list):
            raise ValueError(f'{own} holds no list; {mend}')
        return tuple(parsed(f'{number} {own}', unit) for number in numbers)

    return BeforeValidator(read)


_COLUMN_UNITS = {'m': 'mm', 'N': 'N'}

Name = Annotated[str, AfterValidator(_read_name)]
Zero = Annotated[str, AfterValidator(_read_zero)]
Count = Annotated[int, BeforeValidator(_read_count)]
Switch = Annotated[bool, Field(strict=False)]
Radius = Annotated[float, quantity('m', 'not zero')]
Ratio = Annotated[float, quantity('1', 'not zero')]
Sign = Literal['1', '-1', '+1']
Inertia = Annotated[Stated, stated('kg*m^2', 'positive')]
Damping = Annotated[Stated, stated('N*m*s/rad', 'not negative')]
#: a factor on numbers that stand elsewhere, of which only the tolerance can be given
Factor = Annotated[Stated, PlainValidator(lambda text: Stated(1.0, read_tolerance(text)))]
