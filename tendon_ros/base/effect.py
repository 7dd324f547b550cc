"""
The effect contract: what a file in ``tendon_ros.effects`` declares to be in the catalogue.

An effect either *modifies* numbers of the model, or adds a *law*, or both. A law is a function of
scalars that returns its value and its partial derivatives, written with what the compiler of the
kernel understands: arithmetic, ``abs``, ``min``, ``max``, ``if``, ``math``. The hooks:

``torque(theta, omega, t, *parameters) -> (torque, by_theta, by_omega)``
    a torque on a pulley [N m].
``budget(speed, side, load, *parameters) -> (limit, by_speed, by_load)``
    adds to the largest dry friction of a pulley [N m]; ``speed`` >= 0 [rad/s], ``side`` -1 or 1,
    ``load`` = sum of |radius| * (both tensions) over the loops on the pulley [N m].
``elongation(delta, t, *parameters) -> (shift, by_delta)``
    adds to a loop's elongation [m].
``relaxation(delta, z, *parameters)
-> (settled, by_z, fraction, share, z_rate, by_delta, by_z)``
    takes a fraction of what a loop bears at the elongation ``settled`` [m], which follows the
    present one; z is an auxiliary state of order one. Of the fraction a ``share`` is taken from
    the tension and the rest from the elongation: with T the net force, T(delta) becomes
    share * (T(delta) - fraction * T(settled)) + (1 - share) * T(delta - fraction * settled).
``tension(delta, rate, z, t, *parameters)
-> (force, by_delta, by_rate, by_z, z_rate, by_delta, by_rate, by_z)``
    adds to a loop's net force [N]; with the same kind of state.
``winding(theta, *parameters) -> (arc, by_theta, by_theta_twice)``
    adds to the angle that the cables see [rad].

Laws depend on ``t`` only through switches, whose times ``switches`` declares.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.parameter import Parameter

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: kinds of sensors, by what they read, in the order of the numbers by which the kernel knows them
SENSED = (
    'angle',
    'velocity',
    'motor_torque',
    'contact_force',
    'contact_torque',
    'loop_torque',
)
HOOKS = ('torque', 'budget', 'elongation', 'relaxation', 'tension', 'winding')


class Numbers(Protocol):
    """
    The numbers of a model that an effect may modify, by name, as arrays over their places.

    ``model[name]`` is the array, for instance ``model['inertia']`` over pulleys.
    """

    kind: str
    """The kind of place that is being modified."""

    def __getitem__(self, name: str) -> Any:
        """Return the array of that name, to be changed in place."""

    def loops_on(self, pulley: int) -> Sequence[int]:
        """Return the loops and couplings that touch a pulley."""


@dataclass(frozen=True)
class Effect:
    """
    One unmodelled physical effect.

    ``kinds``: the kinds of place where it can act (``pulley``, ``cable``, ``coupling``, ``motor``,
    ``sensor``, ``contact``). ``modify(numbers, index, **parameters)`` changes numbers there.
    ``law`` is the function for ``hook``; its parameters are all of ``parameters`` in order.
    ``stateful``: the law has an auxiliary state. ``dissipative``: it never gives power.
    ``form``: how far the law may be from that of a machine which does have the effect, as a part
    of what the effect does: geometry and scales are exact, friction is not, creep least of all.
    ``by_others``: what it does grows with what other effects do to its place: a late sensor shows
    where what it reads jumps.
    ``other(**parameters)``: the name and parameters of a simpler effect that these make it, if
    any. ``holds``: simpler effects that are part of this one, each with the parameters of this
    one that grow by all of the simpler one's only parameter when both are at one place.
    ``alike(**parameters)``: sizes of effects that together do the same, by name.
    """

    id: str
    title: str
    kinds: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    hook: str = ''
    law: Callable[..., tuple[float, ...]] | None = None
    stateful: bool = False
    form: float = 0.01
    by_others: bool = False
    other: Callable[..., tuple[str, dict[str, float]] | None] | None = None
    holds: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    alike: Callable[..., Mapping[str, float]] | None = None
    modify: Callable[..., None] | None = None
    switches: Callable[..., tuple[float, ...]] | None = None
    dissipative: bool = False
    sensors: tuple[str, ...] = ()  # kinds of sensor, where the place is a sensor

    @property
    def dry(self) -> bool:
        """Whether it is a dry friction, by whatever law."""
        return self.hook == 'budget'

    @cached_property
    def parts(self) -> frozenset[str]:
        """Effects that together do the same; none for most."""
        return frozenset(self.alike(**self.typical)) if self.alike else frozenset()

    @cached_property
    def neutral(self) -> Mapping[str, float]:
        """Parameters with which the effect changes nothing."""
        return {p.name: p.typical if p.shapes_only else p.neutral for p in self.parameters}

    @cached_property
    def left_out(self) -> Mapping[str, float]:
        """Parameters where a file gives none: neutral ones, and angles of zero."""
        angles = {p.name: 0.0 for p in self.parameters if p.search in ('phase', 'rest')}
        return {**self.neutral, **angles}

    @cached_property
    def typical(self) -> Mapping[str, float]:
        """Parameters of a size that is worth looking for."""
        return {p.name: p.typical for p in self.parameters}
