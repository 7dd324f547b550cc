"""Estimation on a recording: the same observer, fed the same measurements as live."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.bags.stamps import to_seconds, to_stamps
from tendon_ros.base.errors import listed, RecordingError, TendonError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.estimate.observer import Measurement, Observer


def measurements(
    recording: Recording, needs: tuple[str, ...], rate: float | None = None
) -> Iterator[Measurement]:
    """
    Yield the measurements of a recording in the order of their stamps.

    :param recording: with every channel that is needed.
    :param needs: the channels.
    :param rate: leave out what comes sooner than this many a second allow [Hz]; None for all.
    :return: one measurement for each stamp at which all of them spoke.
    :raises RecordingError: where a channel is missing, or they never speak together.
    """
    for name in needs:
        if name not in recording:
            raise RecordingError(
                f'{recording.name}: no channel {name!r}, which this method needs; it has '
                f'{listed(recording.channels)}'
            )
    stamps = [to_stamps(recording[name].time, recording.epoch_ns) for name in needs]
    common = stamps[0]
    for other in stamps[1:]:
        common = np.intersect1d(common, other, assume_unique=True)
    if not common.size:
        raise RecordingError(
            f'{recording.name}: {", ".join(needs)} never carry the same stamp; resample them to '
            'one clock on import'
        )
    if rate is not None:
        common = _thinned(common, rate)
    columns = [
        recording[name].value[np.searchsorted(own, common)]
        for name, own in zip(needs, stamps, strict=True)
    ]
    for n, stamp in enumerate(common):
        values = {name: float(column[n]) for name, column in zip(needs, columns, strict=True)}
        yield Measurement(int(stamp), values)


def _thinned(stamps: NDArray[np.int64], rate: float) -> NDArray[np.int64]:
    """Return stamps at least a period apart, a tenth of it forgiven for jitter."""
    period = 0.9e9 / rate
    kept = [int(stamps[0])]
    for stamp in stamps[1:]:
        if stamp - kept[-1] >= period:
            kept.append(int(stamp))
    return np.array(kept, dtype=np.int64)


def estimate_recording(
    recording: Recording,
    observer: Observer,
    progress: Callable[[float], None] | None = None,
    rate: float | None = None,
) -> Recording:
    """
    Return a recording with the estimates added.

    A measurement that the observer refuses is left out, as live, and a warning of the recording
    says how many were and why the first one was.

    :param recording: what was measured.
    :param observer: a fresh observer.
    :param progress: called now and then with the part that is done, 0 to 1.
    :param rate: as for :func:`measurements`.
    :return: the recording and the channels ``estimate/...``.
    :raises RecordingError: where a needed channel is missing, or the observer refuses everything.
    """
    stamps: list[int] = []
    refused: list[str] = []
    columns: dict[str, list[float]] = {}
    span = max(recording.end - recording.start, 1e-9)
    for n, measurement in enumerate(measurements(recording, observer.needs, rate)):
        now = (measurement.stamp_ns - recording.epoch_ns) / 1e9
        try:
            estimate = observer.update(measurement)
        except TendonError as error:
            refused.append(f'at {now:.6f} s: {error}')
            continue
        stamps.append(estimate.stamp_ns)
        for name, value in estimate.values.items():
            columns.setdefault(name, []).append(value)
        if progress is not None and n % 256 == 0:
            progress((now - recording.start) / span)
    if not stamps:
        raise RecordingError(f'{recording.name}: no measurement could be used; {refused[0]}')
    if refused:
        said = (
            f'{recording.name}: {len(refused)} of {len(refused) + len(stamps)} measurements left '
            f'out, the first {refused[0]}'
        )
        recording = replace(recording, warnings=(*recording.warnings, said))
    time = to_seconds(np.array(stamps, dtype=np.int64), recording.epoch_ns)
    channels = [Channel(name, time, np.array(values)) for name, values in columns.items()]
    return recording.with_channels(channels)
