"""
Messages of joints and wrenches → numbers by channel name, stamps both ways; pure functions.

What clients send is taken as they send it: names may be empty, numbers counted from zero or in
another order. What makes no sense is refused with a reason, never guessed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from typing import Any

from geometry_msgs.msg import WrenchStamped
from rclpy.time import Time
from sensor_msgs.msg import JointState

from tendon_ros.bags.joint_states import resolve_names, width_of
from tendon_ros.bags.topics import joint_channel, JOINT_FIELDS, WRENCH_TOPICS
from tendon_ros.base.errors import listed, TendonError

type Message = JointState | WrenchStamped


class MessageError(TendonError):
    """A message that cannot be used; what held before it goes on to hold."""


def to_stamp(nanoseconds: int) -> Any:
    """
    Return a stamp for a message's header.

    :param nanoseconds: since 1970 [ns].
    :return: the same as a message.
    """
    return Time(nanoseconds=int(nanoseconds)).to_msg()


def from_stamp(stamp: Any) -> int:
    """
    Return a header's stamp in nanoseconds.

    :param stamp: of the header.
    :return: since 1970 [ns].
    """
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def wanted_positions(message: JointState, joints: Sequence[str]) -> dict[str, float]:
    """
    Return the positions that a command asks for.

    :param message: the command.
    :param joints: the joints that can be commanded, in their order.
    :return: position [rad] by joint; a command with names may leave joints out.
    :raises MessageError: on a wrong length, an unknown joint or a number that is not finite.
    """
    width = len(message.position)
    if not width or (message.name and len(message.name) != width):
        raise MessageError(
            f'command has {width} positions for {len(message.name) or len(joints)} joints; '
            f'give one for each of {listed(joints)}'
        )
    names = resolve_names(message.name, width, joints)
    if names is None or not set(names) <= set(joints):
        raise MessageError(
            f'command is for joints {list(message.name)} with {width} positions; there are '
            f'{listed(joints)}'
        )
    values = dict(zip(names, map(float, message.position), strict=True))
    for name, value in values.items():
        if not math.isfinite(value):
            raise MessageError(f'command for {name} is {value}, not a finite number')
    return values


def joint_values(topic: str, message: JointState, joints: Sequence[str]) -> dict[str, float]:
    """
    Return what a message measured.

    :param topic: relative topic.
    :param message: of that topic.
    :param joints: the joints that the topic should have, in their order.
    :return: values by channel; an empty field is unmeasured and absent.
    :raises MessageError: on fields of different lengths or names that make no sense.
    """
    fields = {name: getattr(message, name) for name in JOINT_FIELDS}
    width = width_of(message)
    if width is None:
        raise MessageError(
            f'{topic}: {len(message.name)} names with '
            + ', '.join(f'{len(values)} values of {name}' for name, values in fields.items())
            + '; give as many of each, or none'
        )
    names = resolve_names(message.name, width, joints)
    if names is None:
        raise MessageError(
            f'{topic}: joints {list(message.name)} with {width} values; expected {listed(joints)}'
        )
    return {
        joint_channel(topic, joint, field): float(value)
        for field, values in fields.items()
        for joint, value in zip(names if len(values) else (), values, strict=True)
    }


def wrench_values(topic: str, message: WrenchStamped) -> dict[str, float]:
    """
    Return what a message of a wrench measured.

    :param topic: relative topic.
    :param message: of that topic.
    :return: force [N] and torque [N m] by channel.
    """
    force, torque = WRENCH_TOPICS[topic]
    return {force: float(message.wrench.force.y), torque: float(message.wrench.torque.z)}


def values_of(topic: str, message: Message, joints: Sequence[str]) -> Mapping[str, float]:
    """
    Return what a message of any topic of the contract measured.

    :param topic: relative topic.
    :param message: of that topic.
    :param joints: as for :func:`joint_values`.
    :return: values by channel.
    :raises MessageError: as :func:`joint_values`.
    """
    if isinstance(message, WrenchStamped):
        return wrench_values(topic, message)
    return joint_values(topic, message, joints)
