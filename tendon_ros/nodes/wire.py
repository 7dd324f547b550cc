"""
Channel values → serialised messages of the contract's topics.

A message object costs a Python node five times as much to publish as its bytes do. The shape of
what a node publishes does not change, so its bytes are laid out once (:mod:`..bags.layout`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
import struct

import numpy as np

from tendon_ros.bags.encoding import joint_layout, wrench_layout
from tendon_ros.bags.layout import Layout, marks
from tendon_ros.bags.topics import (
    joint_channel,
    JOINT_FIELDS,
    place_of,
    WRENCH_TOPICS,
)

_STAMP = struct.Struct('<II')
_NUMBER = struct.Struct('<d')


class Wire:
    """
    One message of one topic, encoded one at a time.

    :param topic: relative topic.
    :param layout: its bytes.
    :param channels: the channel of each number in it, in the layout's order.
    """

    def __init__(self, topic: str, layout: Layout, channels: tuple[str, ...]) -> None:
        self.topic = topic
        self.channels = channels
        numbers = marks(len(channels))
        [cdr] = layout.encode(np.zeros(1, dtype=np.int64), np.array([numbers]))
        self._starts = [cdr.index(_NUMBER.pack(mark)) for mark in numbers]
        self._cdr = bytearray(cdr)

    def encode(self, stamp_ns: int, values: Mapping[str, float]) -> bytes:
        """
        Return a serialised message.

        :param stamp_ns: header stamp [ns].
        :param values: by channel; zero in a wrench where a channel is absent.
        :return: its bytes.
        """
        _STAMP.pack_into(self._cdr, 4, *divmod(stamp_ns, 10**9))
        for name, start in zip(self.channels, self._starts, strict=True):
            _NUMBER.pack_into(self._cdr, start, values.get(name, 0.0))
        return bytes(self._cdr)


def wires_for(channels: Iterable[str]) -> tuple[Wire, ...]:
    """
    Return the messages that carry channels.

    Joints of one topic that fill different fields get messages of their own, so that nothing
    unmeasured is sent as a number.

    :param channels: names of channels.
    :return: one wire a message.
    """
    wrenches: dict[str, None] = {}
    joints: dict[str, dict[str, set[str]]] = {}
    for name in channels:
        topic, joint, field = place_of(name)
        if topic in WRENCH_TOPICS:
            wrenches[topic] = None
        else:
            joints.setdefault(topic, {}).setdefault(joint, set()).add(field)
    found = [wire for topic, fields in joints.items() for wire in _joint_wires(topic, fields)]
    found += [Wire(topic, wrench_layout(), WRENCH_TOPICS[topic]) for topic in wrenches]
    return tuple(found)


def _joint_wires(topic: str, fields: Mapping[str, set[str]]) -> Iterator[Wire]:
    for filled in dict.fromkeys(frozenset(some) for some in fields.values()):
        members = [joint for joint, some in fields.items() if some == filled]
        order = [field for field in JOINT_FIELDS if field in filled]
        names = tuple(joint_channel(topic, joint, field) for field in order for joint in members)
        yield Wire(topic, joint_layout(members, order), names)
