"""Write a :class:`~tendon_ros.base.recording.Recording` as a rosbag2."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import heapq
from pathlib import Path
import shutil
import tempfile
from typing import Any

import numpy as np

from tendon_ros.bags.bag_writer import BagWriter, Storage
from tendon_ros.bags.messages import encode, typestore
from tendon_ros.bags.stamps import to_stamps
from tendon_ros.bags.topics import (
    clean_namespace,
    DEFAULT_NAMESPACE,
    full_topic,
    JOINT_FIELDS,
    place_of,
    TIP_FRAME,
    TOPIC_TYPES,
    WRENCH_TOPICS,
)
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording

#: file name endings that ask for one file instead of a folder
FILE_STORAGE: Mapping[str, Storage] = {'.mcap': 'mcap', '.db3': 'sqlite3'}

#: one serialised message: stamp [ns], topic, bytes
_Message = tuple[int, str, bytes]


def write_recording(
    recording: Recording,
    path: Path | str,
    *,
    namespace: str = DEFAULT_NAMESPACE,
    storage: Storage = 'mcap',
    compress: bool = True,
    overwrite: bool = False,
) -> Path:
    """
    Write a recording as a bag; either the whole bag appears, or none.

    A message holds what was measured at its stamp: joints with different fields at one stamp
    travel in separate messages, so that no field ever holds an invented number.

    :param recording: what to write; every channel needs a topic.
    :param path: folder of the bag, or a single file where it ends in ``.mcap`` or ``.db3``.
    :param namespace: of the instrument.
    :param storage: ``mcap`` or ``sqlite3``; the ending of a single file decides by itself.
    :param compress: compress the chunks of an MCAP.
    :param overwrite: replace what is there.
    :return: the path.
    :raises RecordingError: where a channel has no topic, or the bag cannot be created.
    """
    path = Path(path)
    if path.exists() and not overwrite:
        raise RecordingError(f'{path}: exists; give another path or allow to overwrite it')
    single = path.suffix in FILE_STORAGE
    streams = _streams(recording)
    metadata = {
        **recording.metadata,
        'namespace': clean_namespace(namespace) or '/',
        'epoch_ns': str(recording.epoch_ns),
        'channels': ','.join(sorted(recording.channels)),
    }
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=f'.{path.name}-', dir=path.parent))
    except OSError as error:
        raise RecordingError(
            f'{path}: cannot be created ({error}); give a folder that can be written'
        ) from error
    try:
        with BagWriter(
            part / path.stem if single else part / path.name,
            storage=FILE_STORAGE.get(path.suffix, storage),
            compress=compress,
            metadata=metadata,
        ) as bag:
            for topic in streams:
                bag.add_topic(full_topic(namespace, topic), TOPIC_TYPES[topic])
            for stamp, topic, cdr in heapq.merge(*streams.values(), key=lambda item: item[0]):
                bag.write_raw(full_topic(namespace, topic), cdr, stamp)
        done = bag.path / f'{path.stem}{path.suffix}' if single else bag.path
        if path.is_dir():
            shutil.rmtree(path)
        done.replace(path)
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return path


def _streams(recording: Recording) -> dict[str, Iterator[_Message]]:
    """Return one stream of messages a topic, each in the order of its stamps."""
    topics: dict[str, dict[tuple[str, str], Channel]] = {}
    for name, channel in recording.channels.items():
        topic, joint, field = place_of(name)
        topics.setdefault(topic, {})[joint, field] = channel
    for topic, channels in topics.items():
        starts = [to_stamps(c.time[:1], recording.epoch_ns) for c in channels.values()]
        first = min(np.concatenate(starts).tolist(), default=0)
        if first < 0:
            raise RecordingError(
                f'{recording.name}: {topic} has a stamp before 1970 ({first} ns); '
                'set a later epoch'
            )
    return {
        topic: (
            _wrenches(recording, topic, {field: c for (_, field), c in channels.items()})
            if topic in WRENCH_TOPICS
            else _joint_states(recording, topic, channels)
        )
        for topic, channels in sorted(topics.items())
    }


def _header(stamp: int, frame: str) -> Any:
    types = typestore().types
    time = types['builtin_interfaces/msg/Time'](sec=stamp // 10**9, nanosec=stamp % 10**9)
    return types['std_msgs/msg/Header'](stamp=time, frame_id=frame)


def _joint_states(
    recording: Recording, topic: str, channels: Mapping[tuple[str, str], Channel]
) -> Iterator[_Message]:
    """Yield the messages of a topic with joints."""
    kind = TOPIC_TYPES[topic]
    make = typestore().types[kind]
    joints = list(dict.fromkeys(joint for joint, _ in channels))
    stamps = {key: to_stamps(c.time, recording.epoch_ns) for key, c in channels.items()}
    every = np.unique(np.concatenate(list(stamps.values())))
    values = np.full((len(joints), len(JOINT_FIELDS), every.size), np.nan)
    for (joint, field), channel in channels.items():
        rows = np.searchsorted(every, stamps[joint, field])
        values[joints.index(joint), JOINT_FIELDS.index(field), rows] = channel.value
    measured = np.isfinite(values)
    for i, stamp in enumerate(every.tolist()):
        groups: dict[tuple[bool, ...], list[int]] = {}
        for j in range(len(joints)):
            groups.setdefault(tuple(measured[j, :, i].tolist()), []).append(j)
        for fields, members in groups.items():
            if not any(fields):
                continue
            arrays = {
                field: values[members, f, i] if fields[f] else np.empty(0)
                for f, field in enumerate(JOINT_FIELDS)
            }
            message = make(header=_header(stamp, ''), name=[joints[j] for j in members], **arrays)
            yield stamp, topic, encode(message, kind)


def _wrenches(
    recording: Recording, topic: str, channels: Mapping[str, Channel]
) -> Iterator[_Message]:
    """Yield the messages of a topic with a wrench."""
    kind = TOPIC_TYPES[topic]
    types = typestore().types
    vector = types['geometry_msgs/msg/Vector3']
    wrench = types['geometry_msgs/msg/Wrench']
    stamps = [to_stamps(c.time, recording.epoch_ns) for c in channels.values()]
    if any(not np.array_equal(stamps[0], other) for other in stamps[1:]):
        raise RecordingError(
            f'{recording.name}: {" and ".join(WRENCH_TOPICS[topic])} travel in one message and '
            'have different stamps; resample one of them'
        )
    # A wrench has no word for "not measured": `channels` in the metadata tells which part is.
    zero = np.zeros(stamps[0].size)
    force = channels['force'].value if 'force' in channels else zero
    torque = channels['torque'].value if 'torque' in channels else zero
    rows = zip(stamps[0].tolist(), force.tolist(), torque.tolist(), strict=True)
    for stamp, force_y, torque_z in rows:
        message = types[kind](
            header=_header(stamp, TIP_FRAME),
            wrench=wrench(
                force=vector(x=0.0, y=force_y, z=0.0), torque=vector(x=0.0, y=0.0, z=torque_z)
            ),
        )
        yield stamp, topic, encode(message, kind)
