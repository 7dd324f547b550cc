"""What is in a bag: topics, counts, rates, gaps and jitter on header stamps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
import struct
from typing import Any

import numpy as np

from tendon_ros.bags.messages import typestore
from tendon_ros.bags.stamps import IntArray
from tendon_ros.bags.storage import bag_metadata, messages, open_bag, storage_files

#: an interval this many times the usual one is a gap
GAP_FACTOR = 3.0


@dataclass(frozen=True)
class TopicInfo:
    """
    One topic: times in seconds, rate in Hz, None where too few messages tell.

    ``clock`` is ``header`` where the stamps come from the messages, else ``log``. ``jitter_p99``
    is the 99th percentile of the distance of an interval from the median interval.
    """

    name: str
    msgtype: str
    count: int
    clock: str
    start: float | None
    duration: float
    rate: float | None
    jitter_p99: float | None
    gaps: int
    longest_gap: float | None
    backward: int
    repeated: int


@dataclass(frozen=True)
class BagInfo:
    """A whole bag: ``duration`` on the clock of the log, the one that all its messages share."""

    path: str
    storage: str
    size: int
    messages: int
    duration: float
    topics: tuple[TopicInfo, ...]
    metadata: Mapping[str, str]

    def as_dict(self) -> dict[str, Any]:
        """Return the same as plain data, for JSON."""
        return {**asdict(self), 'metadata': dict(self.metadata)}


def summarise(path: Path | str) -> BagInfo:
    """
    Read a bag and tell what is in it.

    :param path: folder of a bag, or a single file.
    :return: the summary.
    :raises RecordingError: where the bag cannot be read.
    """
    path = Path(path)
    stamps: dict[str, list[int]] = {}
    logged: list[int] = []
    with open_bag(path) as reader:
        types = {c.topic: c.msgtype for c in reader.connections}
        clocks = {name: 'header' if _has_header(kind) else 'log' for name, kind in types.items()}
        for name, log_time, cdr in messages(path, reader, reader.connections):
            own = _header_stamp(cdr) if clocks[name] == 'header' else log_time
            stamps.setdefault(name, []).append(own)
            logged.append(log_time)
    files = storage_files(path)
    topics = tuple(
        _topic(name, types[name], clocks[name], np.array(stamps.get(name, []), dtype=np.int64))
        for name in sorted(types)
    )
    return BagInfo(
        path=str(path),
        storage='mcap' if any('.mcap' in file.name for file in files) else 'sqlite3',
        size=sum(file.stat().st_size for file in files),
        messages=sum(topic.count for topic in topics),
        duration=(max(logged) - min(logged)) / 1e9 if logged else 0.0,
        topics=topics,
        metadata=bag_metadata(path),
    )


def _has_header(msgtype: str) -> bool:
    """Say whether messages of a type start with a std_msgs/Header."""
    definition = typestore().fielddefs.get(msgtype)
    return bool(definition and definition[1] and definition[1][0][0] == 'header')


def _header_stamp(cdr: bytes) -> int:
    """Return the stamp [ns] that a serialised message with a header starts with."""
    if len(cdr) < 12:
        return 0
    sec, nanosec = struct.unpack_from('<iI' if cdr[1] & 1 else '>iI', cdr, 4)
    return int(sec) * 10**9 + int(nanosec)


def _topic(name: str, msgtype: str, clock: str, stamps: IntArray) -> TopicInfo:
    intervals = np.diff(stamps) / 1e9
    forward = intervals[intervals > 0.0]
    usual = float(np.median(forward)) if forward.size else None
    gaps = forward[forward > GAP_FACTOR * usual] if usual else forward
    return TopicInfo(
        name=name,
        msgtype=msgtype,
        count=int(stamps.size),
        clock=clock,
        start=float(stamps.min() / 1e9) if stamps.size else None,
        duration=float(np.ptp(stamps) / 1e9) if stamps.size else 0.0,
        rate=1.0 / usual if usual else None,
        jitter_p99=float(np.percentile(np.abs(forward - usual), 99)) if usual else None,
        gaps=int(gaps.size),
        longest_gap=float(forward.max()) if forward.size else None,
        backward=int(np.count_nonzero(intervals < 0.0)),
        repeated=int(np.count_nonzero(intervals == 0.0)),
    )
