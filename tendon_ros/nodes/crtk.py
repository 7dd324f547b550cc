"""The topics of CRTK that need crtk_msgs, which not every ROS installation has."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from tendon_ros.nodes.conversions import to_stamp
from tendon_ros.nodes.operating_state import OperatingState


class CrtkState:
    """
    Publishes ``operating_state`` and hears ``state_command``; does nothing without crtk_msgs.

    :param node: whose topics they are.
    :param state: what to publish.
    :param is_busy: tells whether a planned motion is under way.
    :param command: what a command is given to.
    """

    def __init__(
        self,
        node: Node,
        state: OperatingState,
        is_busy: Callable[[], bool],
        command: Callable[[str], None],
    ) -> None:
        self._state = state
        self._is_busy = is_busy
        self._publisher: Any = None
        self._last: tuple[str, bool, bool] | None = None
        self._said_at = 0
        try:
            from crtk_msgs.msg import OperatingState as StateMessage
            from crtk_msgs.msg import StringStamped
        except ImportError:
            node.get_logger().info(
                'crtk_msgs is not installed: no operating_state and no state_command; the busy '
                'flag and the state are in /diagnostics'
            )
            return
        self._message = StateMessage
        latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = node.create_publisher(StateMessage, 'operating_state', latched)

        def on_command(message: Any) -> None:
            command(str(message.string))

        node.create_subscription(StringStamped, 'state_command', on_command, 10)

    def publish(self, *, always: bool = False) -> None:
        """
        Publish the state where it changed.

        :param always: publish it also where it did not.
        """
        if self._publisher is None:
            return
        now = (self._state.name, self._state.is_homed, self._is_busy())
        if now == self._last and not always:
            return
        self._last = now
        # Clients take only what is newer than what they have.
        self._said_at = max(time.time_ns(), self._said_at + 1)
        message = self._message(state=now[0], is_homed=now[1], is_busy=now[2])
        message.header.stamp = to_stamp(self._said_at)
        self._publisher.publish(message)
