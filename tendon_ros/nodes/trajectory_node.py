"""The node behind ``trajectory``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import math
import time

import numpy as np
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from tendon_ros.bags.topics import joint_channel
from tendon_ros.base.errors import listed, TendonError, TrajectoryError
from tendon_ros.base.recording import FloatArray
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.trajectory import check_limits
from tendon_ros.model.trajectory_choice import chosen_trajectory, profiles
from tendon_ros.nodes.arrivals import STALE
from tendon_ros.nodes.conversions import joint_values
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.motion import plan
from tendon_ros.nodes.settings import Value
from tendon_ros.nodes.tendon_node import TendonNode
from tendon_ros.nodes.trajectory import PROGRAM
from tendon_ros.nodes.wire import wires_for

#: how often to say what the start waits for [s]
REMIND = 5.0

#: motors this near to the first point need no smooth way to it [rad]
THERE = 1e-4


class TrajectoryNode(TendonNode):
    """
    Streams set-points, from where the motors are to the last point.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        self.refuse_unknown_parameters()
        instrument = load_instrument(str(values['instrument']))
        name = str(values['trajectory'])
        self._trajectory = chosen_trajectory(
            name, instrument.motor_names, _settings_of(name, values)
        )
        check_limits(self._trajectory, instrument)
        self._speeds = {f'pulley_{m.pulley}': m.speed_limit for m in instrument.motors}
        self._joints = list(self._speeds)
        self._period = 1.0 / float(values['rate'])
        self._repeats = int(values['repeats'])
        self._approach = float(values['approach'])
        self._exit = bool(values['exit_when_done'])
        self._patience = float(values['patience'])
        self._measured: dict[str, float] | None = None
        self._measured_at = -math.inf
        self._begun = False
        self._progress = 'waiting for the motors'
        self._sent_ns = 0
        # A command looks like the set-points that the robot says it has.
        names = [joint_channel('actuator/setpoint_js', j, 'position') for j in self._joints]
        [self._wire] = wires_for(names)
        self._commands = self.create_publisher(JointState, 'actuator/servo_jp', 10)
        self._ear = self.create_subscription(
            JointState, 'actuator/measured_js', self._on_measured, 10, raw=True
        )

    def begin(self) -> None:
        """Start to wait for the motors."""
        self.work('trajectory', self._drive)

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return how far it is."""
        return Level.OK, self._progress, {'trajectory': self._trajectory.name}

    def _on_measured(self, cdr: bytes) -> None:
        # Where the motors are matters only before the start.
        if self._begun:
            return
        try:
            message = deserialize_message(cdr, JointState)
            values = joint_values('actuator/measured_js', message, self._joints)
        except TendonError as error:
            self.complain('measurements left out', f'actuator/measured_js: {error}')
            return
        found = {j: values.get(f'actuator/{j}/position', math.nan) for j in self._joints}
        unknown = [joint for joint, position in found.items() if not math.isfinite(position)]
        if unknown:
            text = f'actuator/measured_js: no finite position of {listed(unknown)}'
            self.complain('measurements left out', text)
            return
        self._measured, self._measured_at = found, time.monotonic()

    def _drive(self) -> None:
        """Wait, approach, run, repeat; in a thread, because a timer jitters more."""
        if not self._wait() or self._measured is None:
            return
        self._begun = True
        position = self._measured
        self.get_logger().info(
            f'{self._trajectory.name}: {self._trajectory.duration:g} s, '
            f'{self._repeats or "endless"} times, at {1.0 / self._period:g} Hz'
        )
        done = 0
        end = self._trajectory.duration
        while not self._repeats or done < self._repeats:
            self._progress = f'on the way to run {done + 1}'
            self._reach_first(position)
            self._progress = f'run {done + 1}'
            self._stream(end, self._trajectory.at)
            if self.stopping.is_set():
                break
            position = self._by_joint(end)
            done += 1
        self._progress = 'stopped' if self.stopping.is_set() else 'done'
        self.get_logger().info(f'{self._trajectory.name}: {self._progress} after {done} runs')
        self.finished = self._exit

    def _reach_first(self, position: Mapping[str, float]) -> None:
        """Send the motors to the first point, smoothly and within their speeds, if need be."""
        first = self._by_joint(0.0)
        far = max(abs(first[joint] - position[joint]) for joint in first)
        if self._approach and far > THERE:
            way = plan(position, first, 0.0, self._speeds, shortest=self._approach)
            self._stream(way.end, lambda t: way.at(np.array([t]))[0])

    def _by_joint(self, passed: float) -> dict[str, float]:
        """Return the trajectory's positions so long after its begin."""
        return dict(zip(self._joints, self._trajectory.at(passed).tolist(), strict=True))

    def _wait(self) -> bool:
        """Return whether the motors speak and listen, before patience or the node's life ended."""
        begin = time.monotonic()
        said = begin
        # a command that nobody takes yet is lost, the first of a motion like any other
        while self._unheard or not self._commands.get_subscription_count():
            if self.stopping.wait(0.05):
                return False
            now = time.monotonic()
            if self._patience and now - begin > self._patience:
                self.failure = TrajectoryError(
                    f'{self._missing()} after {self._patience:g} s; start '
                    'the simulator or the robot, or look for another namespace or ROS_DOMAIN_ID'
                )
                return False
            if now - said > REMIND:
                said = now
                self.get_logger().warning(
                    f'{self._missing()} after {now - begin:.0f} s; is the simulator or the robot '
                    'running, in this namespace and ROS_DOMAIN_ID?'
                )
        return True

    @property
    def _unheard(self) -> bool:
        """Whether nobody knows where the motors are now."""
        return time.monotonic() - self._measured_at > STALE

    def _missing(self) -> str:
        """Return what the start waits for."""
        if self._unheard:
            return f'{self._ear.topic_name}: nothing measured'
        return f'{self._commands.topic_name}: nobody takes commands'

    def _stream(self, duration: float, at: Callable[[float], FloatArray]) -> None:
        """Send positions until the duration has passed; a late loop skips, it does not lag."""
        begin = time.monotonic()
        step = 0
        while not self.stopping.is_set():
            passed = min(time.monotonic() - begin, duration)
            self._send(at(passed))
            if passed >= duration:
                return
            step = max(step + 1, int(passed / self._period) + 1)
            time.sleep(
                max(min(begin + step * self._period, begin + duration) - time.monotonic(), 0.0)
            )

    def _send(self, position: FloatArray) -> None:
        # Clients of a robot expect stamps that increase, also when the system's clock is set back.
        self._sent_ns = max(time.time_ns(), self._sent_ns + 1)
        values = dict(zip(self._wire.channels, position.tolist(), strict=True))
        self._commands.publish(self._wire.encode(self._sent_ns, values))


def _settings_of(name: str, values: Mapping[str, Value]) -> dict[str, str | float]:
    """Return the settings of the chosen profile that differ from their defaults."""
    defaults = {one.name: one.default for one in PROGRAM.settings}
    return {
        key.removeprefix(f'{name}.'): value
        for key, value in values.items()
        if name in profiles() and key.startswith(f'{name}.') and value != defaults[key]
    }
