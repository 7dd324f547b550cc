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
            # from there on both parts count: what changes nothing may have a size
            whole = {p.name: p.typical if p.shapes_only else p.neutral for p in parameters}
            self._origin = self._parts(whole) if size.neutral != 0.0 else (0.0, 0.0)
            axes = list(self.axes)
            axes[self._shape] = across
            self.axes = tuple(axes)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Which axes are sizes: what the effect does is nearly linear in them."""
        return tuple(
            n
            for n, p in enumerate(self._parameters)
            if not (p.is_shape or p.search in ('share', 'switch')) or self.paired(n)
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
            convert = _polar if self._kind == 'phase' else _rest
            pair = convert(*self._reached(*self._pair(z)))
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
            found[self._size], found[self._shape] = self._places(*self._parts(values))
        return tuple(found)

    def within(self, z: Sequence[float]) -> tuple[float, ...]:
        """
        Return the places of what places stand for.

        A spring that rests too far is a stiffer one, and an amplitude has an end in whatever
        phase: beyond, a derivative would tell nothing of the way back.

        :param z: places on the axes.
        :return: places.
        """
        if not self._kind:
            return tuple(z)
        pair = self._pair(z)
        reached = self._reached(*pair)
        if reached == pair:
            return tuple(z)
        found = list(z)
        found[self._size], found[self._shape] = self._places(*reached)
        return tuple(found)

    def _reached(self, along: float, across: float) -> tuple[float, float]:
        """
        Return the nearest parts that parameters can make.

        An amplitude keeps its part in phase, which small angles tell, a spring its torque: a
        descent that has come there still sees both.
        """
        if self._kind == 'rest':
            return max(along, abs(across) / self._parameters[self._shape].high), across
        end = self._parameters[self._size].high
        if math.hypot(along, across) <= end:
            return along, across
        along = min(max(along, -end), end)
        return along, math.copysign(math.sqrt(end**2 - along**2), across)

    def _pair(self, z: Sequence[float]) -> tuple[float, float]:
        """Return what places make along and across."""
        along, across = self._origin
        return along + self._scale * z[self._size], across + self._scale * z[self._shape]

    def _places(self, along: float, across: float) -> tuple[float, float]:
        """Return the places of what is along and across."""
        return (along - self._origin[0]) / self._scale, (across - self._origin[1]) / self._scale

    def _parts(self, values: Mapping[str, float]) -> tuple[float, float]:
        """Return what a size and its phase, or its rest, make along and across."""
        size = values[self._parameters[self._size].name]
        shape = values[self._parameters[self._shape].name]
        if self._kind == 'phase':
            return size * math.cos(shape), size * math.sin(shape)
        return size, size * shape


def _polar(along: float, across: float) -> tuple[float, float]:
    """Return amplitude, signed, and phase within a quarter turn."""
    amplitude, phase = math.hypot(along, across), math.atan2(across, along)
    if abs(phase) > 0.5 * math.pi:
        return -amplitude, phase - math.copysign(math.pi, phase)
    return amplitude, phase


def _rest(stiffness: float, torque: float) -> tuple[float, float]:
    """Return stiffness and the angle at which it is relaxed."""
    return stiffness, torque / stiffness if stiffness > 0.0 else 0.0
