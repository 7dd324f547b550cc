"""Message types of the bags: definitions, hashes, encoding and decoding, without ROS."""

from __future__ import annotations

from functools import cache
from typing import Any

from rosbags.typesys import get_types_from_msg, get_typestore, Stores
from rosbags.typesys.store import Typestore

from tendon_ros.base.errors import RecordingError

#: what stands for the hash of a type whose definition cannot be parsed, or is lost
UNKNOWN_HASH = 'RIHS01_' + '0' * 64


@cache
def typestore() -> Typestore:
    """Return the types of ROS 2 Jazzy; built once, since that takes a tenth of a second."""
    return get_typestore(Stores.ROS2_JAZZY)


def decode(cdr: bytes, msgtype: str) -> Any:
    """
    Return the message that was serialised.

    :param cdr: serialised message with its encapsulation header.
    :param msgtype: a type of Jazzy's common interfaces.
    :return: an object with the message's fields.
    """
    return typestore().deserialize_cdr(cdr, msgtype)


def encode(message: object, msgtype: str) -> bytes:
    """
    Return the message serialised, without trailing bytes.

    :param message: an object made from ``typestore().types``.
    :param msgtype: its type.
    :return: little-endian CDR with its encapsulation header.
    """
    return bytes(typestore().serialize_cdr(message, msgtype))


def definition_of(msgtype: str, definition: str | None, digest: str | None) -> tuple[str, str]:
    """
    Return what a bag stores about a type: its full definition and its hash.

    :param msgtype: for instance ``sensor_msgs/msg/JointState``.
    :param definition: the definition where it is known; empty where it is lost, and the messages
        shall be kept nevertheless; None where the type has to be a known one.
    :param digest: the RIHS01 hash where it is known, else None.
    :return: definition, hash.
    :raises RecordingError: for a type that is neither known nor defined.
    """
    if definition and digest:
        return definition, digest
    store = typestore()
    if msgtype in store.fielddefs:
        text = definition or store.generate_msgdef(msgtype, ros_version=2)[0]
        return text, digest or store.hash_rihs01(msgtype)
    if definition is None:
        raise RecordingError(
            f'{msgtype}: not among the common interfaces of Jazzy; give its definition'
        )
    if not definition:
        return '', digest or UNKNOWN_HASH
    own = get_typestore(Stores.ROS2_JAZZY)
    try:
        own.register(get_types_from_msg(definition, msgtype))
        return definition, digest or own.hash_rihs01(msgtype)
    except Exception:
        # A definition in IDL, say: the bytes are worth keeping even where we cannot read them.
        return definition, digest or UNKNOWN_HASH
