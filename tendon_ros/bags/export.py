"""
Write a recording as CSV, for PlotJuggler, spreadsheets and other programs.

A path that ends in ``.csv`` becomes one wide file on the union of all stamps, with an empty cell
where a channel has no sample. Any other path becomes a folder with one file for each group of
channels that share their stamps, without empty cells. The first column is the time that
PlotJuggler offers as axis; slashes in the names make its tree; units stand in brackets.
"""

from __future__ import annotations

from collections.abc import Iterable
import csv
from pathlib import Path

import numpy as np

from tendon_ros.bags.stamps import IntArray, to_stamps
from tendon_ros.base.errors import OutputError
from tendon_ros.base.outputs import check_output
from tendon_ros.base.recording import Channel, Recording

TIME_COLUMN = 'time [s]'
STAMP_COLUMN = 'stamp [ns]'


def export_csv(recording: Recording, out: Path | str, *, overwrite: bool = False) -> list[Path]:
    """
    Write a recording as CSV.

    :param recording: what to write.
    :param out: a file that ends in ``.csv``, or a folder.
    :param overwrite: replace files that are there.
    :return: the files written.
    :raises OutputError: where a file exists or cannot be written.
    """
    out = Path(out)
    if out.suffix == '.csv':
        files = {out: list(recording.channels.values())}
    else:
        files = _by_stamps(recording, out)
    for path in files:
        check_output(path, overwrite=overwrite)
    for path, channels in files.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            _write(path, channels, recording.epoch_ns)
        except OSError as error:
            raise OutputError(
                f'{path}: cannot be written ({error}); give a folder that can be written'
            ) from error
    return list(files)


def _by_stamps(recording: Recording, folder: Path) -> dict[Path, list[Channel]]:
    """Group the channels of a kind that share their stamps, and name a file for each group."""
    groups: list[tuple[str, list[Channel]]] = []
    for channel in recording.channels.values():
        kind = channel.name.partition('/')[0]
        for other, members in groups:
            if other == kind and np.array_equal(members[0].time, channel.time):
                members.append(channel)
                break
        else:
            groups.append((kind, [channel]))
    files: dict[Path, list[Channel]] = {}
    for kind, members in groups:
        alone = sum(other == kind for other, _ in groups) == 1
        name = kind if alone else members[0].name.replace('/', '_')
        files[folder / f'{name}.csv'] = members
    return files


def _cells(channel: Channel, stamps: IntArray, epoch_ns: int) -> list[str]:
    """Return the channel's values at the stamps, an empty cell where it has none."""
    cells = np.full(stamps.size, '', dtype=object)
    # repr() gives the shortest text that reads back as the same number.
    rows = np.searchsorted(stamps, to_stamps(channel.time, epoch_ns))
    cells[rows] = [repr(value) for value in channel.value.tolist()]
    return list(cells)


def _write(path: Path, channels: Iterable[Channel], epoch_ns: int) -> None:
    channels = list(channels)
    stamps = np.unique(np.concatenate([to_stamps(c.time, epoch_ns) for c in channels]))
    seconds = [f'{(stamp - epoch_ns) / 1e9:.9f}' for stamp in stamps.tolist()]
    columns = [_cells(channel, stamps, epoch_ns) for channel in channels]
    with path.open('w', newline='', encoding='utf-8') as stream:
        table = csv.writer(stream)
        names = [f'{channel.name} [{channel.unit}]' for channel in channels]
        table.writerow([TIME_COLUMN, STAMP_COLUMN, *names])
        table.writerows(zip(seconds, stamps.tolist(), *columns, strict=True))
