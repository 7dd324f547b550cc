"""
The unknowns of an effect, chosen so that what it does is nearly linear in them.

An amplitude and its phase, or a stiffness and where it rests, lie along curved valleys of misfit
in which a descent gets stuck. Their products do not: the torques (or radii) in phase and out of
phase, and the torque at angle zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math

from tendon_ros.base.parameter import Parameter
from tendon_ros.identify.axis import Axis, axis_of

#: part of a typical size below which where a spring rests no longer matters
LEAST = 1e-4


class Coordinates:
    """
    Parameters of one effect as places on axes, one for each.

    :param parameters: of the effect; ``search`` tells a ``phase`` or a ``rest`` of the one size.
    """

    def __init__(self, parameters: Sequence[Parameter]) -> None:
        self._parameters = tuple(parameters)
        kinds: list[str] = [p.search for p in parameters]
        self._kind = next((k for k in ('phase', 'rest') if k in kinds), '')
        self.axes: tuple[Axis, ...] = tuple(axis_of(p) for p in parameters)
        if self._kind:
            self._shape = kinds.index(self._kind)
            [self._size] = [n for n, p in enumerate(parameters) if not p.is_shape]
            size = parameters[self._size]
            self._scale = abs(size.typical - size.neutral)
            reach = size.high * (1.0 if self._kind == 'phase' else parameters[self._shape].high)
            across = Axis(f'{size.name}_across', size.unit, -reach, reach, 0.0, self._scale)
            axes = list(self.axes)
            axes[self._shape] = across
            self.axes = tuple(axes)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Which axes are sizes: what the effect does is nearly linear in them."""
        return tuple(
            n
            for n, p in enumerate(self._parameters)
            if not (p.is_shape or p.search == 'share') or self.paired(n)
        )

    def paired(self, n: int) -> bool:
        """
        Return whether a parameter shares its axes with another.

        :param n: which parameter.
        :return: whether.
        """
        return bool(self._kind) and n in (self._size, self._shape)

    def values(self, z: Sequence[float]) -> dict[str, float]:
        """
        Return the parameters, within their bounds.

        :param z: places on the axes.
        :return: values by name, SI units.
        """
        found = {
            p.name: axis.value(place)
            for p, axis, place in zip(self._parameters, self.axes, z, strict=True)
        }
        if self._kind:
            along, across = self._scale * z[self._size], self._scale * z[self._shape]
            pair = _polar(along, across) if self._kind == 'phase' else _rest(along, across)
            for n, value in zip((self._size, self._shape), pair, strict=True):
                p = self._parameters[n]
                found[p.name] = min(max(value, p.low), p.high)
        return found

    def place(self, values: Mapping[str, float]) -> tuple[float, ...]:
        """
        Return the places of parameters on the axes.

        :param values: by name, SI units.
        :return: places.
        """
        found = [
            axis.place(values[p.name]) for p, axis in zip(self._parameters, self.axes, strict=True)
        ]
        if self._kind:
            size = values[self._parameters[self._size].name]
            shape = values[self._parameters[self._shape].name]
            if self._kind == 'phase':
                pair = size * math.cos(shape), size * math.sin(shape)
            else:
                pair = size, size * shape
            found[self._size], found[self._shape] = (part / self._scale for part in pair)
        return tuple(found)


def _polar(along: float, across: float) -> tuple[float, float]:
    """Return amplitude, signed, and phase within a quarter turn."""
    amplitude, phase = math.hypot(along, across), math.atan2(across, along)
    if abs(phase) > 0.5 * math.pi:
        return -amplitude, phase - math.copysign(math.pi, phase)
    return amplitude, phase


def _rest(stiffness: float, torque: float) -> tuple[float, float]:
    """Return stiffness and the angle at which it is relaxed."""
    return stiffness, torque / max(stiffness, LEAST)
