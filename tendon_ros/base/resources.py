"""
The files that come with the package: instruments, cable curves, parameter files.

Where they lie depends on how the package was installed. A source checkout (also an editable
install, or ``colcon build --symlink-install``) has them beside the package; pip and colcon put
them under ``share/tendon_ros`` of the prefix that holds the package.
"""

from __future__ import annotations

from collections.abc import Iterator
import os
from pathlib import Path

from tendon_ros.base.errors import listed, TendonError

_PACKAGE = Path(__file__).parent.parent


class ResourceError(TendonError):
    """A file that should have come with the package and is not there."""


def _candidates() -> Iterator[Path]:
    """Yield the folders that may hold ``config``, nearest to the running code first."""
    for package in (_PACKAGE, _PACKAGE.resolve()):
        checkout = package.parent
        # The index marker tells a checkout from a site-packages that some `config` stands in.
        if (checkout / 'resource' / 'tendon_ros').is_file():
            yield checkout
        for prefix in package.parents:
            yield prefix / 'share' / 'tendon_ros'
    for overlay in filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)):
        yield Path(overlay) / 'share' / 'tendon_ros'


def config_root() -> Path:
    """
    Return the folder ``config`` of this installation.

    :return: an existing folder.
    :raises ResourceError: where the package was installed without it.
    """
    for folder in _candidates():
        if (folder / 'config').is_dir():
            return folder / 'config'
    raise ResourceError(
        f'{_PACKAGE}: no share/tendon_ros/config in any folder above it nor in AMENT_PREFIX_PATH; '
        'install the package again with pip or colcon'
    )


def config_path(relative: str | Path) -> Path:
    """
    Return the path of a file or folder that comes with the package.

    :param relative: path below ``config``, for instance ``instruments/paper_rig.yaml``.
    :return: an existing path.
    :raises ResourceError: where there is none; the message lists what stands in its place.
    """
    root = config_root()
    path = root / relative
    if path.exists():
        return path
    folder = next(parent for parent in path.parents if parent.is_dir())
    raise ResourceError(
        f'{path}: does not exist; {folder} has {listed(entry.name for entry in folder.iterdir())}'
    )


def installed(name_or_path: str | Path, folder: str) -> Path | None:
    """
    Return a file that is given by its path, or by the name of one that comes with the package.

    :param name_or_path: a path, or a name with or without ``.yaml``.
    :param folder: below ``config``, that has such files.
    :return: an existing file; None where there is none.
    """
    path = Path(name_or_path)
    if path.is_file():
        return path
    own = config_path(folder) / f'{path.name.removesuffix(".yaml")}.yaml'
    return own if path.parent == Path() and own.is_file() else None


def installed_names(folder: str) -> str:
    """
    Return the names by which :func:`installed` knows files, for a message.

    :param folder: below ``config``, that has such files.
    :return: the names, listed.
    """
    return listed(file.stem for file in config_path(folder).glob('*.yaml'))
