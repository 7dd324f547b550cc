"""WrenchStamped messages → channels of force and torque."""

from __future__ import annotations

from typing import Any

import numpy as np

from tendon_ros.bags.faults import Faults, increasing, NOT_FINITE
from tendon_ros.bags.stamps import to_seconds
from tendon_ros.bags.topics import WRENCH_TOPICS
from tendon_ros.base.recording import Channel


class Wrenches:
    """
    Collects the messages of one topic.

    :param topic: relative topic.
    :param listed: the channels that the bag's writer named; None where it named none.
    :param faults: where to count what is left out.
    """

    def __init__(self, topic: str, listed: set[str] | None, faults: Faults) -> None:
        self._names = WRENCH_TOPICS[topic]
        self._listed = listed
        self._faults = faults
        self._rows: list[tuple[int, int, float, float]] = []

    def add(self, message: Any, stamp_ns: int, number: int) -> None:
        """
        Take in a message.

        :param message: a decoded WrenchStamped.
        :param stamp_ns: its header stamp [ns].
        :param number: its place in the topic, from 1.
        """
        wrench = message.wrench
        self._rows.append((stamp_ns, number, wrench.force.y, wrench.torque.z))

    def first_stamp(self) -> int | None:
        """Return the smallest stamp [ns], None without messages."""
        return min((row[0] for row in self._rows), default=None)

    def _measured(self, force: bool, torque: bool) -> list[bool]:
        """Say which of force and torque was measured; a wrench has no word for it."""
        if self._listed is not None:
            return [name in self._listed for name in self._names]
        # Zero throughout beside one that is not means that the sensor has no such axis. Both
        # zero is a force sensor that touches nothing.
        return [force or not torque, torque]

    def channels(self, epoch_ns: int) -> list[Channel]:
        """
        Return what was collected.

        :param epoch_ns: header stamp of time zero [ns].
        :return: the channels of force and torque that were measured.
        """
        if not self._rows:
            return []
        stamp = np.array([row[0] for row in self._rows], dtype=np.int64)
        values = np.array([row[2:] for row in self._rows], dtype=np.float64)
        number = np.array([row[1] for row in self._rows], dtype=np.int64)
        out = []
        measured = self._measured(*(bool(np.any(values[:, k] != 0.0)) for k in range(2)))
        for k, name in enumerate(self._names):
            finite = np.isfinite(values[:, k])
            if not measured[k] or not finite.any():
                continue
            self._faults.note_many(f'{name} is {NOT_FINITE}', number, stamp, ~finite)
            times, value = stamp[finite], values[finite, k]
            keep = increasing(times, number[finite], self._faults)
            out.append(Channel(name, to_seconds(times[keep], epoch_ns), value[keep]))
        return out
