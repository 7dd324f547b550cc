"""
Tolerances: how far the numbers of an instrument file may be off without being a cause.

Every number that was measured is a little wrong. A diagnosis that did not let them move would
explain a percent of stiffness with friction. What the file calls guessed is found with everything
else, and never a cause.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
import math

from tendon_ros.base.parameter import Parameter
from tendon_ros.effects import find
from tendon_ros.identify.axis import Axis
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.effect_use import units_at, whole
from tendon_ros.model.instrument import (
    Contact,
    contact_place,
    DAMPING_UNITS,
    EffectUse,
    Instrument,
)

# what a careful nameplate, scale or spring balance leaves open, relative, one deviation
MEASURED = 0.02
DAMPING = 0.06  # dampings are never known as well
REACH = 3.0  # deviations; what lies beyond is a cause
#: angle [rad] or share that a shape guessed to be zero may become, one deviation
SOME_SHAPE = 0.5
#: damping that a guess of zero may become, one deviation [N m s/rad]
SOME_DAMPING = 0.01
#: [s] by which the damping of a cable, a coupling or a contact delays its force, if a guess of
#: zero is one deviation off
YIELDING = 1e-3
SOME_LOSS = 1.0  # the same of a contact whose force is a factor on its spring's [s/m]


@dataclass(frozen=True)
class Tolerance:
    """
    One number of the file that may move: the effect that moves it, and how far it may.

    ``given``: the file has this effect there already, and its parameter moves. ``supposed``: the
    file does not say how well it knows the number; what it calls guessed it does say.
    """

    effect: str
    place: str
    quantity: str
    parameter: str
    axis: Axis
    given: bool = False
    supposed: bool = False

    @property
    def guessed(self) -> bool:
        """Whether the file only guesses the number, so that it may end anywhere."""
        return self.axis.spread != 1.0

    def use(self, z: float) -> EffectUse:
        """
        Return the effect that moves the number.

        :param z: its place on the axis.
        :return: the effect in use.
        """
        value = {self.parameter: self.axis.value(z)}
        return EffectUse(self.effect, self.place, value, instead=self.given)

    def is_moved_by(self, cause: Candidate) -> bool:
        """
        Return whether a cause, where there is one, moves this very number.

        :param cause: the cause.
        :return: whether.
        """
        # what happens once more is not what the file says happened
        again = self.given and bool(cause.instants)
        return (cause.effect, cause.place) == (self.effect, self.place) and any(
            p.name == self.parameter and not again for p in cause.parameters
        )


def tolerances(instrument: Instrument, looser: float = 1.0) -> tuple[Tolerance, ...]:
    """
    Return what may move in an instrument.

    :param instrument: the network.
    :param looser: times what is usual that numbers are off of which the file says nothing.
    :return: its inertias, dampings, preloads and stiffnesses, with the tolerance of the file or,
        where it names none, that of a careful measurement; torque constants, contact positions
        and parameters of the file's effects where it gives a tolerance; dampings of contacts also
        where it says nothing of them.
    """
    stated = instrument.tolerances
    own = {(use.effect, use.place): whole(use).parameters for use in instrument.effects}
    found = list(_of_effects(instrument))
    taken = {(t.effect, t.place, t.parameter) for t in found}

    def movable(effect: str, place: str, quantity: str, axis: Axis | None) -> None:
        supposed = f'{place}.{quantity}' not in stated
        parameter = _moving(effect, quantity)
        if axis is None or (effect, place, parameter.name) in taken:
            return
        given = own.get((effect, place))
        if given is not None:
            axis = _about(axis, given[parameter.name], parameter.neutral == 1.0)
        # beyond what the effect can be, nothing can be computed
        within = _within(axis, parameter)
        found.append(
            Tolerance(effect, place, quantity, parameter.name, within, given is not None, supposed)
        )

    for effect, place, quantity, usual in _factors(instrument):
        axis = _factor(
            quantity, stated.get(f'{place}.{quantity}', looser * usual), _moving(effect, quantity)
        )
        movable(effect, place, quantity, axis)
    for pulley in instrument.pulleys:
        place = f'pulley_{pulley.name}'
        spread = stated.get(f'{place}.damping', looser * DAMPING)
        unit, least = 'N m s/rad', -pulley.damping  # less would drive
        axis = _addition('damping', unit, pulley.damping, spread, SOME_DAMPING, least)
        movable('viscous_friction', place, 'damping', axis)
    for place, unit, nominal, stiffness in _damped(instrument):
        spread = stated.get(f'{place}.damping', 0.0)
        axis = _addition('damping', unit, nominal, spread, YIELDING * stiffness, -nominal)
        movable('cable_stiffness', place, 'damping', axis)
    for contact in instrument.contacts:
        place = contact_place(instrument, contact)
        spread = stated.get(f'{place}.position', 0.0)
        axis = _addition('position', 'rad', 1.0, spread, 0.05)
        movable('contact_position', place, 'position', axis)
        axis = _yielding(contact, stated.get(f'{place}.damping'))
        movable('contact_stiffness', place, 'damping', axis)
    return tuple(found)


def _factors(instrument: Instrument) -> Iterator[tuple[str, str, str, float]]:
    """Yield effect, place, quantity and usual tolerance of all numbers that an effect scales."""
    for pulley in instrument.pulleys:
        yield 'inertia', f'pulley_{pulley.name}', 'inertia', MEASURED
    for loop in instrument.loops:
        if loop.pretension > 0.0:
            yield 'pretension', f'cable_{loop.name}', 'pretension', MEASURED
        yield 'cable_stiffness', f'cable_{loop.name}', 'stiffness', MEASURED
        yield 'cable_stiffness', f'cable_{loop.name}', 'hardening', 0.0
    for coupling in instrument.couplings:
        yield 'cable_stiffness', f'coupling_{coupling.name}', 'stiffness', MEASURED
    for motor in instrument.motors:
        yield 'torque_gain', f'motor_{motor.name}', 'torque_gain', 0.0
    for contact in instrument.contacts:
        yield 'contact_stiffness', contact_place(instrument, contact), 'stiffness', MEASURED


def _damped(instrument: Instrument) -> Iterator[tuple[str, str, float, float]]:
    """Yield place, unit, damping and mean stiffness of all that stretches or twists."""
    curves = {c.name: c for c in instrument.curves}
    for loop in instrument.loops:
        x, t = curves[loop.curve].elongation, curves[loop.curve].tension
        yield f'cable_{loop.name}', 'N s/m', loop.damping, (t[-1] - t[0]) / (x[-1] - x[0])
    for coupling in instrument.couplings:
        place = f'coupling_{coupling.name}'
        yield place, 'N m s/rad', coupling.damping, coupling.stiffness


def _yielding(contact: Contact, spread: float | None) -> Axis | None:
    """
    Return the axis of what is added to the damping of a contact.

    What the tip meets is rarely measured: where the file says nothing of its damping, there is
    some.
    """
    unit = DAMPING_UNITS[contact.law]
    some = SOME_LOSS if contact.law == 'hunt_crossley' else YIELDING * contact.stiffness
    if spread is None and contact.damping == 0.0:
        return Axis('damping', unit, 0.0, REACH * some, 0.0, some, spread=1.0)
    return _addition('damping', unit, contact.damping, spread or 0.0, some, -contact.damping)


def _of_effects(instrument: Instrument) -> Iterator[Tolerance]:
    """Yield what the file says of how well it knows the parameters of its own effects."""
    for use in instrument.effects:
        units = units_at(instrument, use.effect, use.place)
        for p in find(use.effect).parameters:
            name, unit = f'{use.effect}.{p.name}', units[p.name]
            spread = instrument.tolerances.get(f'{use.place}.{name}', 0.0)
            value = use.parameters.get(p.name, p.neutral)
            if spread == 0.0 or p.search in ('instant', 'duration'):
                continue
            if not math.isinf(spread):
                scale = spread if p.unit == 'rad' else spread * abs(value)
                if scale == 0.0:  # so many percent of nothing
                    continue
                reach = REACH * scale
                axis = Axis(name, unit, value - reach, value + reach, value, scale, spread=1.0)
            elif p.low > 0.0 and value > 0.0:
                axis = Axis(name, unit, p.low, p.high, value, 0.5, log=True, spread=REACH)
            else:
                about = 0.0 if p.shapes_only else p.neutral
                least = p.typical - about or SOME_SHAPE
                scale = max(0.5 * abs(value), abs(least))
                axis = Axis(name, unit, p.low, p.high, value, scale, spread=10.0)
            yield Tolerance(use.effect, use.place, name, p.name, _within(axis, p), given=True)


def _within(axis: Axis, parameter: Parameter) -> Axis:
    """Return an axis that ends where its effect does."""
    low, high = max(axis.low, parameter.low), min(axis.high, parameter.high)
    return replace(axis, low=low, high=high)


def _about(axis: Axis, value: float, factor: bool) -> Axis:
    """Return the axis of a number that an effect of the file has changed already."""
    if not factor:
        low, high, centre = axis.low + value, axis.high + value, axis.centre + value
        return replace(axis, low=low, high=high, centre=centre)
    scale = axis.scale if axis.log else value * axis.scale
    low, high, centre = value * axis.low, value * axis.high, value * axis.centre
    return replace(axis, low=low, high=high, centre=centre, scale=scale)


def _moving(effect: str, quantity: str) -> Parameter:
    """Return the parameter that moves a number of the file: that of its name, or the first."""
    parameters = find(effect).parameters
    return next((p for p in parameters if p.name == quantity), parameters[0])


def _factor(quantity: str, spread: float, parameter: Parameter) -> Axis | None:
    """
    Return the axis of a factor about one; None where nothing may move.

    A number that may be twice as large may be half as large: what is below zero, or next to it, is
    no tolerance of an inertia.
    """
    if spread <= 0.0:
        return None
    if math.isinf(spread):
        scale = 0.25 if parameter.search == 'guess' else 0.5
        return Axis(quantity, '1', 0.02, 50.0, 1.0, scale, log=True, spread=REACH)
    high = math.exp(REACH * spread)
    return Axis(quantity, '1', max(0.02, 1.0 / high), high, 1.0, spread, log=True, spread=1.0)


def _addition(
    quantity: str,
    unit: str,
    nominal: float,
    spread: float,
    some: float,
    least: float = -math.inf,
) -> Axis | None:
    """Return the axis of what is added to a number; None where nothing may be."""
    if math.isinf(spread):
        scale = max(0.5 * nominal, some)
        reach = max(1e3, 10.0 * scale)
        return Axis(quantity, unit, max(least, -reach), reach, 0.0, scale, spread=10.0)
    scale = spread * nominal
    if scale <= 0.0:
        return None
    low = max(least, -REACH * scale)
    return Axis(quantity, unit, low, REACH * scale, 0.0, scale, spread=1.0)
