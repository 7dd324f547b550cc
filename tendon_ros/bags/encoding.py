"""Channels → the messages of their topic."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tendon_ros.bags.layout import Layout, marks
from tendon_ros.bags.messages import typestore
from tendon_ros.bags.stamps import IntArray, to_stamps
from tendon_ros.bags.topics import JOINT_FIELDS, TIP_FRAME, WRENCH, WRENCH_TOPICS
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, FloatArray

#: stamps [ns], shape (n,), and one serialised message each
Batch = tuple[IntArray, list[bytes]]


def joint_layout(joints: list[str], fields: list[str]) -> Layout:
    """
    Return the layout of a JointState.

    :param joints: its names.
    :param fields: the fields that it fills.
    :return: a layout whose numbers run over the fields, and in each over the joints.
    """
    kind = typestore().types['sensor_msgs/msg/JointState']
    numbers = marks(len(joints) * len(fields))
    parts = {
        field: np.array(numbers[i * len(joints) : (i + 1) * len(joints)])
        for i, field in enumerate(fields)
    }
    arrays = {field: parts.get(field, np.empty(0)) for field in JOINT_FIELDS}
    message = kind(header=_header(''), name=list(joints), **arrays)
    return Layout(message, 'sensor_msgs/msg/JointState', numbers)


def wrench_layout() -> Layout:
    """
    Return the layout of a wrench.

    :return: a layout whose numbers are ``force.y`` and ``torque.z``; all else is zero.
    """
    types = typestore().types
    vector = types['geometry_msgs/msg/Vector3']
    force, torque = numbers = marks(2)
    message = types[WRENCH](
        header=_header(TIP_FRAME),
        wrench=types['geometry_msgs/msg/Wrench'](
            force=vector(x=0.0, y=force, z=0.0), torque=vector(x=0.0, y=0.0, z=torque)
        ),
    )
    return Layout(message, WRENCH, numbers)


def joint_states(channels: Mapping[tuple[str, str], Channel], epoch_ns: int) -> Iterator[Batch]:
    """
    Yield the messages of a topic of JointStates, in batches of one layout.

    A message holds what was measured at its stamp. Joints with different fields at one stamp
    travel in separate messages, so that no field holds an invented number.

    :param channels: by joint and field.
    :param epoch_ns: header stamp of time zero [ns].
    :return: batches, each in the order of its stamps.
    """
    joints = list(dict.fromkeys(joint for joint, _ in channels))
    stamps = {key: to_stamps(c.time, epoch_ns) for key, c in channels.items()}
    every = np.unique(np.concatenate(list(stamps.values())))
    values: FloatArray = np.full((every.size, len(JOINT_FIELDS), len(joints)), np.nan)
    for (joint, field), channel in channels.items():
        rows = np.searchsorted(every, stamps[joint, field])
        values[rows, JOINT_FIELDS.index(field), joints.index(joint)] = channel.value
    measured = np.isfinite(values)
    # One number for each set of fields that a joint can have at a stamp; zero for nothing.
    sets = np.tensordot(measured, 2 ** np.arange(len(JOINT_FIELDS)), axes=([1], [0]))
    patterns, which = np.unique(sets, axis=0, return_inverse=True)
    for p, pattern in enumerate(patterns):
        rows = np.flatnonzero(which.ravel() == p)
        for filled in sorted(set(pattern.tolist()) - {0}):
            members = np.flatnonzero(pattern == filled)
            fields = [f for f in range(len(JOINT_FIELDS)) if filled >> f & 1]
            layout = joint_layout([joints[j] for j in members], [JOINT_FIELDS[f] for f in fields])
            numbers = values[np.ix_(rows, fields, members)].reshape(rows.size, -1)
            yield every[rows], layout.encode(every[rows], numbers)


def wrenches(topic: str, channels: Mapping[str, Channel], epoch_ns: int) -> Iterator[Batch]:
    """
    Yield the messages of a topic of wrenches.

    A wrench has no word for "not measured": what is absent is zero here, and the bag's metadata
    tells which channels are there.

    :param topic: relative topic.
    :param channels: by ``force`` and ``torque``.
    :param epoch_ns: header stamp of time zero [ns].
    :return: one batch.
    :raises RecordingError: where force and torque were measured at different stamps.
    """
    stamps = [to_stamps(c.time, epoch_ns) for c in channels.values()]
    if any(not np.array_equal(stamps[0], other) for other in stamps[1:]):
        raise RecordingError(
            f'{" and ".join(WRENCH_TOPICS[topic])} travel in one message and have different '
            'stamps; resample one of them'
        )
    zero = np.zeros(stamps[0].size)
    columns = [channels[f].value if f in channels else zero for f in ('force', 'torque')]
    yield stamps[0], wrench_layout().encode(stamps[0], np.stack(columns, axis=1))


def _header(frame: str) -> Any:
    types = typestore().types
    stamp = types['builtin_interfaces/msg/Time'](sec=0, nanosec=0)
    return types['std_msgs/msg/Header'](stamp=stamp, frame_id=frame)
