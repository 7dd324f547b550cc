"""The kernel with its arrays and its carried state: what all running stands on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import SimulationError
from tendon_ros.model.engine import Engine, engine_for
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.layout import Arrays
from tendon_ros.model.rows import Rows
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]


class Runner:
    """
    One kernel in motion. Not for users: see :mod:`tendon_ros.model.simulation`.

    :param instrument: names and orders for what is returned.
    :param arrays: its numbers.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    """

    def __init__(self, instrument: Instrument, arrays: Arrays, engine: str = 'auto') -> None:
        self.instrument = instrument
        self.structure = arrays.structure
        self.engine: Engine = engine_for(arrays.structure, engine)
        self._work = self.engine.zeros(arrays.structure.length('w'))
        self.rest({})
        self.load(arrays)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self._carried[self.structure['CLOCK']])

    @property
    def tick(self) -> int:
        """Controller periods passed."""
        return int(self._carried[self.structure['TICK']])

    @property
    def counts(self) -> Mapping[str, int]:
        """Steps, rejected steps and located events so far."""
        at = self.structure['COUNT']
        found = (int(n) for n in self._modes[at : at + 3])
        return dict(zip(('steps', 'rejected', 'events'), found, strict=True))

    @property
    def _tried(self) -> int:
        """Steps so far, those that were rejected as well."""
        at = self.structure['COUNT']
        return int(self._modes[at]) + int(self._modes[at + 1])

    @property
    def width(self) -> int:
        """Columns of a recorded row."""
        return self.structure['READINGS'] + len(self.instrument.sensors)

    def load(self, arrays: Arrays) -> None:
        """
        Take other numbers from now on; memories begin anew where their meaning changed.

        :param arrays: of the same structure.
        """
        at = self.structure
        new = arrays.d[at['ACTIVE'] : at['BREAKS']]
        old = getattr(self, '_memories', new)
        if not np.array_equal(new, old):
            for n in range(2 * at['N'], at['DIM']):
                self._state[n] = 0.0
        for i in range(at['N']):
            self._modes[at['MODE'] + i] = 2  # what slides and what sticks is seen anew
        self._memories = new.copy()
        self._m: Any = self.engine.array(arrays.m)
        self._d: Any = self.engine.array(arrays.d)
        self._no_signals: Any = self.engine.array(Signals.none().flat)

    def rest(self, pose: Mapping[str, float]) -> None:
        """
        Put the mechanics at rest and the clock at zero.

        :param pose: angles [rad] by pulley; those not named are zero.
        """
        at = self.structure
        angles = np.zeros(at['DIM'])
        for name, angle in pose.items():
            angles[at.order.index(self.instrument.index(name))] = angle
        carried = np.zeros(at.length('c'))
        carried[at['STEP']] = 0.1 * self.instrument.control_period
        carried[at['LAST'] : at['LAST'] + at['U']] = 1e301
        carried[at['SMOOTH'] : at['SMOOTH'] + len(self.instrument.sensors)] = 1e301
        carried[at['DRUM'] : at['DRUM'] + at['N']] = angles[: at['N']]
        modes = np.zeros(at.length('g'), dtype=np.int64)
        modes[at['MODE'] : at['MODE'] + at['N']] = 2
        self._state = self.engine.array(angles)
        self._carried = self.engine.array(carried)
        self._modes = self.engine.array(modes)

    def advance(
        self,
        setpoints: FloatArray,
        ticks: int,
        *,
        every: int = 1,
        smoothly: bool = False,
        signals: Signals | None = None,
        noise: FloatArray | None = None,
    ) -> Rows:
        """
        Advance a number of controller periods.

        :param setpoints: for sampled controllers [rad], shape (ticks, motors).
        :param ticks: how many periods.
        :param every: record every so many.
        :param smoothly: do not stop at ticks; nothing sampled acts then.
        :param signals: prescribed motion, torques and references.
        :param noise: standard normal numbers, one for each tick and sensor; none where None.
        :return: what was recorded.
        :raises SimulationError: where it diverges.
        """
        at = self.structure
        before = self._tried
        last = self.tick + ticks - (0 if smoothly else 1)
        count = last // every - (self.tick - 1) // every
        rows = self.engine.zeros(count * self.width)
        self._carried[at['ROOM']] = float(count)
        self._carried[at['NOISY']] = 0.0 if noise is None else 1.0
        status = self.engine.module.rollout(
            self._m,
            self._d,
            self._work,
            self._modes,
            self.engine.array((signals or Signals.none()).flat),
            self._carried,
            self._state,
            self.engine.array(np.ravel(setpoints)),
            ticks,
            self.engine.zeros(0) if noise is None else self.engine.array(np.ravel(noise)),
            rows,
            every,
            int(smoothly),
        )
        if status != 0:
            raise SimulationError(
                f'{self.instrument.name}: the simulation diverged near {self.time:.4f} s; check '
                'gains, damping and inertias, or ask for a smaller tolerance'
            )
        written = int(self._carried[at['ROW']])
        table = np.asarray(rows, dtype=np.float64).reshape(-1, self.width)[:written]
        return Rows(self.instrument, at, table, self._tried - before)

    def glide(self, end: float, signals: Signals) -> Rows:
        """
        Go on to a time that need not be a tick: for observers, which follow the stamps they get.

        :param end: [s], after the present time.
        :param signals: prescribed motion, torques and references.
        :return: one row, at ``end``.
        :raises SimulationError: where it diverges; all is then as it was.
        """
        at = self.structure
        before = self._tried
        kept = self.kept()
        row = self.engine.zeros(self.width)
        status = self.engine.module.glide(
            self._m,
            self._d,
            self._work,
            self._modes,
            self.engine.array(signals.flat),
            self._carried,
            self._state,
            end,
            row,
        )
        if status != 0:
            self.back(kept)
            raise SimulationError(f'{self.instrument.name}: the model diverged near {end:.4f} s')
        table = np.array(row, dtype=np.float64).reshape(1, -1)
        return Rows(self.instrument, at, table, self._tried - before)

    def settle(self, seconds: float, signals: Signals) -> int:
        """
        Let the mechanics come to rest before the clock strikes zero, where :meth:`rest` put it.

        :param seconds: how long before [s].
        :param signals: what drives meanwhile, held.
        :return: the steps that it took.
        :raises SimulationError: where it diverges.
        """
        at = self.structure
        self._carried[at['CLOCK']] = -seconds
        steps = self.glide(0.0, signals).steps
        self._carried[at['STEP']] = 0.1 * self.instrument.control_period
        return steps

    def place(self, angle: FloatArray, velocity: FloatArray) -> None:
        """
        Put the pulleys somewhere, memories unchanged.

        :param angle: [rad], shape (pulleys,), in the instrument's order.
        :param velocity: [rad/s], shape (pulleys,).
        """
        at = self.structure
        n = at['N']
        for i, own in enumerate(at.order):
            self._state[i] = float(angle[own])
            self._state[n + i] = float(velocity[own])

    def hang(self, loose: Mapping[str, tuple[float, float]]) -> None:
        """
        Put some pulleys somewhere, all else unchanged.

        :param loose: angles [rad] and speeds [rad/s] by pulley.
        """
        at = self.structure
        for name, (angle, speed) in loose.items():
            own = at.order.index(self.instrument.index(name))
            self._state[own], self._state[at['N'] + own] = angle, speed

    def bend(self, place: NDArray[np.intp], part: FloatArray) -> None:
        """
        Set memories one by one, those of pre-sliding friction for instance.

        :param place: of each in the state.
        :param part: what it is to be.
        """
        for n, value in zip(place.tolist(), part.tolist(), strict=True):
            self._state[n] = value

    def bending(self, place: NDArray[np.intp]) -> FloatArray:
        """
        Return memories one by one.

        :param place: of each in the state.
        :return: what they are.
        """
        return np.array([self._state[n] for n in place.tolist()], dtype=np.float64)

    def kept(self) -> tuple[Any, ...]:
        """Return where everything is, for :meth:`back`."""
        return tuple(np.array(one) for one in (self._state, self._carried, self._modes))

    def back(self, kept: tuple[Any, ...]) -> None:
        """
        Put everything back to where it was.

        :param kept: from :meth:`kept`.
        """
        self._state, self._carried, self._modes = (self.engine.array(one) for one in kept)

    @property
    def memories(self) -> int:
        """How many auxiliary states friction, cables and controllers have."""
        return int(self._d[self.structure['ACTIVE']])

    @property
    def work(self) -> Any:
        """The kernel's scratch, at the places that the structure names."""
        return self._work

    def weigh(self) -> None:
        """Evaluate and linearise the forces where the pulleys are, without moving on."""
        self.engine.module.weigh(
            self._m,
            self._d,
            self._work,
            self._modes,
            self._no_signals,
            self._carried,
            self._state,
        )
