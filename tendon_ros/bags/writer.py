"""Write a :class:`~tendon_ros.base.recording.Recording` as a rosbag2."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import heapq
from pathlib import Path
import shutil
import tempfile

from tendon_ros.bags.all_or_nothing import all_or_nothing
from tendon_ros.bags.bag_writer import BagWriter, check_storage, Storage
from tendon_ros.bags.encoding import Batch, joint_states, wrenches
from tendon_ros.bags.place import check_bag_output
from tendon_ros.bags.stamps import END
from tendon_ros.bags.topics import (
    check_namespace,
    clean_namespace,
    DEFAULT_NAMESPACE,
    full_topic,
    place_of,
    TOPIC_TYPES,
    WRENCH_TOPICS,
)
from tendon_ros.base.errors import OutputError, RecordingError
from tendon_ros.base.recording import Channel, Recording

#: file name endings that ask for one file instead of a folder
FILE_STORAGE: Mapping[str, Storage] = {'.mcap': 'mcap', '.db3': 'sqlite3'}


def write_recording(
    recording: Recording,
    path: Path | str,
    *,
    namespace: str = DEFAULT_NAMESPACE,
    storage: Storage = 'mcap',
    compress: bool = True,
    overwrite: bool = False,
) -> Path:
    """
    Write a recording as a bag; either the whole bag appears, or none.

    :param recording: what to write; every channel needs a topic.
    :param path: folder of the bag, or a single file where it ends in ``.mcap`` or ``.db3``.
    :param namespace: of the instrument.
    :param storage: ``mcap`` or ``sqlite3``; the ending of a single file decides by itself.
    :param compress: compress the chunks of an MCAP.
    :param overwrite: replace a bag that is there; anything else is never replaced.
    :return: the path.
    :raises RecordingError: where a channel has no topic, or ROS cannot use the namespace.
    :raises OutputError: where the bag cannot be written, or something is in its place.
    """
    path = Path(path)
    check_namespace(namespace)
    check_bag_output(path, overwrite=overwrite)
    storage = FILE_STORAGE.get(path.suffix, storage)
    check_storage(path, storage)
    single = path.suffix in FILE_STORAGE
    batches = _batches(recording)
    metadata = {
        **recording.metadata,
        'namespace': clean_namespace(namespace) or '/',
        'epoch_ns': str(recording.epoch_ns),
        'channels': ','.join(sorted(recording.channels)),
    }
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=f'.{path.name}-', dir=path.parent))
    except OSError as error:
        raise OutputError(
            f'{path}: cannot be created ({error}); give a folder that can be written'
        ) from error
    try:
        with (
            all_or_nothing(path),
            BagWriter(
                part / path.stem if single else part / path.name,
                storage=storage,
                compress=compress,
                metadata=metadata,
            ) as bag,
        ):
            for topic in batches:
                bag.add_topic(full_topic(namespace, topic), TOPIC_TYPES[topic])
            for stamp, topic, cdr in _in_order(batches):
                bag.write_raw(full_topic(namespace, topic), cdr, stamp)
        done = bag.path / f'{path.stem}{path.suffix}' if single else bag.path
        _put(done, path)
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return path


def _put(done: Path, path: Path) -> None:
    """Move a bag to its place, where another bag may be."""
    try:
        if path.is_dir():
            shutil.rmtree(path)
        done.replace(path)
    except OSError as error:
        raise OutputError(
            f'{path}: cannot be replaced ({error.strerror}); give another path'
        ) from error


def _batches(recording: Recording) -> dict[str, list[Batch]]:
    """Return the messages of each topic."""
    topics: dict[str, dict[tuple[str, str], Channel]] = {}
    for name, channel in recording.channels.items():
        topic, joint, field = place_of(name)
        topics.setdefault(topic, {})[joint, field] = channel
    epoch = recording.epoch_ns
    out: dict[str, list[Batch]] = {}
    for topic, channels in sorted(topics.items()):
        if topic in WRENCH_TOPICS:
            fields = {field: channel for (_, field), channel in channels.items()}
            out[topic] = list(wrenches(topic, fields, epoch))
        else:
            out[topic] = list(joint_states(channels, epoch))
        first = min((int(stamps[0]) for stamps, _ in out[topic] if stamps.size), default=0)
        last = max((int(stamps[-1]) for stamps, _ in out[topic] if stamps.size), default=0)
        if first < 0:
            raise RecordingError(
                f'{recording.name}: {topic} has a stamp before 1970 ({first} ns); '
                'set a later epoch'
            )
        if last >= END:
            raise RecordingError(
                f'{recording.name}: {topic} has a stamp that ROS has no room for, after January '
                f'2038 ({last} ns); set an earlier epoch'
            )
    return out


def _in_order(batches: Mapping[str, Sequence[Batch]]) -> Iterator[tuple[int, str, bytes]]:
    """Yield stamp, topic and message of all batches by stamp."""

    def rows(topic: str, batch: Batch) -> Iterator[tuple[int, str, bytes]]:
        for stamp, cdr in zip(batch[0].tolist(), batch[1], strict=True):
            yield stamp, topic, cdr

    streams = [rows(topic, batch) for topic, some in batches.items() for batch in some]
    return heapq.merge(*streams, key=lambda row: row[0])
