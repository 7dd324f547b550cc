"""A physical parameter: name, unit, meaning, bounds, and the value at which it changes nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Parameter:
    """
    One number of an effect, in SI units.

    ``neutral`` changes nothing, or is NaN where the parameter only shapes what others switch
    on; then ``typical`` is what a fit starts from. ``low`` and ``high`` bound what is
    physically possible. ``typical`` is also the size at which the effect is worth looking for,
    of forces in an instrument that takes a newton metre or so. ``search`` says how a fit finds
    its start where a coarse grid would miss it: ``instant`` (a time of the recording),
    ``duration`` (of something that begins at an instant), ``cycles`` (of a turn), ``level``
    (of the motor's torque), ``share`` (all or nothing), ``switch`` (yes or no, which nothing
    fits); what it is to the size beside it: its ``phase``, the angle at which it comes to
    ``rest``; ``slack`` (of a preload: also where it is so small that a cable loosens);
    ``shape``: a shape in spite of its neutral value; or ``guess``: fitted only where
    an instrument file says that it is a guess. ``of_reading``: it is in the unit in which the
    sensor reads at whose place the effect acts; ``unit`` is that of most. ``sensors``: the only
    kinds of sensor at which a fit looks for it, if not all.
    """

    name: str
    unit: str
    meaning: str
    neutral: float
    low: float
    high: float
    typical: float
    search: Literal[
        '',
        'instant',
        'duration',
        'cycles',
        'level',
        'share',
        'switch',
        'phase',
        'rest',
        'slack',
        'shape',
        'guess',
    ] = ''
    of_reading: bool = False
    sensors: tuple[str, ...] = ()

    @property
    def shapes_only(self) -> bool:
        """Whether the parameter has no neutral value of its own."""
        return self.neutral != self.neutral

    @property
    def is_shape(self) -> bool:
        """Whether it shapes an effect rather than sizing it."""
        return self.shapes_only or self.search in ('shape', 'level')
