"""Hear the topics that carry channels."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState

from tendon_ros.bags.topics import JOINT_TOPICS, place_of
from tendon_ros.nodes.conversions import Message

#: measurements that may wait while the machine is busy: none shall be left out
DEPTH = 500


def hear(
    node: Node, channels: Iterable[str], hearer: Callable[[str], Callable[[Message], None]]
) -> list[str]:
    """
    Subscribe to the topics of channels.

    :param node: who listens.
    :param channels: what is wanted.
    :param hearer: returns the callback of a relative topic.
    :return: the relative topics, sorted.
    :raises RecordingError: where no topic carries a channel.
    """
    topics = sorted({place_of(channel)[0] for channel in channels})
    for topic in topics:
        kind = JointState if topic in JOINT_TOPICS else WrenchStamped
        node.create_subscription(kind, topic, hearer(topic), DEPTH)
    return topics
