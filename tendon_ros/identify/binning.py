"""How long the bins are on which recordings are compared with the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.identify.driving import Drive, drives
from tendon_ros.identify.motion import motion_of, reading_error
from tendon_ros.identify.segment import FITTED, SETTLING
from tendon_ros.identify.smoothing import recounted
from tendon_ros.identify.torque import by_seldom_torque, USUAL_BIN
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: bins of what is fitted together: minutes of data are seen more coarsely; at most, where
#: acceleration needs them
ENOUGH, BINS = 8_000, 25_000
#: part of a motor's torque that bins may get wrong of what its inertia makes before others are
#: looked for: more would show as a wrong inertia
WRONG = 0.02
JUMPS = 0.004  # [s] within which a torque jumps where nothing else drives the model
FEW = 10  # bins of a recording that say nothing of their length
#: part of an acceleration's power that may be there where counts seem to make up all of it
SOME = 0.25
#: times what a torque does within bins that the inertia may make of what they do not see
SHAKEN = 2.0
#: [s] that bins are lengthened to at most, and times as long as before with each step
LONGEST, LONGER = 0.1, 1.25


def bin_length(recordings: Sequence[Recording], instrument: Instrument) -> float:
    """
    Return the length of a bin that suits all recordings.

    :param recordings: what was measured.
    :param instrument: the network.
    :return: [s], a few samples where sampling is fast, more than one where there is much data;
        shorter where a drive accelerates so much within a bin that torque and encoder tell, longer
        where its counts make up so much acceleration that inertia would seem less than it is.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    driving = drives(instrument)
    lengths = [r.end - r.start for r in recordings]
    total = min(sum(lengths), max(FITTED, *lengths))
    sampling = max(r[driving[0].sensor.channel].sampling for r in recordings)
    if all(by_seldom_torque(r, driving) for r in recordings):
        # readings belong to their instants, and torques jump between them
        finer = min(round(sampling / JUMPS), int(BINS * sampling / total))
        return sampling / max(1, finer)
    wished = max(USUAL_BIN, total / ENOUGH, sampling)
    samples = usual = round(wished / sampling)
    found = [Driven.of(r, instrument, d) for r in recordings for d in driving]
    motions = [m for m in found if m is not None]
    while samples > 1 and total / (sampling * (samples // 2)) <= BINS:
        if all(m.missed(sampling * samples) <= WRONG for m in motions):
            break
        samples //= 2
    if samples < usual:
        return sampling * samples
    # what counts make up falls with the fourth power, what bins do not see grows with the second
    while (longer := math.ceil(LONGER * samples)) * sampling <= LONGEST:
        blurred = max((m.blurred(sampling * samples) for m in motions), default=0.0)
        unseen = max((m.unseen(sampling * longer) for m in motions), default=0.0)
        if blurred <= max(WRONG, unseen):
            break
        samples = longer
    return sampling * samples


@dataclass(frozen=True)
class Driven:
    """
    What a drive did, as finely as its encoder tells.

    ``angle``: by time from the first reading [rad]; ``error`` [rad] of a reading at rest, and
    ``apart`` [rad] of each where it moves, shape (n,); ``inertia`` [kg m^2]; ``torque``: what the
    motor reported; ``alone``: whether nothing but the motor, and what acts on the pulley itself,
    moves it.
    """

    time: FloatArray
    angle: CubicSpline
    error: float
    apart: FloatArray
    inertia: float
    torque: Channel
    alone: bool

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
        reading = reading_error(channel, drive.sensor)
        routes = [r.route for r in instrument.loops] + [c.route for c in instrument.couplings]
        return cls(
            time,
            CubicSpline(time, fine),
            reading.still,
            reading.apart(fine, channel.sampling),
            float(Numbers(instrument)['inertia'][instrument.index(drive.pulley)]),
            recording[torques[0]],
            not any(drive.pulley in route for route in routes),
        )

    @cached_property
    def usual(self) -> float:
        """Root mean square of the torque [N m]."""
        return max(float(np.sqrt(np.mean(self.torque.value**2))), 1e-12)

    def missed(self, period: float) -> float:
        """
        Return the part of the torque that shorter bins would see, and these do not.

        :param period: length of a bin [s].
        :return: as :meth:`unseen`; 0 where a single reading of the encoder knows no better.
        """
        if self._too_short(period):
            return 0.0
        middles, _ = self._bins(period)
        coarse = CubicSpline(middles, self.angle(middles))
        inner = self.time[(self.time > SETTLING) & (self.time < middles[-2])]
        error = np.sqrt(self.error**2 + np.mean(self.apart**2))
        if np.sqrt(np.mean((coarse(inner) - self.angle(inner)) ** 2)) <= error:
            return 0.0
        return self.unseen(period)

    def unseen(self, period: float) -> float:
        """
        Return the part of the torque that the inertia makes of what bins do not see.

        :param period: length of a bin [s].
        :return: root mean square by root mean square, what counts make up taken off. Where only
            the motor moves the pulley, no more than twice what its torque does: a gear that gives
            way lets an encoder shake without what turns behind it.
        """
        if self._too_short(period):
            return 0.0
        _, off = self._seen(period, self.angle)
        _, made_up = self._seen(period, self._counted)
        found = self.inertia * math.sqrt(max(0.0, off - made_up)) / self.usual
        return min(found, SHAKEN * self._torque_unseen(period)) if self.alone else found

    def _torque_unseen(self, period: float) -> float:
        """Return the part of the torque that bins do not see, root mean square by the same."""
        time, value = self.torque.time, self.torque.value
        number = ((time - time[0]) / period).astype(np.int64)
        count = np.bincount(number)
        means = np.bincount(number, weights=value) / np.maximum(count, 1)
        return float(np.sqrt(np.mean((value - means[number]) ** 2))) / self.usual

    def blurred(self, period: float) -> float:
        """
        Return the part of the torque that the inertia seems to make less than it does.

        A fit takes an acceleration that counts have made up for one that needed no torque.

        :param period: length of a bin [s].
        :return: root mean square by root mean square.
        """
        if self._too_short(period):
            return 0.0
        power, _ = self._seen(period, self.angle)
        made_up, _ = self._seen(period, self._counted)
        # how much is made up is known roughly: where it seems all, some may still be there
        true = math.sqrt(max(power - made_up, SOME * power))
        less = true * min(1.0, made_up / max(power, 1e-300))
        return self.inertia * less / self.usual

    def _too_short(self, period: float) -> bool:
        """Return whether there are too few bins to say anything of their length."""
        return bool(self.time[-1] < SETTLING + FEW * period)

    def _seen(self, period: float, motion: CubicSpline) -> tuple[float, float]:
        """Return mean squares of acceleration by the bins, and of what it is off their means."""
        middles, used = self._bins(period)
        found: FloatArray = CubicSpline(middles, motion(middles))(middles, 2)
        speeds = motion(np.stack([middles - 0.5 * period, middles + 0.5 * period]), 1)
        off = found - (speeds[1] - speeds[0]) / period
        return float(np.mean(found[used] ** 2)), float(np.mean(off[used] ** 2))

    def _bins(self, period: float) -> tuple[FloatArray, BoolArray]:
        """Return the middles of bins, and which of them count."""
        middles = np.arange(0.0, self.time[-1] - period, period) + 0.5 * period
        # splines know little of what goes on at their ends, and how it all began counts nowhere
        return middles, (middles > SETTLING) & (middles < middles[-2])

    @cached_property
    def _counted(self) -> CubicSpline:
        """What counts make of the angle."""
        angle: FloatArray = self.angle(self.time)
        known = self.error <= 0.0
        made_up = 0.0 * angle if known else recounted(angle, self.error, self.apart) - angle
        return CubicSpline(self.time, made_up)
