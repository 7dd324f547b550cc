"""How long the bins are on which recordings are compared with the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import Drive, drives
from tendon_ros.identify.segment import FITTED, motion_of, reading_error, SETTLING
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers

FloatArray = NDArray[np.float64]

BINS = 20_000  # bins of what is fitted together: minutes of data are seen more coarsely
USUAL_BIN = 0.008  # [s], a tenth of the time in which a cable-driven instrument answers
#: part of a motor's torque that acceleration within a bin may get wrong before bins are halved:
#: more would show as a wrong inertia
MISSED = 0.02


def bin_length(recordings: Sequence[Recording], instrument: Instrument) -> float:
    """
    Return the length of a bin that suits all recordings.

    :param recordings: what was measured.
    :param instrument: the network.
    :return: [s], a few samples where sampling is fast, more than one where there is much data;
        shorter where a drive accelerates so much within a bin that torque and encoder tell.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    driving = drives(instrument)
    lengths = [r.end - r.start for r in recordings]
    total = min(sum(lengths), max(FITTED, *lengths))
    sampling = max(r[driving[0].sensor.channel].sampling for r in recordings)
    wished = max(USUAL_BIN, total / BINS, sampling)
    samples = round(wished / sampling)
    longest = max(recordings, key=lambda r: r.end - r.start)
    while samples > 1 and total / (sampling * (samples // 2)) <= BINS:
        period = sampling * samples
        if max(_missed(longest, instrument, d, period) for d in driving) <= MISSED:
            break
        samples //= 2
    return sampling * samples


def _missed(recording: Recording, instrument: Instrument, drive: Drive, period: float) -> float:
    """Return the part of a motor's torque that its inertia makes of what bins do not see."""
    torques = [
        s.channel
        for s in instrument.sensors
        if s.kind == 'motor_torque' and s.of == drive.motor and s.channel in recording
    ]
    if drive.by_torque or not torques:
        return 0.0
    channel = recording[drive.sensor.channel]
    start, sampling = float(channel.time[0]), channel.sampling
    bins = int((float(channel.time[-1]) - start) / period)
    fine = motion_of(channel, drive.sensor, start, sampling, round(bins * period / sampling) + 1)
    if period * bins < 2.0 * SETTLING:
        return 0.0
    time = sampling * np.arange(len(fine))
    motion = CubicSpline(time, fine)
    middles = period * (np.arange(bins, dtype=np.float64) + 0.5)
    coarse = CubicSpline(middles, motion(middles))
    # the ends of a spline know little of what goes on there, and how it all began counts nowhere
    inner = (time > SETTLING) & (time < middles[-2])
    unseen: FloatArray = (coarse(time) - fine)[inner]
    if np.sqrt(np.mean(unseen**2)) <= reading_error(channel, drive.sensor):
        return 0.0  # the fine motion knows no better
    edges = period * np.arange(bins + 1, dtype=np.float64)
    mean: FloatArray = np.diff(motion(edges, 1)) / period
    used = (middles > SETTLING) & (middles < middles[-2])
    off = float(np.sqrt(np.mean((coarse(middles, 2) - mean)[used] ** 2)))
    inertia = float(Numbers(instrument)['inertia'][instrument.index(drive.pulley)])
    torque = float(np.sqrt(np.mean(recording[torques[0]].value ** 2)))
    return inertia * off / max(torque, 1e-12)
