"""The node behind ``trajectory``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import threading
import time

import numpy as np
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from tendon_ros.bags.topics import joint_channel
from tendon_ros.base.errors import TendonError, TrajectoryError
from tendon_ros.base.recording import FloatArray
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.trajectory import check_limits
from tendon_ros.model.trajectory_choice import chosen, profiles
from tendon_ros.nodes.conversions import joint_values
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.motion import Motion
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
    Streams set-points, from the first measurement to the last point.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        self.refuse_unknown_parameters()
        instrument = load_instrument(str(values['instrument']))
        name = str(values['trajectory'])
        self._trajectory = chosen(name, instrument.motor_names, _settings_of(name, values))
        check_limits(self._trajectory, instrument)
        self._joints = [f'pulley_{pulley}' for pulley in instrument.driven]
        self._period = 1.0 / float(values['rate'])
        self._repeats = int(values['repeats'])
        self._approach = float(values['approach'])
        self._exit = bool(values['exit_when_done'])
        self._patience = float(values['patience'])
        self._measured: dict[str, float] | None = None
        self._heard = threading.Event()
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
        if self._heard.is_set():
            return
        try:
            message = deserialize_message(cdr, JointState)
            values = joint_values('actuator/measured_js', message, self._joints)
            self._measured = {
                joint: values[f'actuator/{joint}/position'] for joint in self._joints
            }
        except (TendonError, KeyError) as error:
            self.complain('measurements left out', f'actuator/measured_js: {error}')
            return
        self._heard.set()

    def _drive(self) -> None:
        """Wait, approach, run, repeat; in a thread, because a timer jitters more."""
        if not self._wait() or self._measured is None:
            return
        start = np.array(list(self._measured.values()))
        first = self._trajectory.at(0.0)
        self.get_logger().info(
            f'{self._trajectory.name}: {self._trajectory.duration:g} s, '
            f'{self._repeats or "endless"} times, at {1.0 / self._period:g} Hz'
        )
        done = 0
        if self._approach and np.max(np.abs(first - start)) > THERE:
            way = Motion(start, first, 0.0, self._approach)
            self._stream(self._approach, lambda t: way.at(np.array([t]))[0])
        while not self.stopping.is_set() and (not self._repeats or done < self._repeats):
            self._progress = f'run {done + 1}'
            self._stream(self._trajectory.duration, self._trajectory.at)
            done += 1
        self._progress = 'stopped' if self.stopping.is_set() else 'done'
        self.get_logger().info(f'{self._trajectory.name}: {self._progress} after {done} runs')
        self.finished = self._exit

    def _wait(self) -> bool:
        """Return whether the motors speak and listen, before patience or the node's life ended."""
        begin = time.monotonic()
        said = begin
        # a command that nobody takes yet is lost, the first of a motion like any other
        while not (self._heard.is_set() and self._commands.get_subscription_count()):
            if self.stopping.wait(0.05):
                return False
            now = time.monotonic()
            if self._patience and now - begin > self._patience:
                self.failure = TrajectoryError(
                    f'{self._missing()} for {self._patience:g} s; start '
                    'the simulator or the robot, or look for another namespace or ROS_DOMAIN_ID'
                )
                return False
            if now - said > REMIND:
                said = now
                self.get_logger().warning(
                    f'{self._missing()} since {now - begin:.0f} s; is the simulator or the robot '
                    'running, in this namespace and ROS_DOMAIN_ID?'
                )
        return True

    def _missing(self) -> str:
        """Return what the start waits for."""
        if not self._heard.is_set():
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
