"""Read a rosbag2 as a :class:`~tendon_ros.base.recording.Recording`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from tendon_ros.bags.faults import Faults
from tendon_ros.bags.joint_states import JointStates
from tendon_ros.bags.messages import decode
from tendon_ros.bags.storage import bag_metadata, messages, open_bag
from tendon_ros.bags.topics import (
    full_topic,
    JOINT_TOPICS,
    namespace_of,
    REQUIRED_TOPIC,
    TOPIC_TYPES,
    WRENCH_TOPICS,
)
from tendon_ros.bags.wrenches import Wrenches
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Recording

UNREADABLE = 'cannot be decoded'

_Sink = JointStates | Wrenches

#: joint names that the caller knows, by group of channels
JointNames = Mapping[str, Sequence[str]]


def read_recording(
    path: Path | str, namespace: str | None = None, joints: JointNames | None = None
) -> Recording:
    """
    Read the channels of one instrument, on header stamps.

    :param path: folder of a bag, or a single ``.mcap`` or ``.db3`` file.
    :param namespace: of the instrument; None to find the only one.
    :param joints: names for messages without names or with numbers, for instance
        ``{'actuator': ['pulley_M', 'pulley_L']}``; ``setpoint`` falls back on ``actuator``.
    :return: the recording; ``warnings`` tells what was left out.
    :raises RecordingError: where the bag cannot be read, or lacks the measured motors.
    """
    path = Path(path)
    joints = joints or {}
    with open_bag(path) as reader:
        metadata = bag_metadata(path)
        listed = set(metadata['channels'].split(',')) if 'channels' in metadata else None
        connections = reader.connections
        types = {c.topic: c.msgtype for c in connections}
        namespace = namespace_of(str(path), types, namespace)
        wanted = {full_topic(namespace, topic): topic for topic in TOPIC_TYPES}
        for name, topic in wanted.items():
            if types.get(name, TOPIC_TYPES[topic]) != TOPIC_TYPES[topic]:
                raise RecordingError(
                    f'{path}: topic {name} is {types[name]}, not {TOPIC_TYPES[topic]}; '
                    'record the right topic under that name'
                )
        faults = {name: Faults(name) for name in wanted}
        totals = dict.fromkeys(wanted, 0)
        sinks: dict[str, _Sink] = {}
        for name, topic in wanted.items():
            if topic in WRENCH_TOPICS:
                sinks[name] = Wrenches(topic, listed, faults[name])
            else:
                group = JOINT_TOPICS[topic]
                known = joints.get(group) or (
                    joints.get('actuator') if group == 'setpoint' else None
                )
                sinks[name] = JointStates(topic, known, faults[name])
        for name, log_time, cdr in messages(
            path, reader, [c for c in connections if c.topic in wanted]
        ):
            totals[name] += 1
            try:
                message = decode(cdr, TOPIC_TYPES[wanted[name]])
                stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
            except Exception:
                # The bytes of a foreign writer make the decoder raise anything.
                faults[name].note(UNREADABLE, totals[name], log_time)
                continue
            sinks[name].add(message, stamp, totals[name])
    epoch = _epoch(metadata, sinks.values())
    channels = [channel for sink in sinks.values() for channel in sink.channels(epoch)]
    warnings = tuple(
        sentence for name in wanted for sentence in faults[name].sentences(totals[name], epoch)
    )
    if not any(channel.name.startswith('actuator/') for channel in channels):
        topic = full_topic(namespace, REQUIRED_TOPIC)
        detail = next((w for w in warnings if w.startswith(topic)), f'{topic} has no values')
        raise RecordingError(
            f'{path}: nothing usable was measured at the motors: {detail}; check the driver that '
            'publishes it'
        )
    return Recording(
        name=path.stem if path.is_file() else path.resolve().name,
        channels={channel.name: channel for channel in channels},
        epoch_ns=epoch,
        metadata={**metadata, 'namespace': namespace or '/'},
        warnings=warnings,
    )


def _epoch(metadata: Mapping[str, str], sinks: Iterable[_Sink]) -> int:
    """Return the stamp of time zero: what the writer noted, else the first stamp."""
    firsts = [first for sink in sinks if (first := sink.first_stamp()) is not None]
    try:
        return int(metadata['epoch_ns'])
    except (KeyError, ValueError):
        return min(firsts, default=0)
