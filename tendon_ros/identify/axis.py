"""How a fit sees a parameter: scaled so that a step of one is a step worth taking."""

from __future__ import annotations

from dataclasses import dataclass
import math

from tendon_ros.base.parameter import Parameter


@dataclass(frozen=True)
class Axis:
    """
    One unknown of a fit.

    ``centre`` is where z = 0, ``scale`` what z = 1 adds, or the logarithm of what it multiplies
    with where ``log``. ``spread`` is the standard deviation of z before any data; infinite where
    nothing is known, and ``likely`` the place around which it is. ``repeated``: that counts as
    often as bins repeat each other.
    """

    name: str
    unit: str
    low: float
    high: float
    centre: float
    scale: float
    log: bool = False
    spread: float = math.inf
    repeated: bool = True
    likely: float = 0.0

    def value(self, z: float) -> float:
        """
        Return the value, within its bounds.

        :param z: place on the axis.
        :return: in the parameter's unit.
        """
        if self.log:
            found = self.centre * math.exp(max(-50.0, min(50.0, self.scale * z)))
        else:
            found = self.centre + self.scale * z
        return min(max(found, self.low), self.high)

    def place(self, value: float) -> float:
        """
        Return the place of a value on the axis.

        :param value: in the parameter's unit.
        :return: z.
        """
        if self.log:
            return math.log(max(value, 1e-300) / self.centre) / self.scale
        return (value - self.centre) / self.scale

    @property
    def ends(self) -> tuple[float, float]:
        """The places of the bounds."""
        low = self.low if not self.log else max(self.low, 1e-12)
        return self.place(low), self.place(self.high)


def axis_of(parameter: Parameter) -> Axis:
    """
    Return the axis of an effect's parameter.

    :param parameter: sizes are seen about their neutral value; positive shapes in decades.
    :return: the axis; of a yes or no a single place.
    """
    p = parameter
    if p.search == 'switch':
        return Axis(p.name, p.unit, p.typical, p.typical, p.neutral, 1.0)
    if p.search == 'instant':
        return Axis(p.name, p.unit, p.low, p.high, 0.0, 0.05)
    if p.search in ('shape', 'level') or (p.shapes_only and p.low > 0.0):
        return Axis(p.name, p.unit, max(p.low, 1e-9), p.high, p.typical, 1.0, log=True)
    if p.shapes_only:
        return Axis(p.name, p.unit, p.low, p.high, p.typical, 0.25 * min(p.high - p.low, 2.0))
    return Axis(p.name, p.unit, p.low, p.high, p.neutral, abs(p.typical - p.neutral))
