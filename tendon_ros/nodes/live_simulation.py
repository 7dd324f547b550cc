"""
A simulation that follows the clock and takes commands: the simulator node without its ROS.

Whatever the loop does, physics advances in whole controller periods and a command acts from the
next period on, so the behaviour of the instrument does not depend on the loop's rate or jitter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from threading import Lock

import numpy as np

from tendon_ros.bags.stamps import IntArray, to_stamps
from tendon_ros.base.errors import SimulationError, TrajectoryError
from tendon_ros.base.recording import FloatArray
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.recorded import channel_values
from tendon_ros.model.simulation import Simulation
from tendon_ros.nodes.motion import Motion, plan
from tendon_ros.nodes.pace import Pace


@dataclass(frozen=True)
class Samples:
    """What a rig would have measured: header ``stamps`` [ns] and each channel, shape (n,) each."""

    stamps: IntArray
    values: Mapping[str, FloatArray]

    def rows(self) -> Iterator[tuple[int, dict[str, float]]]:
        """Yield each stamp [ns] with the value of every channel."""
        columns = {name: column.tolist() for name, column in self.values.items()}
        for n, stamp in enumerate(self.stamps.tolist()):
            yield stamp, {name: column[n] for name, column in columns.items()}


class LiveSimulation:
    """
    Steps a simulation by elapsed time; its methods may be called from any thread.

    Time begins with :meth:`reset`.

    :param simulation: the instrument, at rest.
    :param every: controller periods from one sample to the next.
    :param move_speed: speed that planned motions reach [rad/s]; less where a motor allows less.
    """

    def __init__(self, simulation: Simulation, *, every: int, move_speed: float) -> None:
        self._simulation = simulation
        self._every = every
        self._lock = Lock()
        motors = simulation.instrument.motors
        #: the joints that can be commanded, in order
        self.joints = tuple(f'pulley_{motor.pulley}' for motor in motors)
        limits = {j: m.position_limit for j, m in zip(self.joints, motors, strict=True)}
        self._limits = limits
        self._speeds = {
            j: min(m.speed_limit, move_speed) for j, m in zip(self.joints, motors, strict=True)
        }
        self._last_ns = 0
        self._start(0, 0.0)

    def _start(self, epoch_ns: int, now: float) -> None:
        self._epoch_ns = epoch_ns
        self._ticks = 0
        self._failure: SimulationError | None = None
        self._held = dict.fromkeys(self.joints, 0.0)
        self._motion: Motion | None = None
        self._pace = Pace(self.instrument.control_period, now)

    @property
    def instrument(self) -> Instrument:
        """The instrument with the effects now in force."""
        return self._simulation.instrument

    @property
    def time(self) -> float:
        """Simulated time [s] since the last reset."""
        return self._ticks * self.instrument.control_period

    @property
    def slipped(self) -> float:
        """Simulated time [s] given up since the last reset because the machine was too slow."""
        return self._pace.slipped

    @property
    def failure(self) -> SimulationError | None:
        """Why the simulation cannot go on; None where it can, as after a reset."""
        return self._failure

    @property
    def is_busy(self) -> bool:
        """Whether a planned motion is under way."""
        motion = self._motion
        return motion is not None and self.time < motion.end

    def wait(self, now: float) -> float:
        """Return how long to sleep [s] before the next sample is due at the steady time."""
        return self._pace.wait(now, self._every)

    def advance(self, now: float) -> Samples | None:
        """
        Run the physics up to now.

        :param now: a steady clock [s].
        :return: the samples that came due, None where there are none.
        :raises SimulationError: where the simulation diverged; from then on nothing comes until
            :meth:`reset`.
        """
        with self._lock:
            ticks = self._pace.due(now)
            if not ticks or self._failure is not None:
                return None
            first = self._ticks
            wished = self._setpoints(first, ticks)
            try:
                rows = self._simulation.run(wished, self._every)
            except SimulationError as error:
                self._failure = error
                raise
            self._ticks += ticks
            if not len(rows):
                return None
            stamps = to_stamps(rows.time, self._epoch_ns)
            self._last_ns = int(stamps[-1])
            sampled = wished[-first % self._every :: self._every]
            return Samples(stamps, channel_values(rows, sampled))

    def servo(self, wanted: Mapping[str, float]) -> None:
        """
        Hold other positions from the next period on; ends a planned motion.

        :param wanted: position [rad] by joint; joints that are left out stay where they are.
        :raises TrajectoryError: beyond a limit; nothing is changed then.
        """
        self._check(wanted)
        with self._lock:
            self._held = {**self._now(), **wanted}
            self._motion = None

    def move(self, goal: Mapping[str, float]) -> None:
        """
        Move smoothly to a goal and stay there.

        :param goal: position [rad] by joint; joints that are left out stay where they are.
        :raises TrajectoryError: beyond a limit; nothing is changed then.
        """
        self._check(goal)
        with self._lock:
            held = self._now()
            self._motion = plan(held, goal, self.time, self._speeds)
            self._held = {**held, **goal}

    def hold(self) -> None:
        """Stay at the present set-points; ends a planned motion."""
        self.servo({})

    def reset(self, epoch_ns: int, now: float) -> None:
        """
        Put the mechanics at rest at zero, the clock at zero and the set-points at zero.

        :param epoch_ns: header stamp of time zero [ns]; later where stamps would step back.
        :param now: the same moment on the steady clock [s].
        """
        with self._lock:
            self._simulation.reset()
            self._start(max(epoch_ns, self._last_ns + 1_000_000), now)

    def use_effects(self, effects: Sequence[EffectUse]) -> None:
        """
        Change the effects in force.

        :param effects: all that hold from the next period on.
        :raises EffectError: on an effect that cannot act; nothing is changed then.
        """
        with self._lock:
            self._simulation.use_effects(effects)

    def use_contact(self, *, enabled: bool) -> None:
        """
        Put all contacts in the way, or take them away.

        :param enabled: whether they are there.
        :raises SimulationError: where the instrument has none.
        """
        names = [contact.name for contact in self.instrument.contacts]
        if not names:
            raise SimulationError(
                f'{self.instrument.name}: has no contact; add one to the instrument file'
            )
        with self._lock:
            for name in names:
                self._simulation.use_contact(name, enabled=enabled)

    def _now(self) -> dict[str, float]:
        """Return the set-points of this moment."""
        if self._motion is None:
            return dict(self._held)
        return dict(zip(self.joints, self._motion.at(np.array([self.time]))[0], strict=True))

    def _setpoints(self, first: int, ticks: int) -> FloatArray:
        if self._motion is not None:
            period = self.instrument.control_period
            return self._motion.at(period * np.arange(first, first + ticks, dtype=np.float64))
        return np.tile(np.array(list(self._held.values())), (ticks, 1))

    def _check(self, wanted: Mapping[str, float]) -> None:
        for name, value in wanted.items():
            low, high = self._limits[name]
            if not low <= value <= high:
                raise TrajectoryError(
                    f'command for {name}: {value:g} rad is beyond its limits '
                    f'{low:g} to {high:g} rad; the last set-point is held'
                )
