"""
The instrument: a network of pulleys, cable loops, motors, contacts and sensors, in SI units.

Frozen plain data. :mod:`tendon_ros.model.instrument_file` reads it from YAML and writes it back;
nothing here knows of files. With the routing matrix ``C`` (one row a loop, one column a pulley),
``delta = C theta`` is the elongation of each loop and ``-C^T T(delta)`` the torque on each pulley:
the paper's eqs. (1)-(6) are one such network.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import InstrumentError, listed

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Pulley:
    """A body that turns: ``inertia`` [kg m^2], viscous ``damping`` [N m s/rad]."""

    name: str
    inertia: float
    damping: float = 0.0


@dataclass(frozen=True)
class Curve:
    """
    Tension [N] of one cable against its elongation [m], monotone cubic between the points.

    Below the first point a cable is slack (tension of the first point); beyond the last one the
    curve goes on straight.
    """

    name: str
    elongation: tuple[float, ...]
    tension: tuple[float, ...]


@dataclass(frozen=True)
class Loop:
    """
    A closed loop of two cables wound in opposite directions, each with ``pretension`` [N].

    ``route``: signed radius [m] by pulley, so that ``delta = sum(radius * angle)`` [m].
    ``torque_sign`` multiplies the torque on a pulley; -1 for pulley 3 in loop 12 is what the
    paper's printed eq. (6) says, against virtual work.
    """

    name: str
    route: Mapping[str, float]
    curve: str
    pretension: float
    damping: float = 0.0  # [N s/m]
    torque_sign: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Coupling:
    """
    A linear torsion spring between pulleys: a shaft, a gear's teeth.

    ``route``: signed ratio by pulley, so that its twist is ``sum(ratio * angle)`` [rad];
    ``stiffness`` [N m/rad], ``damping`` [N m s/rad].
    """

    name: str
    route: Mapping[str, float]
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True)
class Controller:
    """
    PID on a motor's encoder: gains [N m/rad], [N m/(rad s)], [N m s/rad]; ``limit`` [N m].

    ``derivative``: whether ``kd`` acts on the error's rate, or brakes by the reading's alone, as
    the speed loop within a position loop does.
    """

    kp: float = 0.0
    ki: float = 0.0
    kd: float = 0.0
    limit: float = math.inf
    derivative: Literal['error', 'reading'] = 'error'


#: times a position limit: further off, a unit or a reading is wrong and not the rig another
FAR = 5.0
#: the same of the largest torque
HUGE = 20.0


@dataclass(frozen=True)
class Motor:
    """
    A motor on a pulley, perhaps through a rigid gear.

    ``gear_ratio``: turns of the rotor for one of the pulley; ``rotor_inertia`` [kg m^2] before the
    gear. At the pulley: ``torque_limit`` [N m]; ``speed_limit`` [rad/s] and ``position_limit``
    [rad], lower and upper, of what may be commanded. Whose ``controller`` is not known is driven
    along what was recorded, and follows no command.
    """

    name: str
    pulley: str
    controller: Controller | None = None
    gear_ratio: float = 1.0
    rotor_inertia: float = 0.0
    torque_limit: float = float('inf')
    speed_limit: float = float('inf')
    position_limit: tuple[float, float] = (float('-inf'), float('inf'))

    @property
    def largest(self) -> float:
        """The largest torque that it gives [N m]."""
        return min(self.torque_limit, (self.controller or Controller()).limit)

    def cannot_be(self, angle: float) -> bool:
        """
        Return whether an angle is so far beyond the limits that no motion leads there.

        :param angle: of the pulley [rad].
        :return: whether; never where the limits are open.
        """
        low, high = self.position_limit
        return abs(angle) > FAR * max(abs(low), abs(high))

    def cannot_give(self, torque: float) -> bool:
        """
        Return whether a torque is so far beyond the largest that no motor like this gives it.

        :param torque: at the pulley [N m].
        :return: whether; never where the largest is open.
        """
        return abs(torque) > HUGE * self.largest


#: unit of a contact's damping, by its law
DAMPING_UNITS = {'hunt_crossley': 's/m', 'spring_damper': 'N*s/m'}


@dataclass(frozen=True)
class Contact:
    """
    A one-sided stop that the instrument pushes against.

    ``route``: ratio by pulley, so that the contact's coordinate is ``sum(ratio * angle)`` [rad];
    closed where it exceeds ``position`` [rad]. ``arm`` [m] from axis to contact point,
    ``stiffness`` [N/m]. ``law`` is ``spring_damper`` (force k x + d v while positive; ``damping``
    [N s/m]) or ``hunt_crossley`` (k x (1 + d v); ``damping`` [s/m]).
    """

    name: str
    route: Mapping[str, float]
    arm: float
    stiffness: float
    damping: float = 0.0
    position: float = 0.0
    law: str = 'hunt_crossley'
    enabled: bool = True


@dataclass(frozen=True)
class Sensor:
    """
    A sensor: ``kind`` angle, velocity, motor_torque, contact_force, contact_torque or loop_torque.

    ``of`` names what it measures (pulley, motor or contact; for loop_torque the pulley, with
    ``through`` the loop or coupling). ``resolution`` is one count, 0 for none; ``noise`` the
    standard deviation, used only when noise is asked for; both in the unit of the reading.
    ``misfit`` is what a diagnosis left unexplained of it, the standard deviation of what is no
    noise; estimates rest on it. ``channel`` is the recording's channel. Where ``zeroed`` is false,
    the zero of an angle is anyone's guess and another in every recording, as of an incremental
    encoder that is not homed.
    """

    name: str
    kind: str
    of: str
    channel: str
    through: str = ''
    resolution: float = 0.0
    noise: float = 0.0
    misfit: float = 0.0
    zeroed: bool = True

    @property
    def error(self) -> float:
        """Standard deviation of one reading by its data sheet: noise and rounding together."""
        return math.hypot(self.noise, self.resolution / math.sqrt(12.0))


@dataclass(frozen=True)
class EffectUse:
    """
    An effect in force at a place, with its parameters in SI units.

    With ``instead`` it changes the parameters of the effect that the instrument has there
    already, where it has one, and does not act beside it.
    """

    effect: str
    place: str
    parameters: Mapping[str, float]
    instead: bool = False

    def __hash__(self) -> int:
        # a mapping has none of its own
        return hash((self.effect, self.place, frozenset(self.parameters.items()), self.instead))


@dataclass(frozen=True)
class Instrument:
    """
    The whole network. Order of pulleys and motors is the order in which arrays are given.

    ``tolerances``: how well a number is known, by place and key of the file, such as
    ``pulley_3.inertia``, ``cable_L3.stiffness`` or ``pulley_3.gravity.torque``. One standard
    deviation relative to the number, but in rad for an angle; infinite for what was guessed. What
    is not listed is as good as such numbers usually are.
    """

    name: str
    pulleys: tuple[Pulley, ...]
    motors: tuple[Motor, ...]
    loops: tuple[Loop, ...] = ()
    couplings: tuple[Coupling, ...] = ()
    curves: tuple[Curve, ...] = ()
    contacts: tuple[Contact, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    effects: tuple[EffectUse, ...] = ()
    control_period: float = 1e-3  # [s]
    continuous_control: bool = False
    description: str = ''
    tolerances: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def pulley_names(self) -> tuple[str, ...]:
        """Names of the pulleys, in order."""
        return tuple(p.name for p in self.pulleys)

    @cached_property
    def motor_names(self) -> tuple[str, ...]:
        """Names of the motors, in order."""
        return tuple(m.name for m in self.motors)

    @property
    def uncontrolled(self) -> tuple[str, ...]:
        """Names of the motors that nothing makes follow a command."""
        return tuple(m.name for m in self.motors if m.controller is None)

    @property
    def driven(self) -> tuple[str, ...]:
        """Names of the pulleys that the motors turn, in the motors' order."""
        return tuple(m.pulley for m in self.motors)

    @property
    def inner(self) -> tuple[str, ...]:
        """Names of the pulleys without a motor, in order."""
        driven = set(self.driven)
        return tuple(name for name in self.pulley_names if name not in driven)

    @property
    def links(self) -> tuple[Loop | Coupling, ...]:
        """What joins pulleys elastically: all loops, then all couplings."""
        return (*self.loops, *self.couplings)

    def index(self, pulley: str) -> int:
        """
        Return the position of a pulley in every array of angles.

        :param pulley: its name.
        :return: its index.
        :raises InstrumentError: where there is no such pulley.
        """
        try:
            return self._indices[pulley]
        except KeyError:
            raise InstrumentError(
                f'{self.name}: no pulley {pulley!r}; it has {listed(self.pulley_names)}'
            ) from None

    @cached_property
    def _indices(self) -> Mapping[str, int]:
        return {name: i for i, name in enumerate(self.pulley_names)}

    @cached_property
    def place_indices(self) -> Mapping[str, tuple[str, int]]:
        """Kind and index among its kind of every place; couplings are counted after the loops."""
        tables = {
            'pulley': [f'pulley_{p.name}' for p in self.pulleys],
            'cable': [f'cable_{loop.name}' for loop in self.loops],
            'coupling': [f'coupling_{c.name}' for c in self.couplings],
            'motor': [f'motor_{m.name}' for m in self.motors],
            'sensor': [s.name for s in self.sensors],
            'contact': [contact_place(self, c) for c in self.contacts],
        }
        first = {'coupling': len(self.loops)}
        return {
            name: (kind, index)
            for kind, names in tables.items()
            for index, name in enumerate(names, first.get(kind, 0))
        }

    def routing(self) -> FloatArray:
        """
        Return the routing matrix C of all loops, then couplings.

        :return: shape (loops + couplings, pulleys): radii [m] for loops, ratios for couplings.
        """
        rows: tuple[Loop | Coupling, ...] = (*self.loops, *self.couplings)
        matrix = np.zeros((len(rows), len(self.pulleys)))
        for k, row in enumerate(rows):
            for pulley, radius in row.route.items():
                matrix[k, self.index(pulley)] = radius
        return matrix

    def places(self) -> tuple[str, ...]:
        """Return every place where an effect can act, by the names of the contract."""
        return tuple(self.place_indices)


def contact_place(instrument: Instrument, contact: Contact) -> str:
    """
    Return the place of a contact: ``contact``, or with its name where there are several.

    :param instrument: the instrument it belongs to.
    :param contact: the contact.
    :return: the place.
    """
    return 'contact' if len(instrument.contacts) == 1 else f'contact_{contact.name}'
