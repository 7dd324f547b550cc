"""Publish channel values on the topics that carry them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from tendon_ros.bags.topics import JOINT_TOPICS
from tendon_ros.nodes.wire import Wire, wires_for


class Broadcast:
    """
    Publishers that come into being with the first values for them.

    :param node: whose topics they are; reliable, depth 10.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._channels: frozenset[str] = frozenset()
        self._wires: tuple[Wire, ...] = ()
        self._publishers: dict[str, Any] = {}

    def publish(self, stamp_ns: int, values: Mapping[str, float]) -> None:
        """
        Publish every channel.

        :param stamp_ns: header stamp [ns].
        :param values: by channel.
        """
        self.prepare(values)
        for wire in self._wires:
            self._publishers[wire.topic].publish(wire.encode(stamp_ns, values))

    def prepare(self, values: Iterable[str]) -> None:
        """
        Make the publishers of channels, which takes a while the first time.

        :param values: names of channels.
        """
        if set(values) != self._channels:
            self._channels = frozenset(values)
            self._wires = wires_for(values)
            for wire in self._wires:
                if wire.topic not in self._publishers:
                    kind = JointState if wire.topic in JOINT_TOPICS else WrenchStamped
                    made = self._node.create_publisher(kind, wire.topic, 10)
                    self._publishers[wire.topic] = made
