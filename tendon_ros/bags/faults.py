"""Count what reading leaves out, and say it in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tendon_ros.bags.stamps import IntArray

NOT_FINITE = 'not a finite number'
BACKWARD = 'stamp not after the one before'


class Faults:
    """
    The faulty messages of one topic, by kind; a message counts once for each kind.

    :param topic: absolute name of the topic.
    """

    def __init__(self, topic: str) -> None:
        self._topic = topic
        self._first: dict[str, tuple[int, int]] = {}
        self._members: dict[str, set[int]] = {}

    def note(self, kind: str, number: int, stamp_ns: int) -> None:
        """
        Count a message.

        :param kind: what is wrong with it.
        :param number: its place in the topic, from 1.
        :param stamp_ns: its header stamp [ns].
        """
        members = self._members.setdefault(kind, set())
        members.add(number)
        if number == min(self._first.get(kind, (number, 0))[0], number):
            self._first[kind] = (number, stamp_ns)

    def note_many(
        self, kind: str, numbers: IntArray, stamps: IntArray, bad: NDArray[np.bool_]
    ) -> None:
        """
        Count the messages that a mask marks.

        :param kind: what is wrong with them.
        :param numbers: places in the topic, shape (n,).
        :param stamps: header stamps [ns], shape (n,).
        :param bad: which are faulty, shape (n,).
        """
        for number, stamp in zip(numbers[bad].tolist(), stamps[bad].tolist(), strict=True):
            self.note(kind, number, stamp)

    def sentences(self, total: int, epoch_ns: int) -> Iterator[str]:
        """
        Yield one sentence a kind.

        :param total: messages of the topic.
        :param epoch_ns: header stamp of time zero [ns].
        :return: sentences that name the topic, the count and the first place.
        """
        for kind, members in self._members.items():
            number, stamp = self._first[kind]
            yield (
                f'{self._topic}: {len(members)} of {total} messages left out ({kind}), first '
                f'message {number} at {(stamp - epoch_ns) / 1e9:.6f} s'
            )


def increasing(stamp: IntArray, number: IntArray, faults: Faults) -> NDArray[np.bool_]:
    """
    Mark the samples whose stamp comes after all before them, as a live node takes them.

    :param stamp: header stamps [ns] in the order of arrival, shape (n,).
    :param number: places in the topic, shape (n,).
    :param faults: where to count the others.
    :return: which to keep, shape (n,).
    """
    keep = np.ones(stamp.size, dtype=np.bool_)
    keep[1:] = stamp[1:] > np.maximum.accumulate(stamp)[:-1]
    faults.note_many(BACKWARD, number, stamp, ~keep)
    return keep
