"""
Segments: a recording made ready to drive the model and to be compared with it.

The motion of the driven pulleys becomes smooth signals; every other channel becomes means over
bins of one length, with the noise of such a mean.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import Drive, drives, motions_first
from tendon_ros.identify.loads import loads
from tendon_ros.identify.means import binned
from tendon_ros.identify.motion import motion_in_bins, reading_error, thinned
from tendon_ros.identify.smoothing import at_rest
from tendon_ros.identify.torque import by_seldom_torque, torque_of
from tendon_ros.model.instrument import Instrument, Sensor
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: [s] of recordings that fits see where there are many more: whole others judge them
FITTED = 180.0
ALL = 1e-6  # part of a bin that the last one may seem to lack, by the last digits of stamps
LEVEL = 5  # bins of a running mean, short against what a torque limit cuts off
SETTLING = 0.25  # [s] after the start, when how it was brought there is not yet forgotten
#: [s] before the end, of which an encoder that is late as can be has not told yet, nor smoothed
ENDING = 0.06


@dataclass(frozen=True)
class Measured:
    """
    One channel on the bins of its segment.

    ``value``, shape (bins,), in the sensor's unit, NaN where nothing was measured; ``noise``,
    shape (bins,): what the sensor and the motion's counts leave uncertain in a bin's mean;
    ``floor`` is what the sensor alone would by its data sheet; ``counted`` is the part of the
    noise's power that has a shape: what still encoders leave, and what does not repeat itself.
    ``misfit``, in the sensor's unit, is what models of this machine leave of the channel;
    ``by_law``, shape (bins,), what laws of causes may get wrong of each bin; ``readings`` are as
    many as a bin's mean is of.
    """

    sensor: Sensor
    value: FloatArray
    noise: FloatArray
    floor: float
    counted: float = 1.0
    misfit: float = 0.0
    readings: float = 1.0
    by_law: FloatArray | float = 0.0

    @cached_property
    def doubt(self) -> FloatArray:
        """By how much the right model may be off: noise, misfit and laws, shape (bins,)."""
        return np.hypot(self.without_laws, self.by_law)

    @cached_property
    def without_laws(self) -> FloatArray:
        """The same without what laws may get wrong, shape (bins,)."""
        return np.hypot(self.noise, self.misfit)

    @cached_property
    def level(self) -> FloatArray:
        """The value without most of its noise: a running mean, shape (bins,), NaN as the value."""
        known = np.isfinite(self.value)
        window = np.ones(LEVEL)
        total = np.convolve(np.where(known, self.value, 0.0), window, mode='same')
        count = np.convolve(known.astype(np.float64), window, mode='same')
        with np.errstate(invalid='ignore', divide='ignore'):
            return np.where(known, total / count, np.nan)


@dataclass(frozen=True)
class Segment:
    """
    One recording on uniform bins.

    ``period`` [s] is the length of a bin, ``time``, shape (bins,), its middle, counted from
    ``start``, at the first reading or half a sample before. ``motion`` drives ``prescribed``
    pulleys. ``contacts`` are those that were there. ``pose`` is where the other pulleys began
    [rad]. ``pushed`` are pulleys on which a known torque acts, of a motor without encoder or of a
    measured load; torques follow the motions in ``motion``. ``still``: of each prescribed pulley,
    shape (bins,), where its motion cannot be told from rest. ``sampling`` [s] is the time between
    samples of the slowest channel.
    """

    name: str
    period: float
    time: FloatArray
    prescribed: tuple[str, ...]
    motion: Signals
    measured: tuple[Measured, ...]
    contacts: tuple[str, ...]
    pose: Mapping[str, float]
    start: float = 0.0
    pushed: tuple[str, ...] = ()
    still: tuple[BoolArray, ...] = ()
    sampling: float = 0.0

    @property
    def spacing(self) -> float:
        """Time between values [s]: where torques come seldom, some bins have none."""
        return self.period if self.prescribed else max(self.period, self.sampling)

    def begins_at_rest(self, instrument: Instrument) -> bool:
        """
        Return whether a model may come to rest where the motion begins; no known torque lets it.

        :param instrument: the network.
        :return: whether.
        """
        return not set(self.pushed) & set(instrument.driven)

    def at_rest(self, instrument: Instrument) -> Iterator[tuple[int, int, BoolArray]]:
        """
        Yield the torques of motors whose motion drives the model, and where each of them rests.

        :param instrument: the network.
        :return: for each, which of ``measured`` it is, its motor's number, and where the motor's
            motion cannot be told from rest, shape (bins,).
        """
        motors = {m.name: (j, m.pulley) for j, m in enumerate(instrument.motors)}
        for row, measured in enumerate(self.measured):
            if measured.sensor.kind == 'motor_torque':
                j, pulley = motors[measured.sensor.of]
                if pulley in self.prescribed:
                    yield row, j, self.rests(pulley)

    def rests(self, pulley: str) -> BoolArray:
        """
        Return where a pulley cannot be told from rest: nowhere, if its motion is not known.

        :param pulley: its name.
        :return: shape (bins,).
        """
        if pulley in self.prescribed:
            return self.still[self.prescribed.index(pulley)]
        return np.zeros(len(self.time), dtype=np.bool_)

    def with_noise(self, noise: Sequence[FloatArray], shaped: Sequence[FloatArray]) -> Segment:
        """
        Return the same with another noise.

        :param noise: of each channel, shape (bins,).
        :param shaped: the part of it that bins near each other share, shape (bins,).
        :return: the segment.
        """
        changed = []
        for m, n, c in zip(self.measured, noise, shaped, strict=True):
            counted = (c**2 + m.sensor.resolution**2 / 12.0) / n**2
            changed.append(replace(m, noise=n, counted=float(min(1.0, np.mean(counted)))))
        return replace(self, measured=tuple(changed))


def driven_by(driving: Sequence[Drive], start: float, period: float, rows: FloatArray) -> Signals:
    """
    Return the signals that drive a model.

    :param driving: what drives it.
    :param start: of the first value [s].
    :param period: between values [s].
    :param rows: what was recorded of each, shape (drives, bins).
    :return: the signals; torques alone may jump, and must not ring.
    """
    shape = Signals.through if all(d.by_torque for d in driving) else Signals.smooth
    return shape(start, period, rows)


def segment_of(instrument: Instrument, recording: Recording, period: float) -> Segment:
    """
    Return a recording as a segment; contacts and noise are settled by the caller.

    :param instrument: the network.
    :param recording: with all that drives the model.
    :param period: length of a bin [s].
    :return: the segment, with every contact of the instrument and the sensors' noise alone.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    driving = motions_first(drives(instrument))
    known = [d.sensor.channel for d in driving]
    start = max(float(recording[name].time[0]) for name in known)
    end = min(float(recording[name].time[-1]) for name in known)
    if by_seldom_torque(recording, driving):
        start -= 0.5 * period  # each reading in the middle of a bin
    else:
        # the middle of a bin lies between two readings, which share their noise: counts make up
        # the less acceleration for it
        sampling = min(recording[name].sampling for name in known)
        half = 0.5 * sampling * (1 - round(period / sampling) % 2)
        start, end = start - half, end + half
    bins = int((end - start) / period + ALL)
    time: FloatArray = period * (np.arange(bins, dtype=np.float64) + 0.5)
    rows = [
        torque_of(recording[d.sensor.channel], start, period, bins, instrument.control_period)
        if d.by_torque
        else motion_in_bins(recording[d.sensor.channel], d.sensor, start, period, bins)
        for d in driving
    ]
    measured = []
    for sensor in instrument.sensors:
        if sensor.channel in known or sensor.channel not in recording:
            continue
        value, noise, readings = binned(recording[sensor.channel], sensor, start, period, bins)
        measured.append(Measured(sensor, value, np.full(bins, noise), noise, readings=readings))
    return Segment(
        name=recording.name,
        period=period,
        time=time,
        prescribed=tuple(d.pulley for d in driving if not d.by_torque),
        motion=driven_by(driving, 0.5 * period, period, np.array(rows)),
        measured=tuple(measured),
        contacts=tuple(c.name for c in instrument.contacts if c.enabled),
        pose={},
        start=start,
        pushed=tuple(d.pulley for d in driving if d.by_torque),
        still=tuple(
            at_rest(row, reading_error(recording[d.sensor.channel], d.sensor).still, period)
            for d, row in zip(driving, rows, strict=True)
            if not d.by_torque
        ),
        sampling=max(
            recording[name].sampling for name in (*known, *(m.sensor.channel for m in measured))
        ),
    )


def loaded(instrument: Instrument, recording: Recording, segment: Segment) -> Segment | None:
    """
    Return a segment whose measured load acts on the model, in place of its contacts.

    For benches where something pushes back that is no wall: the load is then known, not predicted.

    :param instrument: the network.
    :param recording: what was measured.
    :param segment: the same on bins.
    :return: the segment; None where no load was measured.
    """
    rows: list[FloatArray] = []
    pushed = list(segment.pushed)
    inputs: set[str] = set()
    for sensor, levers in loads(instrument):
        if sensor.channel not in recording:
            continue
        load = motion_in_bins(
            thinned(recording[sensor.channel]),
            sensor,
            segment.start,
            segment.period,
            len(segment.time),
        )
        inputs.add(sensor.channel)
        for pulley, lever in levers.items():
            if pulley not in segment.prescribed and pulley not in pushed:
                pushed.append(pulley)
                rows.append(lever * load)
    if not rows:
        return None
    driving = segment.motion.value
    return replace(
        segment,
        motion=Signals.smooth(
            segment.motion.start, segment.motion.step, np.vstack([driving, *rows])
        ),
        measured=tuple(m for m in segment.measured if m.sensor.channel not in inputs),
        contacts=(),
        pushed=tuple(pushed),
    )
