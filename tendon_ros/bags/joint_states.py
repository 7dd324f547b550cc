"""
JointState messages → channels, sparing none of the ways in which drivers fill them.

Names may be empty, numbers or permuted (CRTK clients and cisst do so); an empty field is
unmeasured, and so is one that is NaN throughout.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tendon_ros.bags.faults import Faults, increasing, NOT_FINITE
from tendon_ros.bags.stamps import IntArray, to_seconds
from tendon_ros.bags.topics import joint_channel, JOINT_FIELDS
from tendon_ros.base.recording import Channel, FloatArray

UNEQUAL = 'names and values differ in number'
BAD_NAMES = 'joint names that cannot be matched'


def resolve_names(
    names: Sequence[str], width: int, joints: Sequence[str] | None
) -> tuple[str, ...] | None:
    """
    Return the joint that each value of a message belongs to.

    :param names: the message's names, perhaps empty or numbers counted from zero.
    :param width: number of values in its longest field.
    :param joints: the joints that the caller knows, in the driver's order; None for none.
    :return: one name a value, or None where the names make no sense.
    """
    if not names:
        if joints is None:
            return tuple(str(i) for i in range(width))
        return tuple(joints) if len(joints) == width else None
    if len(set(names)) < len(names) or not all(names):
        return None
    if joints is not None and all(n.isdecimal() for n in names) and not set(names) & set(joints):
        numbers = [int(name) for name in names]
        return tuple(joints[n] for n in numbers) if max(numbers) < len(joints) else None
    return tuple(names)


def width_of(message: Any) -> int | None:
    """
    Return how many values each field of a message has that has any.

    :param message: a JointState.
    :return: the number, 0 where all are empty; None where fields differ, or names from fields.
    """
    sizes = {len(getattr(message, name)) for name in JOINT_FIELDS} - {0}
    if len(sizes) > 1 or (message.name and sizes and len(message.name) not in sizes):
        return None
    return max(sizes, default=0)


@dataclass
class _Block:
    """Messages of one layout: the same names, the same fields."""

    order: list[int] = field(default_factory=list)
    stamp: list[int] = field(default_factory=list)
    rows: dict[str, list[FloatArray]] = field(default_factory=dict)


class JointStates:
    """
    Collects the messages of one topic.

    :param topic: relative topic.
    :param joints: see :func:`resolve_names`.
    :param faults: where to count what is left out.
    """

    def __init__(self, topic: str, joints: Sequence[str] | None, faults: Faults) -> None:
        self._topic = topic
        self._joints = joints
        self._faults = faults
        self._blocks: dict[tuple[tuple[str, ...], tuple[str, ...]], _Block] = {}

    def add(self, message: Any, stamp_ns: int, number: int) -> None:
        """
        Take in a message.

        :param message: a decoded JointState.
        :param stamp_ns: its header stamp [ns].
        :param number: its place in the topic, from 1.
        """
        width = width_of(message)
        if width is None:
            self._faults.note(UNEQUAL, number, stamp_ns)
            return
        names = resolve_names(message.name, width, self._joints)
        if names is None:
            self._faults.note(BAD_NAMES, number, stamp_ns)
            return
        fields = tuple(name for name in JOINT_FIELDS if len(getattr(message, name)))
        block = self._blocks.setdefault((names, fields), _Block())
        block.order.append(number)
        block.stamp.append(stamp_ns)
        for name in fields:
            block.rows.setdefault(name, []).append(getattr(message, name))

    def first_stamp(self) -> int | None:
        """Return the smallest stamp [ns], None without messages."""
        return min((min(block.stamp) for block in self._blocks.values()), default=None)

    def channels(self, epoch_ns: int) -> list[Channel]:
        """
        Return what was collected.

        :param epoch_ns: header stamp of time zero [ns].
        :return: one channel for each joint and field that was measured.
        """
        parts: dict[str, list[tuple[IntArray, IntArray, FloatArray]]] = {}
        for (names, _), block in self._blocks.items():
            order = np.array(block.order, dtype=np.int64)
            stamp = np.array(block.stamp, dtype=np.int64)
            for name, rows in block.rows.items():
                table = np.array(rows, dtype=np.float64)
                for column, joint in enumerate(names):
                    key = joint_channel(self._topic, joint, name)
                    parts.setdefault(key, []).append((order, stamp, table[:, column]))
        out = []
        for name, pieces in sorted(parts.items()):
            order, stamp, value = (np.concatenate(column) for column in zip(*pieces, strict=True))
            arrival = np.argsort(order, kind='stable')
            order, stamp, value = order[arrival], stamp[arrival], value[arrival]
            finite = np.isfinite(value)
            if not finite.any():
                continue
            self._faults.note_many(f'{name} is {NOT_FINITE}', order, stamp, ~finite)
            order, stamp, value = order[finite], stamp[finite], value[finite]
            keep = increasing(stamp, order, self._faults)
            out.append(Channel(name, to_seconds(stamp[keep], epoch_ns), value[keep]))
        return out
