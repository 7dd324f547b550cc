"""Diagnostics after REP-107: one status for a node."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from tendon_ros.nodes.conversions import to_stamp


class Level(Enum):
    """How well a node is; the values are bytes because the field of the message is one."""

    OK = b'\x00'
    WARN = b'\x01'
    ERROR = b'\x02'
    STALE = b'\x03'


def diagnostic_array(
    stamp_ns: int, name: str, level: Level, text: str, details: Mapping[str, object]
) -> DiagnosticArray:
    """
    Return a message for ``/diagnostics``.

    :param stamp_ns: header stamp [ns].
    :param name: of the node, without a slash in front.
    :param level: how well it is.
    :param text: one line.
    :param details: numbers to show beside it.
    :return: the message.
    """
    values = [KeyValue(key=key, value=_text(value)) for key, value in details.items()]
    status = DiagnosticStatus(
        level=level.value, name=name, message=text, hardware_id=name.split('/')[0], values=values
    )
    message = DiagnosticArray(status=[status])
    message.header.stamp = to_stamp(stamp_ns)
    return message


def _text(value: object) -> str:
    return f'{value:.6g}' if isinstance(value, float) else str(value)
