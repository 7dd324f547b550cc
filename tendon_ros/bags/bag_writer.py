"""
Write a rosbag2 as messages come, so that little is lost when the process is killed.

Everything written up to one flush interval ago is on its way to the disk: a complete chunk of the
MCAP, a committed transaction of the SQLite file. ``tendon recover`` makes a bag of that, also
where the disk is full.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
import json
from pathlib import Path
import shutil
import sqlite3
from types import TracebackType
from typing import Literal, Self

from rosbags.interfaces import Connection, Qos
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.rosbag2.errors import WriterError
from rosbags.rosbag2.storage_mcap import McapWriter
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer

from tendon_ros import __version__
from tendon_ros.bags.messages import definition_of
from tendon_ros.bags.qos import offered_qos
from tendon_ros.bags.storage import not_in_uri
from tendon_ros.base.errors import listed, OutputError, RecordingError

Storage = Literal['mcap', 'sqlite3']

#: how much recorded time a killed process may lose [ns]
FLUSH_NS = 10**9

#: metadata of an unfinished bag; removed when the bag is closed
SIDECAR = 'custom_data.json'

#: what every bag of this package says about its numbers
CONVENTIONS: Mapping[str, str] = {
    'writer': f'tendon_ros {__version__}',
    'units': 'SI: rad, rad/s, N m, N; header stamps in ns',
    'sign_convention': (
        'actuator effort: torque that the motor applies to its pulley, positive along +theta; '
        'load_cell and body wrench: what the instrument applies to what it touches, positive when '
        'it pushes along the joint'
    ),
}

_PLUGINS = {'mcap': StoragePlugin.MCAP, 'sqlite3': StoragePlugin.SQLITE3}
#: how the storages say that the disk refuses
_REFUSED = (OSError, sqlite3.OperationalError)


def check_storage(path: Path, storage: str) -> None:
    """
    Check that a storage can be written to a path.

    :param path: folder of the bag, or a single file.
    :param storage: ``mcap`` or ``sqlite3``.
    :raises RecordingError: where there is no such storage.
    :raises OutputError: where SQLite cannot open such a path.
    """
    if storage not in _PLUGINS:
        raise RecordingError(f'{path}: storage {storage!r} unknown; use {listed(_PLUGINS)}')
    if storage == 'sqlite3' and (odd := not_in_uri(path)):
        raise OutputError(
            f'{path}: SQLite cannot open a path with {odd}; give another one, or write an MCAP'
        )


class BagWriter:
    """
    A rosbag2 of version 9 that is being written; a context manager.

    Leaving the context closes the bag, also on an error: what was recorded stays readable. Where
    the disk refused something, the bag stays unfinished, as ``tendon recover`` takes it. Any
    thread may write, one at a time.

    :param path: folder of the bag; must not exist.
    :param storage: ``mcap`` or ``sqlite3``.
    :param compress: compress the chunks of an MCAP with zstd; every MCAP reader knows it.
    :param metadata: text to keep in the bag's ``custom_data``.
    :raises RecordingError: where there is no such storage.
    :raises OutputError: where the bag cannot be created.
    """

    def __init__(
        self,
        path: Path | str,
        *,
        storage: Storage = 'mcap',
        compress: bool = True,
        metadata: Mapping[str, str] | None = None,
    ) -> None:
        self.path = Path(path)
        check_storage(self.path, storage)
        self._flushed_ns: int | None = None
        self._connections: dict[str, Connection] = {}
        self._metadata = {**(metadata or {}), **CONVENTIONS}
        self._closed = False
        self._refused = False
        self.counts: dict[str, int] = {}
        try:
            self._writer = Writer(self.path, version=9, storage_plugin=_PLUGINS[storage])
        except (WriterError, OSError) as error:
            raise self._not_created(error) from error
        if compress and storage == 'mcap':
            self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        try:
            self._writer.open()
            self._for_all_threads()
            self._save_sidecar()
        except (WriterError, *_REFUSED) as error:
            self._abort()
            if not isinstance(error, WriterError):  # which says that another has just made it
                shutil.rmtree(self.path, ignore_errors=True)
            raise self._not_created(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def set_metadata(self, key: str, value: str) -> None:
        """
        Keep a text in the bag; a later value for the same key replaces it.

        :param key: for instance ``instrument``.
        :param value: any text.
        :raises OutputError: where the disk refuses.
        """
        self._metadata[key] = value
        try:
            self._save_sidecar()
        except OSError as error:
            raise self._not('written', error) from error

    def add_topic(
        self,
        name: str,
        msgtype: str,
        qos: Qos | None = None,
        *,
        definition: str | None = None,
        digest: str | None = None,
    ) -> None:
        """
        Announce a topic; nothing happens where it is there already with that type.

        :param name: absolute name of the topic.
        :param msgtype: for instance ``sensor_msgs/msg/JointState``.
        :param qos: what its publisher offers; None for reliable with depth 10.
        :param definition: the message definition, for types that Jazzy's common interfaces lack;
            empty where it is lost.
        :param digest: the type's RIHS01 hash; None to compute it.
        :raises RecordingError: for a type without definition, or another type than before.
        :raises OutputError: where the disk refuses.
        """
        known = self._connections.get(name)
        if known is not None and known.msgtype != msgtype:
            raise RecordingError(
                f'{self.path}: topic {name} is {known.msgtype} and cannot become {msgtype}; '
                'record it under another name'
            )
        if known is not None:
            return
        text, rihs01 = definition_of(msgtype, definition, digest)
        try:
            self._connections[name] = self._writer.add_connection(
                name,
                msgtype,
                msgdef=text,
                rihs01=rihs01,
                offered_qos_profiles=[qos or offered_qos()],
            )
        except _REFUSED as error:
            raise self._not('written', error) from error
        self.counts[name] = 0

    def write_raw(self, topic: str, cdr: bytes, log_time_ns: int) -> None:
        """
        Append a message.

        :param topic: a topic that was added.
        :param cdr: the message as it was received.
        :param log_time_ns: when it was received [ns].
        :raises RecordingError: for an unknown topic.
        :raises OutputError: where the disk refuses.
        """
        connection = self._connections.get(topic)
        if connection is None:
            raise RecordingError(
                f'{self.path}: topic {topic} was not added; it has {listed(self._connections)}'
            )
        if self._flushed_ns is None:
            self._flushed_ns = log_time_ns
        try:
            self._writer.write(connection, log_time_ns, cdr)
            self.counts[topic] += 1
            # A clock that was set back counts as elapsed too, or nothing would be flushed.
            if abs(log_time_ns - self._flushed_ns) >= FLUSH_NS:
                self._flush()
                self._flushed_ns = log_time_ns
        except _REFUSED as error:
            raise self._not('written', error) from error

    def _for_all_threads(self) -> None:
        """Open the database so that callbacks may write what another thread has made."""
        storage = self._writer.storage
        if isinstance(storage, Sqlite3Writer):
            storage.conn.close()
            storage.conn = sqlite3.connect(storage.path, check_same_thread=False)
            storage.cursor = storage.conn.cursor()

    def _flush(self) -> None:
        """Hand everything written so far to the operating system."""
        storage = self._writer.storage
        if isinstance(storage, McapWriter):
            if storage.chunk.msgs:
                storage.close_chunk()
            storage.bio.flush()
        elif isinstance(storage, Sqlite3Writer):
            storage.conn.commit()

    def close(self) -> None:
        """
        Finish the bag: index and metadata. A second call does nothing.

        :raises OutputError: where the disk refuses; where it did before, the bag is only let go.
        """
        if self._closed:
            return
        self._closed = True
        if self._refused:
            # What was refused is there in part: an index behind it would tell of what is not.
            self._abort()
            return
        if not any(self.counts.values()):
            # The format has no empty time span; rosbags would note the largest integer as start.
            self._writer.min_timestamp = 0
        for key, value in sorted(self._metadata.items()):
            self._writer.set_custom_data(key, value)
        try:
            self._writer.close()
            (self.path / SIDECAR).unlink(missing_ok=True)
        except _REFUSED as error:
            self._abort()
            raise self._not('finished', error) from error

    def _abort(self) -> None:
        """Let go of the files; what is still to be written is refused once more."""
        with suppress(*_REFUSED):
            self._writer.abort()

    def _save_sidecar(self) -> None:
        """Save the metadata so that, on a full disk, those from before stay."""
        part = self.path / f'{SIDECAR}.part'
        part.write_text(json.dumps(self._metadata, indent=1), encoding='utf-8')
        part.replace(self.path / SIDECAR)

    def _not(self, done: str, error: Exception) -> OutputError:
        """Return the error of a disk that refused; from now on the bag is left as it is."""
        self._refused = True
        return OutputError(
            f'{self.path}: cannot be {done} ({error}); make room, then `tendon recover` it'
        )

    def _not_created(self, error: Exception) -> OutputError:
        return OutputError(
            f'{self.path}: cannot be created ({error}); give the path of a bag that does not '
            'exist in a folder that can be written'
        )
