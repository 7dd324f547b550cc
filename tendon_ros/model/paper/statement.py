"""A number that the paper states, beside the one found here."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
import math


class Use(StrEnum):
    """What the paper's number was used for."""

    INPUT = 'input'
    """Taken over: it describes the rig or the experiment."""
    IDENTIFICATION = 'identification'
    """The cable's curve was fitted to it, so that agreement is no test of the model."""
    CHECK = 'check'
    """Nothing was made from it: it tests the model."""


def about(value: float, tolerance: float) -> tuple[float, float]:
    """
    Return the bounds of a statement that gives a number.

    :param value: the number.
    :param tolerance: what may be between, in its unit.
    :return: least and greatest.
    """
    return value - tolerance, value + tolerance


def at_least(value: float) -> tuple[float, float]:
    """
    Return the bounds of a statement that says more than a number.

    :param value: the least that holds.
    :return: least and greatest.
    """
    return value, math.inf


def at_most(value: float) -> tuple[float, float]:
    """
    Return the bounds of a statement that says less than a number.

    :param value: the greatest that holds.
    :return: least and greatest.
    """
    return -math.inf, value


@dataclass(frozen=True)
class Statement:
    """
    One statement of the paper, held against this model.

    ``said`` is what the paper prints, in parentheses what follows from it without being printed;
    ``found`` is the number here in ``unit``. The statement holds where that is ``within`` bounds.
    ``note`` says how it was measured, or why it does not hold.
    """

    figure: str
    what: str
    said: str
    found: float
    unit: str
    within: tuple[float, float]
    use: Use = Use.CHECK
    note: str = ''

    @property
    def holds(self) -> bool:
        """Whether the number found is within what the statement allows."""
        low, high = self.within
        return low <= self.found <= high

    @property
    def found_text(self) -> str:
        """The number found with its unit, to four digits; what is next to nothing is 0."""
        number = 0.0 if abs(self.found) < 5e-3 and self.unit != 'kg m^2' else self.found
        return f'{number:.4g} {self.unit}'.strip()
