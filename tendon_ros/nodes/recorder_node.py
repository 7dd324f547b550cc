"""The node behind ``recorder``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
import json
import platform
import time
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.utilities import get_rmw_implementation_identifier

from tendon_ros import __version__
from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.qos import offered_qos
from tendon_ros.bags.topics import TOPIC_TYPES
from tendon_ros.base.errors import listed, OutputError, RecordingError
from tendon_ros.base.names import names_in
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.drops import Drops
from tendon_ros.nodes.parameter_census import ParameterCensus
from tendon_ros.nodes.recorder import PROGRAM
from tendon_ros.nodes.settings import SettingError, Value
from tendon_ros.nodes.tendon_node import TendonNode
from tendon_ros.nodes.terms import Terms, terms_for

#: topics of the instrument beside those that carry channels; the last two are commands
ALSO: Mapping[str, str] = {
    'operating_state': 'crtk_msgs/msg/OperatingState',
    'actuator/servo_jp': 'sensor_msgs/msg/JointState',
    'actuator/move_jp': 'sensor_msgs/msg/JointState',
}
#: topics of the whole system: changes of parameters, and how well nodes are
SYSTEM: Mapping[str, str] = {
    '/parameter_events': 'rcl_interfaces/msg/ParameterEvent',
    '/diagnostics': 'diagnostic_msgs/msg/DiagnosticArray',
}
#: a burst that the writer may be late for, in messages
DEPTH = 1000


@dataclass(frozen=True)
class Ear:
    """A subscription, with the type of its topic and the terms on which it listens."""

    kind: str
    terms: Terms
    subscription: Subscription


class RecorderNode(TendonNode):
    """
    Writes messages as they were sent, without looking into them.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        self.refuse_unknown_parameters()
        self._duration = float(values['duration'])
        self._drops = Drops()
        self._began: float | None = None
        self._found: dict[str, Mapping[str, object]] = {}
        self._ears: dict[str, Ear] = {}
        self._refused: set[str] = set()
        own = {self.resolve_topic_name(t): kind for t, kind in {**TOPIC_TYPES, **ALSO}.items()}
        self._own = frozenset(own)
        self._asked = {self._full_name(topic) for topic in names_in(str(values['topics']))}
        self._extra = self._asked - own.keys()
        # last of what may fail: a corrected command shall find the path free
        path = str(values['out']) or time.strftime('rosbag2_%Y_%m_%d-%H_%M_%S')
        self._bag = BagWriter(
            path,
            storage='mcap' if values['storage'] == 'mcap' else 'sqlite3',
            compress=bool(values['compress']),
            metadata={
                'origin': 'recorded by tendon_ros',
                'namespace': self.get_namespace(),
                'versions': json.dumps(_versions()),
            },
        )
        for topic, kind in {**own, **SYSTEM}.items():
            self._subscribe(topic, kind, Terms())
        self._census = ParameterCensus(self, self._on_parameters)
        self.every(0.5, self._look_around)
        self.every(0.05, self._check_time)
        self.get_logger().info(f'recording {self.get_namespace()} to {path}')

    def close(self) -> None:
        """Finish the bag."""
        super().close()
        if not hasattr(self, '_bag'):
            return
        try:
            self._bag.set_metadata('dropped', json.dumps(self._drops.lost))
        finally:
            self._bag.close()
        if self.failure is not None:
            return
        silent = sorted(self._asked - self._bag.counts.keys() - self._refused)
        if silent:
            self.get_logger().warning(
                f'nothing came on {listed(silent)}; see whether the name is right and somebody '
                'publishes'
            )
        lost = sum(self._drops.lost.values())
        self.get_logger().info(
            f'{self._bag.path}: {sum(self._bag.counts.values())} messages on '
            f'{len(self._bag.counts)} topics, {lost} lost on the way'
        )

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return what was written and what was lost."""
        lost = sum(self._drops.lost.values())
        level = Level.WARN if lost else Level.OK
        text = f'{lost} messages lost on the way' if lost else f'recording to {self._bag.path}'
        return level, text, {'lost': lost, **self._bag.counts}

    def _full_name(self, topic: str) -> str:
        """Return the absolute name of a topic that was asked for."""
        try:
            return self.resolve_topic_name(topic)
        except RuntimeError:  # the base of the errors of rcl, which tell the line of its source
            raise SettingError(
                f'parameter topics: ROS cannot use the name {topic!r}; between slashes write '
                'letters, digits and underscores, no digit first, such as /arm/joint_states'
            ) from None

    def _subscribe(self, topic: str, kind: str, now: Terms) -> None:
        """Record a topic from now on; its place in the bag is made by its first message."""
        package, _, name = kind.partition('/msg/')
        try:
            message = getattr(import_module(f'{package}.msg'), name)
        except (ImportError, AttributeError):
            if topic in self._extra:
                self._refuse(topic, f'{kind} is not installed')
            return
        terms = self._terms(topic, now)
        subscription = self.create_subscription(
            message, topic, self._writer_of(topic, kind), _qos(terms), raw=True
        )
        self._ears[topic] = Ear(kind, terms, subscription)

    def _writer_of(self, topic: str, kind: str) -> Callable[..., None]:
        """Return the callback of a topic."""

        def on_message(cdr: bytes, info: Mapping[str, Any]) -> None:
            if self.stopping.is_set() or topic in self._refused:
                return
            try:
                if topic not in self._bag.counts:
                    self._bag.add_topic(topic, kind, self._offered(topic))
                    self.get_logger().info(f'first message of {topic}')
                if topic in self._own:
                    self._drops.note(topic, info.get('publication_sequence_number'))
                    self._began = self._began or time.monotonic()
                self._bag.write_raw(topic, cdr, info.get('received_timestamp') or time.time_ns())
            except RecordingError as error:
                self._refuse(topic, str(error))
            except OutputError as error:
                self._give_up(error)

        return on_message

    def _refuse(self, topic: str, why: str) -> None:
        self._refused.add(topic)
        self.get_logger().warning(f'{topic} is not recorded: {why}')

    def _offers(self, topic: str) -> list[Terms]:
        """Return what each of the topic's publishers offers."""
        profiles = [info.qos_profile for info in self.get_publishers_info_by_topic(topic)]
        return [
            Terms(
                reliable=one.reliability == ReliabilityPolicy.RELIABLE,
                latched=one.durability == DurabilityPolicy.TRANSIENT_LOCAL,
            )
            for one in profiles
        ]

    def _terms(self, topic: str, now: Terms) -> Terms:
        """Return how to listen to a topic by what is known of its publishers."""
        return terms_for(self._offers(topic), now, heard=topic in self._bag.counts)

    def _offered(self, topic: str) -> Any:
        """Return what the topic's publishers offer, for playback to offer the same."""
        offers = self._offers(topic)
        return offered_qos(
            reliable=all(one.reliable for one in offers),
            latched=any(one.latched for one in offers),
        )

    def _look_around(self) -> None:
        """Ask new nodes for their parameters, and follow topics that have appeared."""
        self._census.look()
        if self._extra - self._ears.keys() - self._refused:
            for topic, kinds in self.get_topic_names_and_types():
                if topic in self._extra - self._ears.keys() - self._refused:
                    self._subscribe(topic, kinds[0], Terms())
        for topic, ear in list(self._ears.items()):
            if self._terms(topic, ear.terms) != ear.terms:
                self.destroy_subscription(ear.subscription)
                self._subscribe(topic, ear.kind, ear.terms)

    def _check_time(self) -> None:
        if self._duration and self._began and time.monotonic() - self._began >= self._duration:
            self.finished = True

    def _on_parameters(self, node: str, values: Mapping[str, object]) -> None:
        self._found[node] = values
        if not self.stopping.is_set():
            try:
                self._bag.set_metadata('parameters', json.dumps(self._found, default=str))
            except OutputError as error:
                self._give_up(error)

    def _give_up(self, error: OutputError) -> None:
        self.failure = error
        self.stopping.set()


def _qos(terms: Terms) -> QoSProfile:
    reliability, durability = ReliabilityPolicy, DurabilityPolicy
    return QoSProfile(
        depth=DEPTH,
        reliability=reliability.RELIABLE if terms.reliable else reliability.BEST_EFFORT,
        durability=durability.TRANSIENT_LOCAL if terms.latched else durability.VOLATILE,
    )


def _versions() -> dict[str, str]:
    return {
        'tendon_ros': __version__,
        'python': platform.python_version(),
        'rmw': get_rmw_implementation_identifier(),
    }
