"""
From an instrument with its effects to the kernel's flat arrays.

How effects turn into numbers and laws is settled here; where each number lies is settled by
:mod:`tendon_ros.model.structure`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.effect import HOOKS
from tendon_ros.base.errors import EffectError, listed
from tendon_ros.effects import catalogue, find
from tendon_ros.model.cable import elongation_at, hardened, uniform_cubic
from tendon_ros.model.instrument import Curve, EffectUse, Instrument
from tendon_ros.model.numbers import Numbers, place_index
from tendon_ros.model.sensed import sensed
from tendon_ros.model.structure import RING, Structure, structure_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
        unknown = set(use.parameters) - set(effect.neutral)
        if unknown:
            raise EffectError(
                f'{use.effect} at {use.place}: no parameter {sorted(unknown)[0]!r}; it has '
                f'{listed(effect.neutral)}'
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
        for name in ('inertia', 'damping', 'breakaway', 'dither'):
            _put(m, at[name.upper()], numbers[name][order])
        _put(m, at['LASH'], 0.5 * numbers['lash'][order])
        width = at['WIDTH']
        cabled = {i for row in at.loop_pulley[: len(one.loops)] for i in row}
        for i in range(n):
            d[at['GEARED'] + i] = int(i not in cabled)
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
        _put(d, at['SENSOR_RECTIFIED'], (numbers['sensor_rectified'] >= 0.5).astype(np.float64))
        d[at['SENSORS']] = len(one.sensors)
        for q, (source, index) in enumerate(sensed(one, at)):
            d[at['SENSOR_SOURCE'] + q] = source
            d[at['SENSOR_INDEX'] + q] = index
        _put(m, at['SENSOR_RESOLUTION'], [s.resolution for s in one.sensors])
        _put(m, at['SENSOR_NOISE'], [s.noise for s in one.sensors])
        for j, motor in enumerate(one.motors):
            for name in ('kp', 'ki', 'kd', 'limit'):
                m[at[name.upper()] + j] = getattr(motor.controller, name)
            m[at['AHEAD'] + j] = float(motor.controller.derivative == 'error')
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
        d[at['DRIVEN']] = len(prescribed)
        d[at['PUSHED']] = len(pushed)
        d[at['BRISTLED']] = int((d[at['BRISTLE'] : at['BRISTLE'] + n] >= 0).sum())
        self._pack_curves(m, d, tail_m)
        for hook in HOOKS:
            d[at[f'{hook.upper()}S']] = at.length('d') + len(tail_d)
            d[at[f'{hook.upper()}S'] + 1] = len(self.laws[hook])
            for number, where, values, stateful in self.laws[hook]:
                state = -1
                if stateful:
                    state = len(states)
                    states.append((where, -1))
                tail_d += [number, where, at.length('m') + len(tail_m), state]
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
        placed: dict[Curve, tuple[int, int, float, float]] = {}
        for k, loop in enumerate(one.loops):
            curve = hardened(curves[loop.curve], float(self.numbers['hardening'][k]))
            if curve not in placed:
                start, rate, cubic = uniform_cubic(curve)
                placed[curve] = (at.length('m') + len(tail), len(cubic), start, rate)
                tail += cubic.ravel().tolist()
            self._point(m, d, k, placed[curve], 0.0)
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
