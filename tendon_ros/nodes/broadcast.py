"""Publish channel values on the topics that carry them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from tendon_ros.bags.stamps import IntArray
from tendon_ros.bags.topics import JOINT_TOPICS
from tendon_ros.base.recording import FloatArray
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

    def publish(self, stamps: IntArray, values: Mapping[str, FloatArray]) -> None:
        """
        Publish every channel, in the order of the stamps.

        :param stamps: header stamps [ns], shape (n,).
        :param values: by channel, shape (n,) each.
        """
        if values.keys() != self._channels:
            self._channels = frozenset(values)
            self._wires = wires_for(values)
            for wire in self._wires:
                if wire.topic not in self._publishers:
                    kind = JointState if wire.topic in JOINT_TOPICS else WrenchStamped
                    made = self._node.create_publisher(kind, wire.topic, 10)
                    self._publishers[wire.topic] = made
        encoded = [(wire.topic, wire.encode(stamps, values)) for wire in self._wires]
        for n in range(stamps.size):
            for topic, messages in encoded:
                self._publishers[topic].publish(messages[n])
