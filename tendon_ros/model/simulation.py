"""
A running simulation: the one step that live node, batch and observer share.

:meth:`Simulation.run` advances any number of controller periods; running a thousand at once and
one a thousand times gives the same numbers bit for bit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import InstrumentError, listed, SimulationError, TrajectoryError
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.layout import Arrays, arrays_of, Layout
from tendon_ros.model.rows import joined, Rows
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]

#: local error of an angle in one step [rad]; docs/kernel.md shows what it gives over ten seconds
TOLERANCE = 1e-7


class Simulation:
    """
    An instrument in motion.

    :param instrument: the network, with the effects that are in force.
    :param seed: of the sensors' noise; None leaves all noise off.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    :param tolerance: local error of an angle in one step [rad].
    :param pose: angles to start from [rad], by pulley; those not named start at zero.
    :raises InstrumentError, EffectError: on an instrument that cannot be simulated.
    """

    def __init__(
        self,
        instrument: Instrument,
        *,
        seed: int | None = None,
        engine: str = 'auto',
        tolerance: float = TOLERANCE,
        pose: Mapping[str, float] | None = None,
    ) -> None:
        if loose := instrument.uncontrolled:
            raise InstrumentError(
                f'{instrument.name}: nothing makes {listed(loose)} follow a command: give '
                f'motors.{loose[0]}.controller, such as {{kp: 10 N*m/rad, limit: 2 N*m}}; without '
                'one, recordings can be diagnosed, and their force estimated'
            )
        self._instrument = instrument
        self._seed = seed
        self._tolerance = tolerance
        continuous = instrument.continuous_control
        names = instrument.motor_names if continuous else ()
        self._references = {name: row for row, name in enumerate(names)}
        arrays = arrays_of(instrument, references=self._references, tolerance=tolerance)
        self._runner = Runner(instrument, arrays, engine)
        self.reset(pose)

    @property
    def instrument(self) -> Instrument:
        """The instrument with the effects now in force."""
        return self._instrument

    @property
    def engine(self) -> str:
        """``compiled`` or ``plain``."""
        return self._runner.engine.name

    @property
    def time(self) -> float:
        """Simulated time [s] since the last reset."""
        return self._runner.time

    @property
    def counts(self) -> Mapping[str, int]:
        """Steps, rejected steps and located events since the last reset."""
        return self._runner.counts

    def reset(self, pose: Mapping[str, float] | None = None) -> None:
        """
        Put the mechanics at rest, the clock at zero and the noise at its beginning.

        :param pose: angles [rad] by pulley; those not named are zero.
        """
        self._runner.rest(pose or {})
        self._noise = None if self._seed is None else np.random.default_rng(self._seed)

    def run(self, setpoints: FloatArray, every: int = 1) -> Rows:
        """
        Advance one controller period for each row of set-points.

        A continuous controller sees each set-point held over its period.

        :param setpoints: positions wished for the motors [rad], shape (ticks, motors).
        :param every: record every so many ticks.
        :return: what was recorded, at the beginning of each recorded tick.
        :raises TrajectoryError: on set-points of the wrong shape, or not finite.
        :raises SimulationError: where the simulation diverges; names the time.
        """
        wished = self._checked(setpoints)
        if not self._references:
            noise = self._draw(len(wished))
            return self._runner.advance(wished, len(wished), every=every, noise=noise)
        return joined(
            [
                self._runner.advance(
                    row, 1, every=every, signals=Signals.held(row), noise=self._draw(1)
                )
                for row in wished
            ]
        )

    def follow(self, setpoints: FloatArray | Signals, every: int = 1) -> Rows:
        """
        Advance continuous controllers along a reference known beforehand, without stops at ticks.

        :param setpoints: as in :meth:`run`; the reference is monotone cubic between them. Or that
            reference itself, which many rollouts can share: a signal for each motor, sampled
            at the controllers' period from the present time on.
        :param every: record every so many ticks.
        :return: what was recorded, from the first set-point to the last.
        :raises SimulationError: where the instrument's controllers are sampled, or on divergence.
        """
        if not self._references:
            raise SimulationError(
                f'{self._instrument.name}: its controllers are sampled; use run(), or write '
                "'rate: continuous' into its control section"
            )
        if isinstance(setpoints, Signals):
            signals = setpoints
        else:
            wished = self._checked(setpoints)
            signals = Signals.through(self.time, self._instrument.control_period, wished.T)
        samples = signals.value.shape[1]
        return self._runner.advance(
            np.zeros(0),
            samples - 1,
            every=every,
            smoothly=True,
            signals=signals,
            noise=self._draw(samples),
        )

    def use_effects(self, effects: Sequence[EffectUse]) -> None:
        """
        Change the effects in force while the mechanics goes on as it is.

        :param effects: all effects that hold from now on.
        :raises EffectError: on an effect that cannot act; nothing is changed then.
        """
        self._change(replace(self._instrument, effects=tuple(effects)))

    def use_contact(self, name: str, *, enabled: bool) -> None:
        """
        Put a contact in the way, or take it away.

        :param name: the contact.
        :param enabled: whether it is there.
        :raises SimulationError: where there is no such contact.
        """
        contacts = {c.name: c for c in self._instrument.contacts}
        if name not in contacts:
            raise SimulationError(f'{self._instrument.name}: no contact {name!r}')
        contacts[name] = replace(contacts[name], enabled=enabled)
        self._change(replace(self._instrument, contacts=tuple(contacts.values())))

    def _change(self, instrument: Instrument) -> None:
        self._runner.load(
            arrays_of(instrument, references=self._references, tolerance=self._tolerance)
        )
        self._instrument = instrument

    def _draw(self, ticks: int) -> FloatArray | None:
        if self._noise is None:
            return None
        return self._noise.standard_normal((ticks, len(self._instrument.sensors)))

    def _checked(self, setpoints: FloatArray) -> FloatArray:
        wished = np.atleast_2d(np.asarray(setpoints, dtype=np.float64))
        names = self._instrument.motor_names
        if wished.ndim != 2 or wished.shape[1] != len(names):
            raise TrajectoryError(
                f'{self._instrument.name}: set-points of shape {np.shape(setpoints)}; give one '
                f'column for each motor ({", ".join(names)})'
            )
        bad = np.argwhere(~np.isfinite(wished))
        if bad.size:
            row, column = bad[0]
            raise TrajectoryError(
                f'{self._instrument.name}: set-point {row} of motor {names[column]} is not a '
                'finite number'
            )
        return wished


def predict(
    instrument: Instrument,
    motion: Signals,
    prescribed: Sequence[str],
    ticks: int,
    *,
    effects: Sequence[EffectUse] | None = None,
    pushed: Sequence[str] = (),
    every: int = 1,
    engine: str = 'auto',
    tolerance: float = TOLERANCE,
    pose: Mapping[str, float] | None = None,
) -> Rows:
    """
    Drive the model with given motion and predict everything else: open loop, no controller.

    :param instrument: the network; its control period is the sampling period.
    :param motion: signals: first those of the prescribed pulleys, then those of the pushed ones.
    :param prescribed: pulleys whose motion is given.
    :param ticks: periods to advance.
    :param effects: effects in force; those of the instrument where None.
    :param pushed: pulleys that a given torque [N m] acts on.
    :param every: record every so many ticks.
    :param engine: as for :class:`Simulation`.
    :param tolerance: as for :class:`Simulation`.
    :param pose: angles to start from [rad] for the other pulleys; zero where not given.
    :return: rows; the efforts are the torques that the motion asks of the motors.
    """
    layout = along(instrument, prescribed, pushed, tolerance)
    arrays = layout.arrays(instrument.effects if effects is None else effects)
    return follow(instrument, arrays, motion, ticks, every=every, engine=engine, pose=pose)


def along(
    instrument: Instrument,
    prescribed: Sequence[str],
    pushed: Sequence[str] = (),
    tolerance: float = TOLERANCE,
) -> Layout:
    """
    Return the layout of a model that signals drive: whoever asks for many effects keeps it.

    :param instrument: the network.
    :param prescribed: pulleys whose motion is given, in the first rows of the signals.
    :param pushed: pulleys that a given torque acts on, in the rows after them.
    :param tolerance: as for :class:`Simulation`.
    :return: the layout.
    """
    return Layout(
        instrument,
        {name: row for row, name in enumerate(prescribed)},
        {name: row for row, name in enumerate(pushed, start=len(prescribed))},
        tolerance=tolerance,
    )


def follow(
    instrument: Instrument,
    arrays: Arrays,
    motion: Signals,
    ticks: int,
    *,
    every: int = 1,
    engine: str = 'auto',
    pose: Mapping[str, float] | None = None,
    resting: float = 0.0,
    loose: Mapping[str, tuple[float, float]] | None = None,
) -> Rows:
    """
    Drive a model whose arrays are there already, from :func:`along`, as :func:`predict` does.

    :param instrument: the network.
    :param arrays: its numbers.
    :param motion: signals, in the rows that the arrays know.
    :param ticks: periods to advance.
    :param every: record every so many ticks.
    :param engine: as for :class:`Simulation`.
    :param pose: as for :func:`predict`.
    :param resting: how long the signals had been where they begin [s]: what the effects in force
        make of the pose has happened by then.
    :param loose: angles [rad] and speeds [rad/s] of pulleys that nothing holds, wherever they
        would come to rest.
    :return: rows.
    """
    runner = Runner(instrument, arrays, engine)
    runner.rest(pose or {})
    before = runner.settle(resting, Signals.held(motion.value[:, 0])) if resting > 0.0 else 0
    runner.hang(loose or {})
    rows = runner.advance(np.zeros(0), ticks, every=every, smoothly=True, signals=motion)
    return replace(rows, steps=before + rows.steps)
