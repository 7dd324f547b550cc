"""A physical parameter: name, unit, meaning, bounds, and the value at which it changes nothing."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Parameter:
    """
    One number of an effect, in SI units.

    ``neutral`` changes nothing, or is NaN where the parameter only shapes what others switch on;
    then ``typical`` is what a fit starts from. ``low`` and ``high`` bound what is physically
    possible. ``typical`` is also the size at which the effect is worth looking for.
    """

    name: str
    unit: str
    meaning: str
    neutral: float
    low: float
    high: float
    typical: float

    @property
    def shapes_only(self) -> bool:
        """Whether the parameter has no neutral value of its own."""
        return self.neutral != self.neutral
