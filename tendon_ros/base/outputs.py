"""
Where results may go: checked before anything is computed, so that neither work nor a file is lost.

What is read is never replaced, and what is there only where the user allows it.
"""

from __future__ import annotations

from collections.abc import Iterable
import os
from pathlib import Path

from tendon_ros.base.errors import OutputError

#: the mend where something is there already
ANOTHER = 'give another path, or --overwrite to replace it'


def check_output(path: Path, read: Iterable[Path] = (), *, overwrite: bool = False) -> None:
    """
    Check that a file may be written.

    :param path: the file; who writes it makes the folders above it.
    :param read: the files that are read for it.
    :param overwrite: whether it may replace a file that is there.
    :raises OutputError: where it cannot be written, or would replace what it must not.
    """
    check_reachable(path)
    check_not_read(path, read)
    if path.is_dir():
        raise OutputError(f'{path}: is a folder; give the path of a file')
    if path.exists() and not overwrite:
        raise OutputError(f'{path}: exists; {ANOTHER}')
    if path.exists() and not os.access(path, os.W_OK):
        raise OutputError(f'{path}: may not be written to; give another path')


def check_reachable(path: Path) -> None:
    """
    Check that something can be made at a path, with the folders above it.

    :param path: of a file or folder.
    :raises OutputError: where something on the way is no folder, or may not be written to.
    """
    try:
        above = next(p for p in path.absolute().parents if p.exists())
        path.exists()  # a name that no disk takes raises here
    except OSError as error:
        raise OutputError(f'{path}: {error.strerror}; give another path') from None
    if not above.is_dir():
        raise OutputError(f'{path}: {above} is a file, not a folder; give another path')
    if not os.access(above, os.W_OK | os.X_OK):
        raise OutputError(f'{path}: {above} may not be written to; give a path that can be')


def check_not_read(path: Path, read: Iterable[Path]) -> None:
    """
    Check that writing replaces nothing that is read.

    :param path: of the file or folder to write.
    :param read: the files that are read.
    :raises OutputError: where one of them is the output, or lies in it.
    """
    out = path.resolve()
    for one in read:
        file = one.resolve()
        if out == file or out in file.parents:
            raise OutputError(f'{path}: would replace {one}, which is read; give another path')
