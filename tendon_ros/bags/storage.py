"""Open bags of any kind and turn every failure into one line that names the mend."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
import sqlite3
from typing import Any

from mcap.exceptions import McapError
from mcap.reader import make_reader
from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader
import yaml

from tendon_ros.base.errors import RecordingError

SUFFIXES = ('.mcap', '.db3')

_MEND = 'run `tendon recover` on it and use what that writes'


def storage_files(path: Path) -> list[Path]:
    """
    Return the files that hold the messages of a bag.

    :param path: folder of a bag, or a single file.
    :return: existing files, in the order of their names.
    :raises RecordingError: where there is nothing that looks like a bag.
    """
    if not path.exists():
        raise RecordingError(f'{path}: does not exist; give the folder or the file of a bag')
    if path.is_dir():
        files = sorted(p for p in path.iterdir() if p.suffix in SUFFIXES and p.is_file())
    else:
        files = [path] if path.suffix in SUFFIXES else []
    if not files and not (path / 'metadata.yaml').is_file():
        raise RecordingError(
            f'{path}: not a bag; give a folder with metadata.yaml, or a file that ends in '
            f'{" or ".join(SUFFIXES)}; `tendon import` makes bags of other files, such as CSV'
        )
    return files


@contextmanager
def open_bag(path: Path) -> Iterator[Reader]:
    """
    Open a bag for reading.

    :param path: folder of a bag, or a single ``.mcap`` or ``.db3`` file.
    :return: a context that gives the reader.
    :raises RecordingError: where the bag is unfinished, damaged or may not be read.
    """
    files = storage_files(path)
    if any(file.suffix == '.db3' for file in files) and (odd := not_in_uri(path)):
        raise RecordingError(f'{path}: SQLite cannot open a path with {odd}; rename it')
    if path.is_dir() and not (path / 'metadata.yaml').is_file():
        raise RecordingError(
            f'{path}: no metadata.yaml, its writer was stopped before it finished; {_MEND}'
        )
    with _explained(path):
        reader = Reader(path)
        reader.open()
    try:
        yield reader
    finally:
        reader.close()


def not_in_uri(path: Path) -> str:
    """
    Return what of a path SQLite would not take as it stands: rosbags gives it as a URI.

    :param path: of an SQLite bag.
    :return: the characters; empty for most paths.
    """
    return ' and '.join(character for character in '#?%' if character in str(path))


def messages(
    path: Path, reader: Reader, connections: Sequence[Connection]
) -> Iterator[tuple[str, int, bytes]]:
    """
    Yield the messages of some topics, and check that all that were promised come.

    :param path: of the bag.
    :param reader: the open bag.
    :param connections: whose messages; none for none.
    :return: topic, log time [ns], serialised message.
    :raises RecordingError: where messages are missing.
    """
    promised = sum(connection.msgcount for connection in connections)
    read = 0
    if connections:
        with _explained(path):
            for connection, stamp, cdr in reader.messages(connections):
                read += 1
                yield connection.topic, stamp, bytes(cdr)
    if read < promised:
        raise RecordingError(
            f'{path}: truncated or damaged ({read} of {promised} messages are left); {_MEND}'
        )


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Turn what the libraries raise on a damaged file, which is nearly anything, into one line."""
    try:
        yield
    except PermissionError as error:
        raise RecordingError(f'{path}: may not be read ({error.strerror}); allow it') from error
    except Exception as error:
        detail = ' '.join(str(error).split()).rstrip('.') or type(error).__name__
        raise RecordingError(f'{path}: truncated or damaged ({detail}); {_MEND}') from error


def bag_metadata(path: Path) -> dict[str, str]:
    """
    Return the text that the writer of a bag left in ``custom_data``.

    :param path: folder of a bag, or a single file; a file carries a copy of metadata.yaml.
    :return: key → text; empty where there is none.
    """
    try:
        if path.is_dir():
            text = (path / 'metadata.yaml').read_text(encoding='utf-8')
        else:
            text = _embedded(path)
        info: Any = yaml.safe_load(text) or {}
        custom = info.get('rosbag2_bagfile_information', info).get('custom_data')
    except (OSError, ValueError, AttributeError, sqlite3.Error, McapError, yaml.YAMLError):
        return {}
    if not isinstance(custom, Mapping):
        return {}
    return {str(key): str(value) for key, value in custom.items()}


def _embedded(path: Path) -> str:
    """Return the metadata that a single file carries, empty where it carries none."""
    if path.suffix == '.mcap':
        with path.open('rb') as stream:
            for record in make_reader(stream).iter_metadata():
                if record.name == 'rosbag2':
                    return str(record.metadata.get('serialized_metadata', ''))
        return ''
    with closing(sqlite3.connect(f'{path.absolute().as_uri()}?immutable=1', uri=True)) as database:
        rows = database.execute('SELECT metadata FROM metadata ORDER BY id DESC').fetchall()
    return str(rows[0][0]) if rows else ''
