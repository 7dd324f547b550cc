"""Where a bag may be written, and what it may replace: another bag, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

from tendon_ros.bags.storage import storage_files, SUFFIXES
from tendon_ros.base.errors import listed, OutputError
from tendon_ros.base.outputs import ANOTHER, check_not_read, check_reachable

METADATA = 'metadata.yaml'
#: files that a message names
NAMED = 3
#: what SQLite keeps beside a database that is open
_BESIDE = ('', '-wal', '-shm', '-journal')


def check_bag_output(path: Path, read: Iterable[Path] = (), *, overwrite: bool = False) -> None:
    """
    Check that a bag may be written.

    :param path: folder of the bag, or a single file.
    :param read: the files that are read for it, see :func:`files_of`.
    :param overwrite: whether it may replace a bag that is there.
    :raises OutputError: where it cannot be written, or would replace anything but a bag.
    """
    check_reachable(path)
    check_not_read(path, read)
    if path.is_symlink():
        raise OutputError(f'{path}: is a link; give the path of the bag itself')
    if not path.exists():
        return
    if not overwrite:
        raise OutputError(f'{path}: exists; {ANOTHER}')
    if not path.is_dir():
        other = [] if path.suffix in SUFFIXES else [path.name]
    else:
        other = _beside_a_bag(path)
    if other:
        raise OutputError(
            f'{path}: is no bag that could be replaced ({_some(other)}); give another path, or '
            'remove it yourself'
        )


def files_of(path: Path) -> list[Path]:
    """
    Return the files that are read of a bag.

    :param path: folder of a bag, or a single file.
    :return: existing files.
    :raises RecordingError: where there is nothing that looks like a bag.
    """
    files = storage_files(path)
    metadata = path / METADATA
    return [*files, metadata] if metadata.is_file() else files


def _beside_a_bag(folder: Path) -> list[str]:
    """Return what is in a folder and no part of the bag that its metadata describes."""
    try:
        info: Any = yaml.safe_load((folder / METADATA).read_text(encoding='utf-8'))
        # older bags name their files from the folder above
        names = [Path(f).name for f in info['rosbag2_bagfile_information']['relative_file_paths']]
    except (OSError, ValueError, KeyError, TypeError, yaml.YAMLError):
        own: set[str] = set()
    else:
        own = {METADATA, *(name + end for name in names for end in _BESIDE)}
    return [p.name for p in folder.iterdir() if p.name not in own or p.is_dir()]


def _some(names: list[str]) -> str:
    """Return the first of some names, and how many more there are."""
    more = len(names) - NAMED
    return f'{listed(sorted(names)[:NAMED])}{f" and {more} more" if more > 0 else ""}'
