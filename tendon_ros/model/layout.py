"""
From an instrument with its effects to the kernel's names, constants and arrays.

Three things are settled here and nowhere else: which constants a compiled kernel has
(:class:`Structure`), where each number lies in the flat arrays, and how effects turn into numbers
and laws. Pulleys are put in reverse Cuthill-McKee order, so that the network's matrix is banded.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from tendon_ros.base.effect import HOOKS
from tendon_ros.base.errors import EffectError, listed
from tendon_ros.effects import catalogue, find
from tendon_ros.model.cable import elongation_at, uniform_cubic
from tendon_ros.model.instrument import contact_place, EffectUse, Instrument

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SENSOR_SOURCES = (
    'angle',
    'velocity',
    'motor_torque',
    'contact_force',
    'contact_torque',
    'loop_torque',
)

#: the longest delay of a sensor, in controller periods
RING = 64

#: sizes of the named places in each array, in terms of the sizes of the network
PLACES: Mapping[str, Mapping[str, str]] = {
    'm': {
        'INERTIA': 'N', 'DAMPING': 'N', 'BREAKAWAY': 'N', 'RADIUS': 'M*WIDTH', 'ARM': 'M*WIDTH',
        'PRELOAD': 'M', 'SCALE': 'M', 'LOOP_DAMPING': 'M', 'PLAY': 'M', 'CURVE_START': 'M',
        'CURVE_RATE': 'M', 'CURVE_BELOW': 'M', 'CONTACT_RATIO': 'K*WIDTH',
        'CONTACT_STIFFNESS': 'K', 'CONTACT_DAMPING': 'K', 'CONTACT_POSITION': 'K',
        'CONTACT_ARM': 'K', 'MOTOR_GAIN': 'U', 'MOTOR_BIAS': 'U', 'MOTOR_LIMIT': 'U', 'KP': 'U',
        'KI': 'U', 'KD': 'U', 'LIMIT': 'U', 'SENSOR_GAIN': 'Q', 'SENSOR_OFFSET': 'Q',
        'SENSOR_DELAY': 'Q', 'SENSOR_RESOLUTION': 'Q', 'SENSOR_NOISE': 'Q', 'PERIOD': '1',
        'TOLERANCE': '1', 'STILL': '1',
    },
    'd': {
        'DRIVE': 'N', 'MOTION': 'N', 'PUSH': 'N', 'REFERENCE': 'U', 'ENCODER': 'U',
        'INTEGRAL': 'U', 'BRISTLE': 'N', 'DRY': 'N', 'CURVE_CELLS': 'M', 'CURVE_OFFSET': 'M',
        'CONTACT_LAW': 'K', 'CONTACT_ON': 'K', 'SENSOR_RECTIFIED': 'Q', 'REMEMBERS': '1', 'ACTIVE': '1',
        'STATE_LOOP': 'STATES', 'STATE_PULLEY': 'STATES', 'BREAKS': '1', 'SWITCH': '1',
        'TORQUES': '2', 'BUDGETS': '2', 'ELONGATIONS': '2', 'TENSIONS': '2', 'WINDINGS': '2',
    },
    'w': {
        'EPOCH': '1', 'INPUT': 'N', 'WOUND': 'N', 'TURN': 'N', 'CURL': 'N', 'ACCELERATION': 'N',
        'DELTA': 'M', 'RATE': 'M', 'SHIFT': 'M', 'SHIFT_D': 'M', 'TENSION': 'M',
        'TENSION_D': 'M', 'TENSION_R': 'M', 'TOTAL': 'M', 'TOTAL_D': 'M', 'SLACK': 'M',
        'TORQUE': 'N', 'TORQUE_T': 'N', 'TORQUE_W': 'N', 'LOAD': 'N', 'BUDGET': 'N',
        'BUDGET_W': 'N', 'BUDGET_L': 'N', 'SIDE': 'N', 'GAP': 'K', 'FORCE': 'K', 'FORCE_Q': 'K',
        'FORCE_V': 'K', 'STATE_RATE': 'STATES', 'STATE_A': 'STATES', 'STATE_B': 'STATES',
        'STATE_Z': 'STATES', 'STATE_T': 'STATES', 'STATE_S': 'STATES', 'J_LOOP': 'M',
        'J_LOOP_RATE': 'M', 'J_TOTAL': 'M', 'J_RADIUS': 'M*WIDTH', 'J_ARM': 'M*WIDTH',
        'J_GRIP': 'M*WIDTH', 'J_ANGLE': 'N', 'J_SPEED': 'N', 'J_CONTACT': 'K',
        'J_CONTACT_RATE': 'K', 'J_A': 'STATES', 'J_B': 'STATES', 'J_Z': 'STATES',
        'J_T': 'STATES', 'J_S': 'STATES', 'F': 'DIM', 'FIRST': 'DIM', 'START': 'DIM',
        'TRIAL': 'DIM', 'NEXT': 'DIM', 'STAGE': '6*DIM', 'RIGHT': 'DIM', 'OUTER': 'DIM',
        'KAPPA': 'M', 'SIGMA': 'M', 'CHI': 'M', 'MATRIX': 'N*SPAN', 'SLACK_START': 'M',
        'PENDING': 'N+K+M',
    },
    'c': {
        'CLOCK': '1', 'STEP': '1', 'TICK': '1', 'COMMAND': 'U', 'SUM': 'U', 'LAST': 'U',
        'READING': 'Q', 'DRAWN': '1', 'ROW': '1', 'PAST': 'Q*RING',
    },
    'g': {'MODE': 'N', 'TOUCH': 'K', 'COUNT': '3'},
}  # fmt: skip


@dataclass(frozen=True)
class Structure:
    """
    What a compiled kernel is specialised to; instruments with equal structure share one.

    ``order[i]`` is the instrument's index of the pulley at place i of the kernel.
    """

    order: tuple[int, ...]
    loop_pulley: tuple[tuple[int, ...], ...]
    contact_pulley: tuple[tuple[int, ...], ...]
    motor_pulley: tuple[int, ...]
    sensor_source: tuple[int, ...]
    sensor_index: tuple[int, ...]

    @cached_property
    def constants(self) -> Mapping[str, int | tuple[int, ...]]:
        """Every name of ``kernel.structure`` with its value."""
        rows = (*self.loop_pulley, *self.contact_pulley)
        width = max((len(row) for row in rows), default=1)
        band = max((max(row) - min(row) for row in rows if row), default=0)
        sizes: dict[str, int] = {
            'N': len(self.order), 'M': len(self.loop_pulley), 'K': len(self.contact_pulley),
            'U': len(self.motor_pulley), 'Q': len(self.sensor_source), 'WIDTH': width,
            'BAND': band, 'SPAN': 2 * band + 1, 'RING': RING,
        }  # fmt: skip
        sizes['STATES'] = sizes['N'] + sizes['U'] + 2 * sizes['M']
        sizes['DIM'] = 2 * sizes['N'] + sizes['STATES']
        sizes['WIDTH_ROW'] = 1 + 2 * sizes['N'] + sizes['U'] + sizes['M'] + sizes['K'] + sizes['Q']
        out: dict[str, int | tuple[int, ...]] = dict(sizes)
        for array, places in PLACES.items():
            at = 0
            for name, size in places.items():
                out[name] = at
                at += _product(size, sizes)
            out[f'LENGTH_{array}'] = at
        out['LOOP_PULLEY'] = _padded(self.loop_pulley, width)
        out['CONTACT_PULLEY'] = _padded(self.contact_pulley, width)
        out['MOTOR_PULLEY'] = self.motor_pulley
        out['SENSOR_SOURCE'] = self.sensor_source
        out['SENSOR_INDEX'] = self.sensor_index
        return out

    def __getitem__(self, name: str) -> int:
        value = self.constants[name]
        if isinstance(value, tuple):
            raise TypeError(f'{name} is a table')
        return value

    def length(self, array: str) -> int:
        """Return the length of the fixed part of one of the kernel's arrays."""
        return self[f'LENGTH_{array}']


def _product(size: str, sizes: Mapping[str, int]) -> int:
    """Return the value of a size such as ``6*DIM`` or ``N+K+M``."""
    total = 0
    for term in size.split('+'):
        value = 1
        for name in term.split('*'):
            value *= int(name) if name.isdigit() else sizes[name]
        total += value
    return total


def _padded(rows: Sequence[Sequence[int]], width: int) -> tuple[int, ...]:
    return tuple(i for row in rows for i in (*row, *([row[0]] * (width - len(row)))))


def structure_of(instrument: Instrument) -> Structure:
    """
    Return what the kernel is specialised to for an instrument.

    :param instrument: the network.
    :return: its structure, pulleys in an order that keeps the matrix banded.
    """
    n = len(instrument.pulleys)
    routes = [row.route for row in (*instrument.loops, *instrument.couplings)]
    contacts = [c.route for c in instrument.contacts]
    joined = np.eye(n)
    for route in (*routes, *contacts):
        for a in route:
            for b in route:
                joined[instrument.index(a), instrument.index(b)] = 1.0
    order = tuple(int(i) for i in reverse_cuthill_mckee(csr_array(joined), symmetric_mode=True))
    place = {instrument.pulley_names[i]: at for at, i in enumerate(order)}
    loop_pulley = tuple(tuple(place[name] for name in route) for route in routes)
    contact_pulley = tuple(tuple(place[name] for name in route) for route in contacts)
    width = max((len(row) for row in (*loop_pulley, *contact_pulley)), default=1)
    source: list[int] = []
    index: list[int] = []
    through = [row.name for row in (*instrument.loops, *instrument.couplings)]
    for sensor in instrument.sensors:
        source.append(SENSOR_SOURCES.index(sensor.kind))
        if sensor.kind in ('angle', 'velocity'):
            index.append(place[sensor.of])
        elif sensor.kind == 'motor_torque':
            index.append(instrument.motor_names.index(sensor.of))
        elif sensor.kind == 'loop_torque':
            k = through.index(sensor.through)
            index.append(width * k + loop_pulley[k].index(place[sensor.of]))
        else:
            index.append([c.name for c in instrument.contacts].index(sensor.of))
    return Structure(
        order=order,
        loop_pulley=loop_pulley,
        contact_pulley=contact_pulley,
        motor_pulley=tuple(place[m.pulley] for m in instrument.motors),
        sensor_source=tuple(source),
        sensor_index=tuple(index),
    )


@dataclass
class Numbers:
    """The numbers of a model by name, in the instrument's order: what effects may modify."""

    instrument: Instrument
    kind: str = ''  # of the place that an effect is about to modify
    values: dict[str, FloatArray] = field(init=False)

    def __post_init__(self) -> None:
        one = self.instrument
        rows = (*one.loops, *one.couplings)
        gear = {m.pulley: m.gear_ratio**2 * m.rotor_inertia for m in one.motors}
        self.values = {
            'inertia': np.array([p.inertia + gear.get(p.name, 0.0) for p in one.pulleys]),
            'damping': np.array([p.damping for p in one.pulleys]),
            'breakaway': np.zeros(len(one.pulleys)),
            'radius': one.routing(),
            'arm': one.routing(),
            'pretension': np.array([getattr(row, 'pretension', 0.0) for row in rows]),
            'scale': np.ones(len(rows)),
            'loop_damping': np.array([row.damping for row in rows]),
            'play': np.zeros(len(rows)),
            'contact_stiffness': np.array([c.stiffness for c in one.contacts]),
            'contact_damping': np.array([c.damping for c in one.contacts]),
            'contact_position': np.array([c.position for c in one.contacts]),
            'motor_gain': np.ones(len(one.motors)),
            'motor_bias': np.zeros(len(one.motors)),
            'motor_limit': np.array([min(m.torque_limit, 1e300) for m in one.motors]),
            'motor_pulley': np.array([one.index(m.pulley) for m in one.motors]),
            'sensor_gain': np.ones(len(one.sensors)),
            'sensor_offset': np.zeros(len(one.sensors)),
            'sensor_delay': np.zeros(len(one.sensors)),
            'sensor_rectified': np.zeros(len(one.sensors)),
        }
        for k, row in enumerate(one.loops):
            for name, sign in row.torque_sign.items():
                self.values['arm'][k, one.index(name)] *= sign

    def __getitem__(self, name: str) -> FloatArray:
        return self.values[name]

    def loops_on(self, pulley: int) -> Sequence[int]:
        """Return the loops and couplings that touch a pulley."""
        return [int(k) for k in np.flatnonzero(self.values['radius'][:, pulley])]


def place_index(instrument: Instrument, place: str) -> tuple[str, int]:
    """
    Return the kind of a place and its index among those of its kind.

    :param instrument: the instrument.
    :param place: a name by the contract, such as ``pulley_3`` or ``cable_L3``.
    :return: kind (pulley, cable, coupling, motor, sensor, contact) and index; couplings are
        counted after the loops.
    :raises EffectError: where there is no such place.
    """
    tables: Mapping[str, Sequence[str]] = {
        'pulley': [f'pulley_{p.name}' for p in instrument.pulleys],
        'cable': [f'cable_{loop.name}' for loop in instrument.loops],
        'coupling': [f'coupling_{c.name}' for c in instrument.couplings],
        'motor': [f'motor_{m.name}' for m in instrument.motors],
        'sensor': [s.name for s in instrument.sensors],
        'contact': [contact_place(instrument, c) for c in instrument.contacts],
    }
    for kind, names in tables.items():
        if place in names:
            index = names.index(place)
            return kind, index + (len(instrument.loops) if kind == 'coupling' else 0)
    raise EffectError(
        f'{instrument.name}: no place {place!r}; it has {listed(instrument.places())}'
    )


@dataclass(frozen=True)
class Arrays:
    """The kernel's arrays ``m`` and ``d`` for an instrument with its effects."""

    structure: Structure
    m: FloatArray
    d: IntArray


def law_numbers() -> Mapping[str, Mapping[str, int]]:
    """
    Return the number by which the kernel knows each law, by hook and effect id.

    :return: for each hook, the effects that have a law for it, numbered in the order of their ids.
    """
    effects = catalogue()
    return {
        hook: {
            name: number
            for number, name in enumerate(sorted(e for e in effects if effects[e].hook == hook))
        }
        for hook in HOOKS
    }


def arrays_of(
    instrument: Instrument,
    effects: Sequence[EffectUse] | None = None,
    *,
    prescribed: Mapping[str, int] | None = None,
    pushed: Mapping[str, int] | None = None,
    references: Mapping[str, int] | None = None,
    tolerance: float = 1e-7,
) -> Arrays:
    """
    Return the arrays of an instrument.

    :param instrument: the network.
    :param effects: effects in force; those of the instrument where None.
    :param prescribed: signal row by pulley whose motion is prescribed.
    :param pushed: signal row by pulley that is pushed by a torque signal.
    :param references: signal row by motor under continuous control.
    :param tolerance: local error allowed in an angle [rad].
    :return: the arrays for the kernel.
    :raises EffectError: on an effect that cannot act where it is placed.
    """
    structure = structure_of(instrument)
    numbers = Numbers(instrument)
    packer = _Packer(instrument, structure, numbers)
    uses = instrument.effects if effects is None else effects
    for use in uses:
        packer.add_effect(use)
    return packer.pack(prescribed or {}, pushed or {}, references or {}, tolerance)


class _Packer:
    """Collects numbers and laws, then writes the flat arrays."""

    def __init__(self, instrument: Instrument, structure: Structure, numbers: Numbers) -> None:
        self.instrument = instrument
        self.structure = structure
        self.numbers = numbers
        self.laws: dict[str, list[tuple[int, int, tuple[float, ...], bool]]] = {
            hook: [] for hook in HOOKS
        }
        self.switches: list[float] = []
        self.kernel_place = {i: at for at, i in enumerate(structure.order)}

    def add_effect(self, use: EffectUse) -> None:
        effect = find(use.effect)
        kind, index = place_index(self.instrument, use.place)
        if kind not in effect.kinds:
            raise EffectError(
                f'{use.effect} cannot act at {use.place}: it acts at {listed(effect.kinds)}'
            )
        if kind == 'sensor' and self.instrument.sensors[index].kind not in effect.sensors:
            raise EffectError(
                f'{use.effect} cannot act at {use.place}, a sensor of '
                f'{self.instrument.sensors[index].kind}: it acts on {listed(effect.sensors)}'
            )
        values = {**effect.neutral, **use.parameters}
        unknown = set(use.parameters) - set(values)
        if unknown:
            raise EffectError(
                f'{use.effect} at {use.place}: no parameter {sorted(unknown)[0]!r}; it has '
                f'{listed(values)}'
            )
        for parameter in effect.parameters:
            value = values[parameter.name]
            if not parameter.low <= value <= parameter.high:
                raise EffectError(
                    f'{use.effect} at {use.place}: {parameter.name} = {value:g} {parameter.unit} '
                    f'is outside {parameter.low:g} to {parameter.high:g}'
                )
        if all(values[p.name] == p.neutral for p in effect.parameters if not p.shapes_only):
            return  # off costs nothing and changes nothing, not even the rounding
        if effect.modify is not None:
            self.numbers.kind = kind
            effect.modify(self.numbers, index, **values)
        if effect.hook:
            if kind == 'motor':
                index = int(self.numbers['motor_pulley'][index])
            on_pulley = effect.hook in ('torque', 'budget', 'winding')
            place = self.kernel_place[index] if on_pulley else index
            number = law_numbers()[effect.hook][use.effect]
            ordered = tuple(values[p.name] for p in effect.parameters)
            self.laws[effect.hook].append((number, place, ordered, effect.stateful))
        if effect.switches is not None:
            self.switches.extend(effect.switches(**values))

    def pack(
        self,
        prescribed: Mapping[str, int],
        pushed: Mapping[str, int],
        references: Mapping[str, int],
        tolerance: float,
    ) -> Arrays:
        one = self.instrument
        at = self.structure
        numbers = self.numbers
        m = np.zeros(at.length('m'))
        d = np.zeros(at.length('d'), dtype=np.int64)
        order = np.array(at.order)
        n = len(order)
        for name in ('inertia', 'damping', 'breakaway'):
            _put(m, at[name.upper()], numbers[name][order])
        width = at['WIDTH']
        for k, row in enumerate(at.loop_pulley):
            for e, i in enumerate(row):
                m[at['RADIUS'] + width * k + e] = numbers['radius'][k, order[i]]
                m[at['ARM'] + width * k + e] = numbers['arm'][k, order[i]]
        for k, contact in enumerate(one.contacts):
            _put(m, at['CONTACT_RATIO'] + width * k, list(contact.route.values()))
            m[at['CONTACT_ARM'] + k] = contact.arm
            d[at['CONTACT_LAW'] + k] = 1 if contact.law == 'hunt_crossley' else 0
            d[at['CONTACT_ON'] + k] = int(contact.enabled)
        for name in ('contact_stiffness', 'contact_damping', 'contact_position', 'motor_gain',
                     'motor_bias', 'motor_limit', 'sensor_gain', 'sensor_offset',
                     'sensor_delay', 'scale', 'loop_damping', 'play'):  # fmt: skip
            _put(m, at[name.upper()], numbers[name])
        d[at['REMEMBERS']] = int((numbers['sensor_delay'] > 0.0).any())
        if (numbers['sensor_delay'] > (RING - 2) * one.control_period).any():
            raise EffectError(
                f'{one.name}: a sensor is delayed by more than {RING - 2} controller periods '
                f'({(RING - 2) * one.control_period:g} s), which is all that is remembered'
            )
        _put(d, at['SENSOR_RECTIFIED'], numbers['sensor_rectified'] >= 0.5)
        _put(m, at['SENSOR_RESOLUTION'], [s.resolution for s in one.sensors])
        _put(m, at['SENSOR_NOISE'], [s.noise for s in one.sensors])
        for j, motor in enumerate(one.motors):
            for name in ('kp', 'ki', 'kd', 'limit'):
                m[at[name.upper()] + j] = getattr(motor.controller, name)
        m[at['PERIOD']] = one.control_period
        m[at['TOLERANCE']] = tolerance
        m[at['STILL']] = 1e-3

        for place in ('MOTION', 'PUSH', 'BRISTLE'):
            d[at[place] : at[place] + n] = -1
        for place in ('REFERENCE', 'INTEGRAL'):
            d[at[place] : at[place] + len(one.motors)] = -1
        for name, signal in prescribed.items():
            i = self.kernel_place[one.index(name)]
            d[at['DRIVE'] + i] = 1
            d[at['MOTION'] + i] = signal
        for name, signal in pushed.items():
            d[at['PUSH'] + self.kernel_place[one.index(name)]] = signal
        for j, motor in enumerate(one.motors):
            encoders = [
                q for q, s in enumerate(one.sensors) if s.kind == 'angle' and s.of == motor.pulley
            ]
            d[at['ENCODER'] + j] = encoders[0] if encoders else 0
        tail_m: list[float] = []
        tail_d: list[int] = []
        states: list[tuple[int, int]] = []
        for _, i, _, _ in self.laws['budget']:
            if numbers['breakaway'][order[i]] > 0.0:
                if d[at['BRISTLE'] + i] < 0:
                    d[at['BRISTLE'] + i] = len(states)
                    states.append((-1, i))
            else:
                d[at['DRY'] + i] = 1
        for j, motor in enumerate(one.motors):
            if motor.name in references:
                d[at['REFERENCE'] + j] = references[motor.name]
                d[at['INTEGRAL'] + j] = len(states)
                states.append((-1, at.motor_pulley[j]))
        self._pack_curves(m, d, tail_m)
        for hook in HOOKS:
            d[at[f'{hook.upper()}S']] = at.length('d') + len(tail_d)
            d[at[f'{hook.upper()}S'] + 1] = len(self.laws[hook])
            for number, place, values, stateful in self.laws[hook]:
                state = -1
                if stateful:
                    state = len(states)
                    states.append((place, -1))
                tail_d += [number, place, at.length('m') + len(tail_m), state]
                tail_m += values
        if len(states) > at['STATES']:
            raise EffectError(
                f'{one.name}: {len(states)} effects with a memory at once, room for '
                f'{at["STATES"]}; leave some out'
            )
        d[at['ACTIVE']] = len(states)
        for z, (loop, pulley) in enumerate(states):
            d[at['STATE_LOOP'] + z] = loop
            d[at['STATE_PULLEY'] + z] = pulley
        d[at['SWITCH']] = at.length('m') + len(tail_m)
        switches = sorted({float(t) for t in self.switches})
        d[at['BREAKS']] = len(switches)
        tail_m += switches
        return Arrays(
            structure=at,
            m=np.concatenate([m, np.array(tail_m, dtype=np.float64)]),
            d=np.concatenate([d, np.array(tail_d, dtype=np.int64)]),
        )

    def _pack_curves(self, m: FloatArray, d: IntArray, tail: list[float]) -> None:
        one = self.instrument
        at = self.structure
        curves = {curve.name: curve for curve in one.curves}
        placed: dict[str, tuple[int, int, float, float]] = {}
        for k, loop in enumerate(one.loops):
            curve = curves[loop.curve]
            if curve.name not in placed:
                start, rate, cubic = uniform_cubic(curve)
                placed[curve.name] = (at.length('m') + len(tail), len(cubic), start, rate)
                tail += cubic.ravel().tolist()
            self._point(m, d, k, placed[curve.name], 0.0)
            scale = self.numbers['scale'][k]
            m[at['PRELOAD'] + k] = elongation_at(curve, self.numbers['pretension'][k] / scale)
        for c, coupling in enumerate(one.couplings):
            k = len(one.loops) + c
            # two "cables" of half the stiffness that also push: one linear cell, both ways
            half = 0.5 * coupling.stiffness
            where = (at.length('m') + len(tail), 1, 0.0, 1.0)
            tail += [0.0, half, 0.0, 0.0]
            self._point(m, d, k, where, half)

    def _point(
        self,
        m: FloatArray,
        d: IntArray,
        k: int,
        where: tuple[int, int, float, float],
        below: float,
    ) -> None:
        at = self.structure
        offset, cells, start, rate = where
        d[at['CURVE_OFFSET'] + k] = offset
        d[at['CURVE_CELLS'] + k] = cells
        m[at['CURVE_START'] + k] = start
        m[at['CURVE_RATE'] + k] = rate
        m[at['CURVE_BELOW'] + k] = below


def _put(array: NDArray[np.generic], at: int, values: Sequence[float] | FloatArray) -> None:
    array[at : at + len(values)] = np.asarray(values)
