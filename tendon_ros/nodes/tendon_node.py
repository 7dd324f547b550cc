"""What all nodes share: checked parameters, complaints that do not flood, health, a worker."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
import threading
import time

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from tendon_ros.bags.topics import DEFAULT_NAMESPACE
from tendon_ros.nodes.complaints import Complaints
from tendon_ros.nodes.diagnostics import diagnostic_array, Level
from tendon_ros.nodes.settings import checked, refuse_unknown, Setting, Value

#: parameters that rclpy itself declares or reads
BUILT_IN = ('use_sim_time', 'start_type_description_service')


class TendonNode(Node):
    """
    A node in the namespace of an instrument.

    Subclasses declare their parameters, then call :meth:`refuse_unknown_parameters`. ``begin`` is
    called when callbacks are about to be served, ``close`` when that has ended, also early.

    :param name: of the node.
    :param given: parameters that the command line sets; they win over parameter files.
    """

    def __init__(self, name: str, given: Mapping[str, Value]) -> None:
        overrides = [Parameter(key, value=value) for key, value in given.items()]
        super().__init__(name, namespace=DEFAULT_NAMESPACE, parameter_overrides=overrides)
        self.steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.stopping = threading.Event()
        #: the node has done what it was started for
        self.finished = False
        #: why the node cannot go on; a TendonError where the user can mend it
        self.failure: Exception | None = None
        self._worker: threading.Thread | None = None
        self.settings: dict[str, Setting] = {}
        self._complaints = Complaints(self.get_logger().warning)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self.every(1.0, self._publish_diagnostics)

    def begin(self) -> None:
        """Start what runs beside the callbacks."""

    def close(self) -> None:
        """End what runs beside the callbacks, and wait until it has ended."""
        self.stopping.set()
        if self._worker is not None:
            self._worker.join()

    def work(self, name: str, task: Callable[[], None]) -> None:
        """
        Run a task in a thread beside the callbacks; the node ends where the task fails.

        :param name: of the thread.
        :param task: what to do, until ``stopping`` is set.
        """

        def run() -> None:
            try:
                task()
            except Exception as error:
                # a thread that dies alone leaves a node that looks sound and does nothing
                self.failure = error

        self._worker = threading.Thread(target=run, name=name)
        self._worker.start()

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return level, one line and details for the diagnostics."""
        return Level.OK, 'running', {}

    def every(self, seconds: float, callback: Callable[[], None]) -> Timer:
        """
        Call back regularly, whatever happens to the system's or the simulation's clock.

        :param seconds: the period [s].
        :param callback: what to call.
        :return: the timer.
        """
        return self.create_timer(seconds, callback, clock=self.steady)

    def declare(self, settings: Sequence[Setting]) -> dict[str, Value]:
        """
        Declare parameters, with the values that files and the command line give them.

        :param settings: the parameters.
        :return: values by name.
        :raises SettingError: on a value that a parameter cannot have.
        """
        self.settings.update({one.name: one for one in settings})
        # rclpy keeps what files and options gave in an attribute that has no public name.
        given = self._parameter_overrides
        values = {
            one.name: checked(one, _plain(given[one.name].value))
            if one.name in given
            else one.default
            for one in settings
        }
        self.declare_parameters(
            '', [(one.name, values[one.name], _descriptor(one)) for one in settings]
        )
        return values

    def refuse_unknown_parameters(self) -> None:
        """
        Raise where a file or an option gives a parameter that was not declared.

        :raises SettingError: with the name that comes closest.
        """
        given = [
            name for name in self._parameter_overrides if not name.startswith('qos_overrides')
        ]
        refuse_unknown(self.get_name(), given, [*self.settings, *BUILT_IN])

    def complain(self, kind: str, text: str) -> None:
        """
        Warn of something that was given and cannot be used.

        :param kind: complaints of a kind are said at once, then every few seconds with a count.
        :param text: what, where, and how to mend it.
        """
        self._complaints.add(kind, text, time.monotonic())

    def _publish_diagnostics(self) -> None:
        level, text, details = self.health()
        counts = self._complaints.counts()
        recent = self._complaints.recent()
        if recent and level == Level.OK:
            level, text = Level.WARN, recent
        name = f'{self.get_fully_qualified_name()}'.lstrip('/')
        self._diagnostics.publish(
            diagnostic_array(time.time_ns(), name, level, text, {**details, **counts})
        )


def _descriptor(setting: Setting) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(
        description=setting.description,
        additional_constraints=setting.constraint,
        read_only=not setting.live,
    )
    bounded = max(abs(setting.low), abs(setting.high)) < float('inf')
    if bounded and isinstance(setting.default, float):
        span = FloatingPointRange(from_value=float(setting.low), to_value=float(setting.high))
        descriptor.floating_point_range = [span]
    elif bounded and type(setting.default) is int:
        ends = IntegerRange(from_value=int(setting.low), to_value=int(setting.high), step=1)
        descriptor.integer_range = [ends]
    return descriptor


def _plain(value: object) -> object:
    """Return lists of a parameter as one text, which is how our parameters hold them."""
    if isinstance(value, Iterable) and not isinstance(value, str):
        return ','.join(str(part) for part in value)
    return value
