"""
Which topic carries which channel, in both directions.

Topics are relative to a namespace here (``actuator/measured_js``); the full name puts the
namespace of the instrument in front (``/instrument/actuator/measured_js``).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import re
from types import MappingProxyType

from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.recording import channel_name

JOINT_STATE = 'sensor_msgs/msg/JointState'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
DEFAULT_NAMESPACE = '/instrument'
#: the one topic that a bag may not lack
REQUIRED_TOPIC = 'actuator/measured_js'
#: the frame of every wrench
TIP_FRAME = 'tip'

#: topics of type JointState and the group of their channels
JOINT_TOPICS: Mapping[str, str] = MappingProxyType(
    {
        'actuator/measured_js': 'actuator',
        'actuator/setpoint_js': 'setpoint',
        'pulley/measured_js': 'pulley',
        'pulley/estimated_js': 'estimate',
    }
)
JOINT_FIELDS = ('position', 'velocity', 'effort')

#: topics of type WrenchStamped: the channel of ``force.y`` and the channel of ``torque.z``
WRENCH_TOPICS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        'load_cell/body/measured_cf': ('load_cell/force', 'load_cell/torque'),
        'body/measured_cf': ('estimate/force', 'estimate/torque'),
        'body/measured_cf_std': ('estimate/force_std', 'estimate/torque_std'),
    }
)

TOPIC_TYPES: Mapping[str, str] = MappingProxyType(
    dict.fromkeys(JOINT_TOPICS, JOINT_STATE) | dict.fromkeys(WRENCH_TOPICS, WRENCH)
)

_TOPIC_OF_GROUP = {group: topic for topic, group in JOINT_TOPICS.items()}
_PLACE_OF_WRENCH = {
    name: (topic, field)
    for topic, names in WRENCH_TOPICS.items()
    for name, field in zip(names, ('force', 'torque'), strict=True)
}


def joint_channel(topic: str, joint: str, field: str) -> str:
    """
    Return the channel that a field of a JointState topic goes to.

    :param topic: a key of :data:`JOINT_TOPICS`.
    :param joint: name of the joint, for instance ``pulley_M``.
    :param field: one of :data:`JOINT_FIELDS`.
    :return: for instance ``actuator/pulley_M/effort``.
    """
    return channel_name(JOINT_TOPICS[topic], joint, field)


def place_of(channel: str) -> tuple[str, str, str]:
    """
    Return where a channel lives: the inverse of :func:`joint_channel` and of the wrench table.

    :param channel: name of the channel.
    :return: relative topic, joint (empty for a wrench), field.
    :raises RecordingError: where no topic carries such a channel.
    """
    if channel in _PLACE_OF_WRENCH:
        topic, field = _PLACE_OF_WRENCH[channel]
        return topic, '', field
    group, _, rest = channel.partition('/')
    joint, _, field = rest.rpartition('/')
    if group in _TOPIC_OF_GROUP and joint and field in JOINT_FIELDS:
        return _TOPIC_OF_GROUP[group], joint, field
    raise RecordingError(
        f'channel {channel!r}: no topic carries it; use {listed(_PLACE_OF_WRENCH)} or '
        f'GROUP/JOINT/FIELD with a group of {listed(_TOPIC_OF_GROUP)} and a field of '
        f'{listed(JOINT_FIELDS)}'
    )


def clean_namespace(namespace: str) -> str:
    """
    Return a namespace with one leading slash and none behind; the root is the empty string.

    :param namespace: as a user writes it: ``instrument``, ``/arm/instrument/``, ``/``.
    :return: what stands before ``/actuator/measured_js``.
    """
    stripped = namespace.strip('/')
    return f'/{stripped}' if stripped else ''


def check_namespace(namespace: str) -> None:
    """
    Check that ROS can use a namespace.

    :param namespace: see :func:`clean_namespace`.
    :raises RecordingError: where it cannot, with what a name may have in it.
    """
    if not re.fullmatch(r'(/[A-Za-z_][A-Za-z0-9_]*)*', clean_namespace(namespace)):
        raise RecordingError(
            f'namespace {namespace!r}: ROS cannot use it; between slashes write letters, digits '
            'and underscores, no digit first, such as /arm/instrument'
        )


def full_topic(namespace: str, topic: str) -> str:
    """
    Return the absolute name of a topic.

    :param namespace: see :func:`clean_namespace`.
    :param topic: relative topic.
    :return: for instance ``/instrument/actuator/measured_js``.
    """
    return f'{clean_namespace(namespace)}/{topic}'


def namespace_of(bag: str, topics: Iterable[str], wanted: str | None = None) -> str:
    """
    Return the namespace of the instrument in a bag.

    :param bag: name of the bag, for the message.
    :param topics: absolute topics of the bag.
    :param wanted: the namespace that the user named; None to find the only one.
    :return: a clean namespace, under which :data:`REQUIRED_TOPIC` exists.
    :raises RecordingError: where there is none, or where there are several to choose from.
    """
    names = sorted(topics)
    found = [
        clean_namespace(name.removesuffix(REQUIRED_TOPIC))
        for name in names
        if name.endswith(f'/{REQUIRED_TOPIC}')
    ]
    if wanted is not None and clean_namespace(wanted) not in found:
        raise RecordingError(
            f'{bag}: no topic {full_topic(wanted, REQUIRED_TOPIC)}; the bag has '
            f'{listed(names)}; give another --namespace'
        )
    if wanted is not None:
        return clean_namespace(wanted)
    if not found:
        raise RecordingError(
            f'{bag}: no topic {REQUIRED_TOPIC} in any namespace; the bag has {listed(names)}; '
            'record the motors, or remap their topic to that name'
        )
    if len(found) > 1:
        raise RecordingError(
            f'{bag}: {len(found)} instruments, in {listed(name or "/" for name in found)}; '
            'choose one with --namespace'
        )
    return found[0]
