"""Make a bag again of what a killed writer or a full disk left behind."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing, suppress
from dataclasses import dataclass
from glob import escape
import json
import os
from pathlib import Path
import shutil
import sqlite3
import tempfile

from mcap.records import Channel, Message, Metadata, Schema
from rosbags.interfaces import Qos
from rosbags.rosbag2.metadata import parse_qos
import yaml

from tendon_ros.bags.all_or_nothing import all_or_nothing
from tendon_ros.bags.bag_writer import BagWriter, SIDECAR, Storage
from tendon_ros.bags.mcap_salvage import salvage
from tendon_ros.bags.place import METADATA
from tendon_ros.bags.storage import bag_metadata, storage_files
from tendon_ros.base.errors import RecordingError

#: no database is padded beyond this; a damaged header may ask for anything [bytes]
_LARGEST = 2**36


@dataclass(frozen=True)
class RecoverySummary:
    """
    What :func:`recover` found: messages by topic, and whether a file was cut or damaged.

    ``damaged`` is None where all is sound that is there, and nothing tells whether that is all.
    """

    out: Path
    counts: Mapping[str, int]
    damaged: bool | None

    @property
    def messages(self) -> int:
        """All messages that were recovered."""
        return sum(self.counts.values())


def recover(path: Path | str, out: Path | str) -> RecoverySummary:
    """
    Copy every message that can still be read into a new bag, with its topic, type and QoS.

    :param path: folder or file of the damaged bag; it is not changed.
    :param out: folder of the new bag; must not exist.
    :return: what was recovered.
    :raises RecordingError: where nothing can be read, or ``out`` exists.
    :raises OutputError: where ``out`` cannot be written.
    """
    path, out = Path(path), Path(out)
    files = storage_files(path)
    if out.exists():
        raise RecordingError(f'{out}: exists; give the path of a bag that does not exist')
    kinds = {file.suffix for file in files}
    if len(kinds) != 1:
        raise RecordingError(
            f'{path}: holds {len(files)} storage files of {len(kinds)} kinds; name the one to '
            'recover'
        )
    storage: Storage = 'mcap' if kinds == {'.mcap'} else 'sqlite3'
    with all_or_nothing(out):
        bag = BagWriter(out, storage=storage, metadata=_left_metadata(path))
    try:
        with all_or_nothing(out), bag:
            copy = _copy_mcap if storage == 'mcap' else _copy_sqlite
            whole = [copy(file, bag) for file in files]
            bag.set_metadata('recovered_from', str(path))
        if not any(bag.counts.values()):
            raise RecordingError(
                f'{path}: no message can be read any more; record again, or look for a copy'
            )
    except BaseException:
        shutil.rmtree(out, ignore_errors=True)
        raise
    unsure = None in whole and False not in whole
    return RecoverySummary(out, dict(bag.counts), None if unsure else not all(whole))


def _left_metadata(path: Path) -> dict[str, str]:
    """Return the metadata of an unfinished bag, of a finished one, or none."""
    with suppress(OSError, ValueError, AttributeError):
        folder = path if path.is_dir() else path.parent
        left = json.loads((folder / SIDECAR).read_text(encoding='utf-8'))
        return {str(key): str(value) for key, value in left.items()}
    return bag_metadata(path)


def _copy_mcap(path: Path, bag: BagWriter) -> bool:
    """Copy what is left of an MCAP file; return whether it was complete."""
    schemas: dict[int, Schema] = {}
    topics: dict[int, str] = {}
    for record in salvage(path):
        if record is None:
            return True
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel) and record.schema_id in schemas:
            schema = schemas[record.schema_id]
            # What a damaged record announces may contradict an earlier one, which then holds.
            with suppress(RecordingError):
                bag.add_topic(
                    record.topic,
                    schema.name,
                    _qos(record.metadata.get('offered_qos_profiles', '')),
                    definition=schema.data.decode(errors='replace'),
                    digest=record.metadata.get('topic_type_hash'),
                )
                topics[record.id] = record.topic
        elif isinstance(record, Message) and record.channel_id in topics:
            bag.write_raw(topics[record.channel_id], record.data, record.log_time)
        elif isinstance(record, Metadata) and record.name == 'rosbag2':
            for key, value in _custom(record.metadata).items():
                bag.set_metadata(key, value)
    return False


def _custom(metadata: Mapping[str, str]) -> dict[str, str]:
    """Return the text that the writer left, none where it is damaged."""
    with suppress(yaml.YAMLError, AttributeError):
        info = yaml.safe_load(metadata.get('serialized_metadata', '')) or {}
        return {str(key): str(value) for key, value in (info.get('custom_data') or {}).items()}
    return {}


def _copy_sqlite(path: Path, bag: BagWriter) -> bool | None:
    """Copy what is left of an SQLite file; return whether it was complete, None for unknown."""
    with tempfile.TemporaryDirectory() as folder:
        # Opened for writing, so that SQLite itself undoes the transaction that was cut off; on a
        # copy, so that the damaged bag stays as it is.
        for file in path.parent.glob(f'{escape(path.name)}*'):
            try:
                shutil.copy(file, folder)
            except OSError as error:
                raise RecordingError(
                    f'{file}: cannot be copied to {folder} ({error.strerror}); make room there, '
                    'or set TMPDIR to a folder with room'
                ) from error
        _pad(Path(folder) / path.name)
        with closing(sqlite3.connect(Path(folder) / path.name)) as database:
            try:
                _copy_rows(database, bag)
                (verdict,) = database.execute('PRAGMA quick_check').fetchone()
                finished = _finished(database, path)
            except sqlite3.Error:
                return False
    return finished if verdict == 'ok' else False


def _finished(database: sqlite3.Connection, path: Path) -> bool | None:
    """Tell whether the writer of an SQLite file came to its end, None where nothing tells."""
    tables = {row[0] for row in database.execute('SELECT name FROM sqlite_master')}
    if 'metadata' in tables:
        return bool(database.execute('SELECT count(*) FROM metadata').fetchone()[0])
    # before ROS 2 Iron only the file beside it said so
    return (path.parent / METADATA).is_file() or None


def _pad(path: Path) -> None:
    """Bring a file to the length in its header; SQLite refuses one that is cut off altogether."""
    with path.open('r+b') as stream:
        header = stream.read(32)
        page = int.from_bytes(header[16:18], 'big')
        size = (65536 if page == 1 else page) * int.from_bytes(header[28:32], 'big')
        if stream.seek(0, os.SEEK_END) < size < _LARGEST:
            stream.truncate(size)


def _copy_rows(database: sqlite3.Connection, bag: BagWriter) -> None:
    """Copy topics and messages until the database gives no more."""
    columns = {row[1] for row in database.execute('PRAGMA table_info(topics)')}
    qos_column = 'offered_qos_profiles' if 'offered_qos_profiles' in columns else "''"
    definitions: dict[str, tuple[str, str | None]] = {}
    with suppress(sqlite3.Error):
        query = (
            'SELECT topic_type, encoded_message_definition, type_description_hash '
            'FROM message_definitions'
        )
        definitions = {kind: (text, digest) for kind, text, digest in database.execute(query)}
    topics: dict[int, str] = {}
    query = f'SELECT id, name, type, {qos_column} FROM topics'
    for number, name, kind, text in database.execute(query):
        # before ROS 2 Iron no definitions were kept
        definition, digest = definitions.get(kind, ('', None))
        # As in an MCAP: what contradicts an earlier topic is left out.
        with suppress(RecordingError):
            bag.add_topic(name, kind, _qos(text), definition=definition, digest=digest)
            topics[number] = name
    # By row, not by the index over time: an index that is cut off would end the copy early.
    for topic, stamp, data in database.execute(
        'SELECT topic_id, timestamp, data FROM messages NOT INDEXED ORDER BY id'
    ):
        if topic in topics:
            bag.write_raw(topics[topic], data, stamp)


def _qos(text: str) -> Qos | None:
    """Return the first profile, None where there is none that can be understood."""
    with suppress(Exception):
        return next(iter(parse_qos(text)), None)
    return None
