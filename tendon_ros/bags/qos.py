"""Quality of service that a bag notes for a topic, so that playback offers the same."""

from __future__ import annotations

from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)

#: messages that a publisher keeps
DEPTH = 10
_INFINITE = QosTime(9223372036, 854775807)


def offered_qos(*, reliable: bool = True, latched: bool = False) -> Qos:
    """
    Return the profile that a publisher offers.

    :param reliable: False for best effort.
    :param latched: True for transient-local, which serves late subscribers.
    :return: a profile for :meth:`tendon_ros.bags.bag_writer.BagWriter.add_topic`.
    """
    return Qos(
        QosHistory.KEEP_LAST,
        DEPTH,
        QosReliability.RELIABLE if reliable else QosReliability.BEST_EFFORT,
        QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE,
        _INFINITE,
        _INFINITE,
        QosLiveliness.AUTOMATIC,
        _INFINITE,
        avoid_ros_namespace_conventions=False,
    )
