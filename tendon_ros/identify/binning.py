"""How long the bins are on which recordings are compared with the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import Drive, drives
from tendon_ros.identify.segment import FITTED, motion_of, reading_error, SETTLING
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers

FloatArray = NDArray[np.float64]

#: bins of what is fitted together: minutes of data are seen more coarsely; at most, where
#: acceleration needs them
ENOUGH, BINS = 8_000, 25_000
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
    wished = max(USUAL_BIN, total / ENOUGH, sampling)
    samples = round(wished / sampling)
    found = [Driven.of(r, instrument, d) for r in recordings for d in driving]
    motions = [m for m in found if m is not None]
    while samples > 1 and total / (sampling * (samples // 2)) <= BINS:
        if all(m.missed(sampling * samples) <= MISSED for m in motions):
            break
        samples //= 2
    return sampling * samples


@dataclass(frozen=True)
class Driven:
    """
    What a drive did, as finely as its encoder tells.

    ``angle``: by time from the first reading [rad]; ``error`` [rad] of a reading; ``inertia``
    [kg m^2] by ``torque`` [N m], root mean square of what the motor reported.
    """

    time: FloatArray
    angle: CubicSpline
    error: float
    inertia: float
    torque: float

    @classmethod
    def of(cls, recording: Recording, instrument: Instrument, drive: Drive) -> Driven | None:
        """
        Return what a drive did.

        :param recording: what was measured.
        :param instrument: the network.
        :param drive: which.
        :return: the motion; None where it, or the torque, was not measured, or it is too short.
        """
        torques = [
            s.channel
            for s in instrument.sensors
            if s.kind == 'motor_torque' and s.of == drive.motor and s.channel in recording
        ]
        channel = recording[drive.sensor.channel]
        seconds = float(channel.time[-1] - channel.time[0])
        if drive.by_torque or not torques or seconds < 2.0 * SETTLING:
            return None
        samples = round(seconds / channel.sampling) + 1
        time = channel.sampling * np.arange(samples, dtype=np.float64)
        fine = motion_of(channel, drive.sensor, float(channel.time[0]), channel.sampling, samples)
        return cls(
            time,
            CubicSpline(time, fine),
            reading_error(channel, drive.sensor),
            float(Numbers(instrument)['inertia'][instrument.index(drive.pulley)]),
            float(np.sqrt(np.mean(recording[torques[0]].value ** 2))),
        )

    def missed(self, period: float) -> float:
        """
        Return the part of the torque that the inertia makes of what bins do not see.

        :param period: length of a bin [s].
        :return: root mean square by root mean square; 0 where the encoder knows no better.
        """
        edges = np.arange(0.0, self.time[-1], period)
        middles = edges[:-1] + 0.5 * period
        coarse = CubicSpline(middles, self.angle(middles))
        # the ends of a spline know little of what goes on there; how it all began counts nowhere
        inner = self.time[(self.time > SETTLING) & (self.time < middles[-2])]
        if np.sqrt(np.mean((coarse(inner) - self.angle(inner)) ** 2)) <= self.error:
            return 0.0
        mean: FloatArray = np.diff(self.angle(edges, 1)) / period
        used = (middles > SETTLING) & (middles < middles[-2])
        off = float(np.sqrt(np.mean((coarse(middles, 2) - mean)[used] ** 2)))
        return self.inertia * off / max(self.torque, 1e-12)
