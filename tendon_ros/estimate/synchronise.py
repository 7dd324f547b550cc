"""
Join what several topics say of the same instant.

Channels of one topic come together; different topics of one rig carry equal stamps, but arrive in
any order. A measurement is complete when every group that is needed has spoken for its stamp, so
the same bag gives the same measurements live and offline.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tendon_ros.estimate.observer import Measurement


class Synchroniser:
    """
    Joins values by stamp.

    :param needs: the channels that a measurement must have.
    :param patience: how many stamps may wait for their missing half before the oldest is dropped.
    """

    def __init__(self, needs: Iterable[str], patience: int = 200) -> None:
        self._needs = frozenset(needs)
        self._patience = patience
        self._waiting: dict[int, dict[str, float]] = {}
        #: stamps that were dropped because a needed channel never came
        self.dropped = 0

    def add(self, stamp_ns: int, values: Mapping[str, float]) -> Measurement | None:
        """
        Take in what one topic says of one instant.

        :param stamp_ns: header stamp [ns].
        :param values: by channel.
        :return: the measurement, where this completes one; stamps that waited for longer are then
            dropped, so that measurements come in order.
        """
        if self._needs.isdisjoint(values):
            return None
        known = self._waiting.setdefault(stamp_ns, {})
        known.update(values)
        if self._needs <= known.keys():
            for older in [s for s in self._waiting if s < stamp_ns]:
                del self._waiting[older]
                self.dropped += 1
            del self._waiting[stamp_ns]
            return Measurement(stamp_ns, dict(known))
        if len(self._waiting) > self._patience:
            del self._waiting[min(self._waiting)]
            self.dropped += 1
        return None
