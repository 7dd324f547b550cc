"""
From an instrument with its effects to the kernel's flat arrays.

Where each number lies is settled by :mod:`tendon_ros.model.structure`, what effects make of the
numbers by :mod:`tendon_ros.model.laws`. A fit asks for the same instrument with other effects ten
thousand times: what no effect changes is written once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.effect import HOOKS
from tendon_ros.base.errors import EffectError
from tendon_ros.model.cable import elongation_at, hardened, uniform_cubic
from tendon_ros.model.instrument import Controller, Curve, EffectUse, Instrument
from tendon_ros.model.laws import Laws
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.sensed import sensed
from tendon_ros.model.structure import RING, Structure, structure_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: numbers that stand in the kernel's arrays as they are, in the instrument's order
PLAIN = ('contact_stiffness', 'contact_damping', 'contact_position', 'motor_gain', 'motor_bias',
         'motor_limit', 'motor_knee', 'sensor_gain', 'sensor_offset', 'sensor_delay', 'scale',
         'loop_damping', 'play')  # fmt: skip
#: hooks whose laws act on pulleys, which the kernel has in an order of its own
ON_PULLEYS = ('torque', 'budget', 'winding')


@dataclass(frozen=True)
class Arrays:
    """
    The kernel's arrays ``m`` and ``d`` for an instrument with its effects.

    ``numbers``: what the effects have made of the instrument's numbers.
    """

    structure: Structure
    m: FloatArray
    d: IntArray
    numbers: Numbers


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
    :param prescribed: as for :class:`Layout`.
    :param pushed: as for :class:`Layout`.
    :param references: as for :class:`Layout`.
    :param tolerance: as for :class:`Layout`.
    :return: the arrays for the kernel.
    :raises EffectError: on an effect that cannot act where it is placed.
    """
    layout = Layout(instrument, prescribed, pushed, references, tolerance)
    return layout.arrays(instrument.effects if effects is None else effects)


class Layout:
    """
    The arrays of an instrument but for what effects change.

    :param instrument: the network.
    :param prescribed: signal row by pulley whose motion is prescribed.
    :param pushed: signal row by pulley that is pushed by a torque signal.
    :param references: signal row by motor under continuous control.
    :param tolerance: local error allowed in an angle [rad].
    """

    def __init__(
        self,
        instrument: Instrument,
        prescribed: Mapping[str, int] | None = None,
        pushed: Mapping[str, int] | None = None,
        references: Mapping[str, int] | None = None,
        tolerance: float = 1e-7,
    ) -> None:
        self.instrument = instrument
        self.structure = at = structure_of(instrument)
        self._numbers = Numbers(instrument)
        self._curves = {curve.name: curve for curve in instrument.curves}
        self._kernel_place = {i: place for place, i in enumerate(at.order)}
        self._references = references or {}
        self._m = np.zeros(at.length('m'))
        self._d = np.zeros(at.length('d'), dtype=np.int64)
        self._write_network()
        self._write_sensors()
        self._write_control(tolerance)
        self._write_drives(prescribed or {}, pushed or {})
        self._moving = self._scattered()

    def arrays(self, effects: Sequence[EffectUse]) -> Arrays:
        """
        Return the arrays with effects.

        :param effects: all that are in force.
        :return: the arrays for the kernel.
        :raises EffectError: on an effect that cannot act where it is placed.
        """
        laws = Laws(self.instrument, self._numbers.copy())
        for use in effects:
            laws.add(use)
        at = self.structure
        m, d = self._m.copy(), self._d.copy()
        tail: list[float] = []
        self._write_numbers(m, d, laws.numbers)
        self._write_curves(m, d, tail, laws.numbers)
        rows = self._write_laws(m, d, tail, laws)
        d[at['SWITCH']] = len(m) + len(tail)
        switches = sorted({float(t) for t in laws.switches})
        d[at['BREAKS']] = len(switches)
        tail += switches
        return Arrays(
            structure=at,
            m=np.concatenate([m, np.array(tail, dtype=np.float64)]),
            d=np.concatenate([d, np.array(rows, dtype=np.int64)]),
            numbers=laws.numbers,
        )

    def _write_network(self) -> None:
        """Write contacts, and which pulleys no cable touches."""
        one, at, m, d = self.instrument, self.structure, self._m, self._d
        cabled = {i for row in at.loop_pulley[: len(one.loops)] for i in row}
        for i in range(at['N']):
            d[at['GEARED'] + i] = int(i not in cabled)
        for k, contact in enumerate(one.contacts):
            _put(m, at['CONTACT_RATIO'] + at['WIDTH'] * k, list(contact.route.values()))
            m[at['CONTACT_ARM'] + k] = contact.arm
            d[at['CONTACT_LAW'] + k] = 1 if contact.law == 'hunt_crossley' else 0
            d[at['CONTACT_ON'] + k] = int(contact.enabled)

    def _write_sensors(self) -> None:
        one, at, m, d = self.instrument, self.structure, self._m, self._d
        d[at['SENSORS']] = len(one.sensors)
        for q, (source, index) in enumerate(sensed(one, at)):
            d[at['SENSOR_SOURCE'] + q] = source
            d[at['SENSOR_INDEX'] + q] = index
        _put(m, at['SENSOR_RESOLUTION'], [s.resolution for s in one.sensors])
        _put(m, at['SENSOR_NOISE'], [s.noise for s in one.sensors])

    def _write_control(self, tolerance: float) -> None:
        one, at, m, d = self.instrument, self.structure, self._m, self._d
        for j, motor in enumerate(one.motors):
            gains = motor.controller or Controller()
            for name in ('kp', 'ki', 'kd', 'limit'):
                m[at[name.upper()] + j] = getattr(gains, name)
            m[at['AHEAD'] + j] = float(gains.derivative == 'error')
            encoders = [
                q for q, s in enumerate(one.sensors) if s.kind == 'angle' and s.of == motor.pulley
            ]
            d[at['ENCODER'] + j] = encoders[0] if encoders else 0
        m[at['PERIOD']] = one.control_period
        m[at['TOLERANCE']] = tolerance
        m[at['STILL']] = 1e-3

    def _write_drives(self, prescribed: Mapping[str, int], pushed: Mapping[str, int]) -> None:
        one, at, d = self.instrument, self.structure, self._d
        for place in ('MOTION', 'PUSH', 'BRISTLE'):
            d[at[place] : at[place] + at['N']] = -1
        for place in ('REFERENCE', 'INTEGRAL'):
            d[at[place] : at[place] + len(one.motors)] = -1
        for name, signal in prescribed.items():
            i = self._kernel_place[one.index(name)]
            d[at['DRIVE'] + i] = 1
            d[at['MOTION'] + i] = signal
        for name, signal in pushed.items():
            d[at['PUSH'] + self._kernel_place[one.index(name)]] = signal
        d[at['DRIVEN']] = len(prescribed)
        d[at['PUSHED']] = len(pushed)

    def _scattered(self) -> list[tuple[str, IntArray, IntArray]]:
        """Return where in ``m`` each number stands that effects may change, and what of it."""
        at = self.structure
        order = np.array(at.order)
        found = [
            (name, at[name.upper()] + np.arange(len(order)), order)
            for name in ('inertia', 'damping', 'breakaway', 'dither')
        ]
        for name in PLAIN:
            every = np.arange(len(self._numbers[name]))
            found.append((name, at[name.upper()] + every, every))
        entries = [(k, e, i) for k, row in enumerate(at.loop_pulley) for e, i in enumerate(row)]
        there = np.array([at['WIDTH'] * k + e for k, e, _ in entries], dtype=np.int64)
        own = np.array([len(order) * k + order[i] for k, _, i in entries], dtype=np.int64)
        return [*found, ('radius', at['RADIUS'] + there, own), ('arm', at['ARM'] + there, own)]

    def _write_numbers(self, m: FloatArray, d: IntArray, numbers: Numbers) -> None:
        one, at = self.instrument, self.structure
        for name, there, own in self._moving:
            m[there] = numbers[name].ravel()[own]
        _put(m, at['LASH'], 0.5 * numbers['lash'][list(at.order)])
        late, lag = numbers['sensor_delay'], numbers['sensor_lag'] / one.control_period
        d[at['REMEMBERS']] = int((late > 0.0).any() or (lag > 0.0).any())
        _put(m, at['SENSOR_LAG'], lag)
        _put(m, at['SENSOR_KEPT'], np.exp(-1.0 / np.maximum(lag, 1e-3)))
        if (late > (RING - 2) * one.control_period).any():
            raise EffectError(
                f'{one.name}: a sensor is delayed by more than {RING - 2} controller periods '
                f'({(RING - 2) * one.control_period:g} s), which is all that is remembered'
            )
        _put(d, at['SENSOR_RECTIFIED'], (numbers['sensor_rectified'] >= 0.5).astype(np.float64))

    def _write_laws(self, m: FloatArray, d: IntArray, tail: list[float], laws: Laws) -> list[int]:
        """Write the laws and their memories; return the rows that stand behind ``d``."""
        one, at = self.instrument, self.structure
        states: list[tuple[int, int]] = []
        for law in laws.acting['budget']:
            i = self._kernel_place[law.where]
            if laws.numbers['breakaway'][law.where] > 0.0:
                if d[at['BRISTLE'] + i] < 0:
                    d[at['BRISTLE'] + i] = len(states)
                    states.append((-1, i))
            else:
                d[at['DRY'] + i] = 1
        d[at['BRISTLED']] = len(states)
        for j, motor in enumerate(one.motors):
            if motor.name in self._references:
                d[at['REFERENCE'] + j] = self._references[motor.name]
                d[at['INTEGRAL'] + j] = len(states)
                states.append((-1, at.motor_pulley[j]))
        rows: list[int] = []
        for hook in HOOKS:
            d[at[f'{hook.upper()}S']] = len(d) + len(rows)
            d[at[f'{hook.upper()}S'] + 1] = len(laws.acting[hook])
            for law in laws.acting[hook]:
                where = self._kernel_place[law.where] if hook in ON_PULLEYS else law.where
                state = -1
                if law.stateful:
                    state = len(states)
                    states.append((where, -1))
                rows += [law.number, where, len(m) + len(tail), state]
                tail += law.values
        if len(states) > at['STATES']:
            raise EffectError(
                f'{one.name}: {len(states)} effects with a memory at once, room for '
                f'{at["STATES"]}; leave some out'
            )
        d[at['ACTIVE']] = len(states)
        for z, (loop, pulley) in enumerate(states):
            d[at['STATE_LOOP'] + z] = loop
            d[at['STATE_PULLEY'] + z] = pulley
        return rows

    def _write_curves(
        self, m: FloatArray, d: IntArray, tail: list[float], numbers: Numbers
    ) -> None:
        one, at = self.instrument, self.structure
        placed: dict[Curve, tuple[int, int, float, float]] = {}
        for k, loop in enumerate(one.loops):
            curve = hardened(self._curves[loop.curve], float(numbers['hardening'][k]))
            if curve not in placed:
                start, rate, cubic = uniform_cubic(curve)
                placed[curve] = (len(m) + len(tail), len(cubic), start, rate)
                tail += cubic.ravel().tolist()
            _point(at, m, d, k, placed[curve], 0.0)
            scale = numbers['scale'][k]
            m[at['PRELOAD'] + k] = elongation_at(curve, float(numbers['pretension'][k] / scale))
        for c, coupling in enumerate(one.couplings):
            k = len(one.loops) + c
            # two "cables" of half the stiffness that also push: one linear cell, both ways
            half = 0.5 * coupling.stiffness
            where = (len(m) + len(tail), 1, 0.0, 1.0)
            tail += [0.0, half, 0.0, 0.0]
            _point(at, m, d, k, where, half)


def _point(
    at: Structure,
    m: FloatArray,
    d: IntArray,
    k: int,
    where: tuple[int, int, float, float],
    below: float,
) -> None:
    """Write where the curve of a link lies, and what it does below its beginning."""
    offset, cells, start, rate = where
    d[at['CURVE_OFFSET'] + k] = offset
    d[at['CURVE_CELLS'] + k] = cells
    m[at['CURVE_START'] + k] = start
    m[at['CURVE_RATE'] + k] = rate
    m[at['CURVE_BELOW'] + k] = below


def _put(array: NDArray[np.generic], at: int, values: Sequence[float] | FloatArray) -> None:
    array[at : at + len(values)] = np.asarray(values)
