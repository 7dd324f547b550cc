"""Foreign recordings → recordings by contract, as a mapping file says."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tendon_ros.bags.mapping import Mapping, Source, Time
from tendon_ros.bags.stamps import END, IntArray, to_seconds, to_stamps
from tendon_ros.bags.tables import read_tables, Table
from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.quantity import factor, parsed
from tendon_ros.base.recording import Channel, FloatArray, Recording, unit_of

BoolArray = NDArray[np.bool_]

YEAR = 365.25 * 86400.0  # [s]
LONGEST = 250.0 * YEAR  # since its epoch: what whole nanoseconds can say
#: stamps that stray further from an even spacing are worth a warning [share of the spacing]
JITTER = 0.5
#: part of all that it reads by which a reading begins anew
LEAP = 0.9
#: bits of the signed registers that drives have
REGISTERS = (16, 32)


def run_keys(path: Path | str, mapping: Mapping) -> list[str]:
    """
    Return the runs that a file holds.

    :param path: the foreign file.
    :param mapping: how to read it.
    :return: their keys, in the order of the file.
    """
    return list(read_tables(Path(path), mapping.format, mapping.runs))


def import_runs(
    path: Path | str, mapping: Mapping, select: Sequence[str] = ()
) -> Iterator[Recording]:
    """
    Yield the runs of a foreign file, one at a time.

    :param path: the foreign file.
    :param mapping: how to read it.
    :param select: keys of the runs wanted; none for all.
    :return: one recording a run, named by its key.
    :raises RecordingError: where the file does not fit the mapping.
    """
    path = Path(path)
    tables = read_tables(path, mapping.format, mapping.runs)
    missing = [key for key in select if key not in tables]
    if missing:
        raise RecordingError(f'{path}: no run {listed(missing)}; it has {listed(tables)}')
    for key in select or tables:
        yield _recording(path, tables[key](), mapping)


def _recording(path: Path, table: Table, mapping: Mapping) -> Recording:
    """Return a run as a recording."""
    place = f'{path}: run {table.key}'
    warnings = [f'{place}: {warning}' for warning in table.warnings]
    epoch = round(mapping.epoch.timestamp() * 1e9)
    time = _time(path, table, mapping.time)
    every = np.arange(time.size)
    common = _stamps(place, time, every, epoch, warnings)
    channels = {}
    for name, source in mapping.channels.items():
        raw = table.column(source.column, f'{path}: channels.{name}')
        warnings += _misnamed(place, name)
        if source.bits is None:
            warnings += _signless(f'{place}: {name}', raw)
        else:
            raw = np.where(raw >= 2.0 ** (source.bits - 1), raw - 2.0**source.bits, raw)
        value = source.sign * source.scale * factor(source.unit, unit_of(name)) * raw
        value = value + _offset(source, name)
        if source.time is None:
            rows, (time, usable) = every, common
        else:
            own = _time(path, table, source.time)
            rows = np.flatnonzero(~_repeated(own, value))
            value = value[rows]
            time, usable = _stamps(f'{place}: {name}', own[rows], rows, epoch, warnings)
        keep = usable & np.isfinite(value)
        lost = usable & ~keep
        if not keep.any():
            warnings.append(f'{place}: {name} has no finite value; taken as unmeasured')
            continue
        if lost.any():
            warnings.append(
                f'{place}: {np.count_nonzero(lost)} of {time.size} values of {name} left out '
                f'(empty, or not a finite number), first row {1 + int(rows[lost][0])} of the data'
            )
        value = value[keep]
        if source.wrap is not None:
            # only now: a turn that a row which is left out had made would stay for ever
            period = abs(source.scale) * parsed(source.wrap, unit_of(name))
            warnings += _unturned(f'{place}: {name}', value, period)
            value = np.unwrap(value, period=period)
        channels[name] = Channel(name, time[keep], value)
    if not any(name.startswith('actuator/') for name in channels):
        raise RecordingError(f'{place}: no usable sample of the motors; check time and columns')
    return Recording(
        name=table.key,
        channels=channels,
        epoch_ns=epoch,
        metadata=_metadata(path, table, mapping),
        warnings=tuple(warnings),
    )


def _offset(source: Source, name: str) -> float:
    """Return what is added last, in the unit of the channel."""
    given = source.offset
    return given if isinstance(given, float) else parsed(given, unit_of(name))


def _misnamed(place: str, name: str) -> list[str]:
    """Say that no instrument has such a channel, as joints of instruments are pulleys."""
    group, *joint, field = name.split('/')
    if not joint or joint[0].startswith('pulley_'):
        return []
    return [
        f'{place}: no instrument file has a channel {name}: joints are pulleys there, so that '
        f'pulley {joint[0]} has {group}/pulley_{joint[0]}/{field}'
    ]


def _signless(place: str, raw: FloatArray) -> list[str]:
    """Say that raw numbers leap through the whole range of a register that counts from zero."""
    known = raw[np.isfinite(raw)]
    most = float(known.max(initial=0.0))
    bits = next((bits for bits in REGISTERS if LEAP * 2.0**bits < most < 2.0**bits), None)
    leaps = float(np.abs(np.diff(known)).max(initial=0.0)) > LEAP * most
    if bits is None or known.min(initial=0.0) < 0.0 or not leaps or np.any(known % 1.0):
        return []
    return [
        f'{place} leaps between 0 and {most:.0f}, as a signed register of {bits} bits that was '
        f'logged without its sign: if it is one, write `bits: {bits}`'
    ]


def _unturned(place: str, value: FloatArray, period: float) -> list[str]:
    """Say that readings leap through all of their range, but not by so much as they wrap at."""
    step = float(np.abs(np.diff(value)).max(initial=0.0))
    if step == 0.0 or step > 0.5 * period or step < LEAP * float(np.ptp(value)):
        return []
    return [
        f'{place} leaps by {step:.4g}, and wraps at {period:.4g}: give its wrap in the unit of '
        'the channel, which is 18 deg for a turn of a rotor behind a gear of 20'
    ]


def _time(path: Path, table: Table, time: Time) -> FloatArray:
    """Return the time of each row [s], shape (n,)."""
    if time.rate is not None:
        rows = next(iter(table.columns.values())).size
        return np.arange(rows) / factor(time.rate, 'Hz')
    assert time.column is not None
    raw = table.column(time.column, f'{path}: time')
    return raw * factor(time.unit, 's')


def _repeated(time: FloatArray, value: FloatArray) -> BoolArray:
    """Return which rows are empty, or hold a slower channel's last sample once more."""
    taken = np.flatnonzero(np.isfinite(time) | np.isfinite(value))
    same = (np.diff(time[taken]) == 0.0) & (np.diff(value[taken]) == 0.0)
    repeated = np.ones(time.size, dtype=np.bool_)
    repeated[taken] = np.concatenate(([False], same))[: taken.size]
    return repeated


def _stamps(
    place: str, time: FloatArray, rows: IntArray, epoch_ns: int, warnings: list[str]
) -> tuple[FloatArray, BoolArray]:
    """
    Return stamps as a bag keeps them, and which of them are usable; tell of the others.

    :param place: what they belong to, for the message.
    :param time: as the file gives it [s], shape (n,).
    :param rows: of the file's data, counted from 0, shape (n,).
    :param epoch_ns: header stamp of time zero [ns].
    :param warnings: what is told goes here.
    :return: stamps [s] and whether they are usable, each shape (n,).
    :raises RecordingError: where they reach beyond what a bag can hold.
    """
    usable = np.isfinite(time)
    last = float(np.abs(time[usable]).max(initial=0.0))
    if last > LONGEST:
        raise RecordingError(
            f'{place}: its time reaches {last:.3g} s, which is {last / YEAR:.0f} years; say the '
            'unit of the column in the mapping, ms or us perhaps'
        )
    # Whole nanoseconds, so that the bag reads back as the same numbers.
    time[usable] = to_seconds(to_stamps(time[usable], 0), 0)
    usable[usable] = _increasing(time[usable])
    _check_years(place, time[usable], epoch_ns)
    if not usable.all():
        first = 1 + int(rows[~usable][0])
        warnings.append(
            f'{place}: {np.count_nonzero(~usable)} of {time.size} rows left out (time not between '
            f'those of the rows beside, or not a number), first row {first} of the data'
        )
    _warn_of_jitter(place, time[usable], warnings)
    return time, usable


def _check_years(place: str, time: FloatArray, epoch_ns: int) -> None:
    """Complain of stamps that a header has no room for."""
    for edge in (time[:1], time[-1:]):
        for stamp in to_stamps(edge, epoch_ns).tolist():
            if not 0 <= stamp < END:
                year = (datetime(1970, 1, 1) + timedelta(seconds=stamp // 10**9)).year
                raise RecordingError(
                    f'{place}: its time reaches the year {year}, and ROS has stamps from 1970 to '
                    '2037; say in the mapping, as its epoch, from when on the time counts '
                    "(LabVIEW's from 1904-01-01), or any later one where the clock was not set"
                )


def _increasing(time: FloatArray) -> BoolArray:
    """Return the most rows whose stamps increase, so that one wild stamp costs one row."""
    kept = np.ones(time.size, dtype=np.bool_)
    if bool(np.all(np.diff(time) > 0.0)):
        return kept
    # patience sorting: the smallest stamp, and its row, that ends a chain of each length
    ends: list[float] = []
    rows: list[int] = []
    before = np.full(time.size, -1)
    for row, stamp in enumerate(time.tolist()):
        length = bisect_left(ends, stamp)
        if length < len(ends) and ends[length] == stamp:  # of equals the first stays
            continue
        ends[length : length + 1] = [stamp]
        rows[length : length + 1] = [row]
        before[row] = rows[length - 1] if length else -1
    kept[:] = False
    row = rows[-1]
    while row >= 0:
        kept[row] = True
        row = int(before[row])
    return kept


def _warn_of_jitter(place: str, time: FloatArray, warnings: list[str]) -> None:
    """Say where the stamps are far from evenly spaced."""
    spacing = np.diff(time)
    if not spacing.size:
        return
    usual = float(np.median(spacing))
    stray = np.abs(spacing - usual) > JITTER * usual
    if stray.any():
        first = int(np.flatnonzero(stray)[0])
        warnings.append(
            f'{place}: {np.count_nonzero(stray)} of {spacing.size} intervals differ by more than '
            f'{JITTER:.0%} from {usual:.6g} s, first after {time[first]:.6f} s'
        )


def _metadata(path: Path, table: Table, mapping: Mapping) -> dict[str, str]:
    """Return what the bag keeps about where its numbers come from."""
    texts = {
        **mapping.metadata,
        'source_file': path.name,
        'source_run': table.key,
        'source_header': table.header,
        'attribution': mapping.attribution,
        'licence': mapping.licence,
    }
    return {key: text for key, text in texts.items() if text}
