"""
What the model, driven with the measured motion, expects of every other sensor.

Only rough agreement matters here, so everything is resampled to one grid and low-passed alike. It
is not known whether the instrument touched its load: the model runs with its contacts, without
them, and with the measured load in their place; what agrees best with the shape of all channels
counts. Shape is judged by the size of correlations, which no sign or unit changes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import butter, sosfiltfilt

from tendon_ros.base.errors import SimulationError
from tendon_ros.base.recording import FloatArray, Recording
from tendon_ros.diagnose.intake.step import compared, shared_span
from tendon_ros.estimate.channels import deviation, operating_force
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument, Sensor
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict

STEP = 2e-3  # [s]
CUT_OFF = 15.0  # [Hz]
LONGEST = 30.0  # [s] of one recording that are looked at: those with the most motion
APPROACH = 400  # steps in which the motors go from zero to where the recording begins
TOLERANCE = 1e-5  # [rad]
AGREEING = 0.8  # of correlations, on the average, without regard to the load
STRONG = 1.0  # deviations of the sensor, most of which the low-pass takes
VISIBLE = 1.0  # deviations of the sensor that cannot leave every sample the same
COUNTS = 3.0  # counts of it that cannot either
HELD = 0.01  # [rad] that friction may keep a pulley from turning
#: squares of differences of neighbouring samples, by their variance, of noise alone (2 where no
#: sample knows of the one before), and so many samples to tell
ALONE, MANY = 1.6, 200
#: part of what is expected that a sensor may show which shows nothing of it
NOTHING = 0.2
_FILTER = butter(2, CUT_OFF, fs=1.0 / STEP, output='sos')


@dataclass(frozen=True)
class Comparison:
    """
    A sensor's channel beside its expectation on one grid, low-passed; shape (n,) each.

    ``constant``: it does not change at all; ``noise``: from one sample to the next alone.
    """

    sensor: Sensor
    measured: FloatArray
    expected: FloatArray
    constant: bool
    noise: bool

    @property
    def expected_strong(self) -> bool:
        """Whether the model expects far more of the sensor than its noise."""
        return bool(self.expected.std() > STRONG * deviation(self.sensor))

    @property
    def expected_visible(self) -> bool:
        """Whether a sensor that works could not stay on one value."""
        small = max(VISIBLE * deviation(self.sensor), COUNTS * self.sensor.resolution)
        if self.sensor.kind == 'angle':
            small = max(small, HELD)
        return bool(self.expected.std() > small)

    @property
    def unmoved(self) -> bool:
        """Whether nothing of a motion shows in it."""
        return self.constant or self.noise

    @property
    def silent(self) -> bool:
        """Whether nothing shows in it where the model expects far more."""
        return self.unmoved and self.expected_visible and self.factor < NOTHING

    @property
    def telling(self) -> bool:
        """Whether there is something to correlate."""
        return self.expected_strong and not self.constant

    @property
    def correlation(self) -> float:
        """Of measurement and expectation, -1 to 1; 0 where one of them is constant."""
        spread = self.measured.std() * self.expected.std()
        if not spread > 0.0:
            return 0.0
        return float(np.mean(_centred(self.measured) * _centred(self.expected)) / spread)

    @property
    def factor(self) -> float:
        """Size of the measurement by that of the expectation; infinite where that is none."""
        spread = float(self.expected.std())
        return float(self.measured.std()) / spread if spread > 0.0 else float('inf')


@dataclass(frozen=True)
class Expectation:
    """
    One run of the model beside one recording; ``motion`` as driven, by channel.

    ``loaded``: with the measured load, right or wrong.
    """

    comparisons: Mapping[str, Comparison]
    motion: Mapping[str, FloatArray]
    loaded: bool = False

    @property
    def agreement(self) -> float:
        """Mean size of the correlation of all channels that vary."""
        varying = [c for c in self.comparisons.values() if not c.unmoved]
        return float(np.mean([abs(c.correlation) for c in varying])) if varying else 0.0


def expectations(
    recording: Recording, instrument: Instrument, scale: Mapping[str, float] | None = None
) -> list[Expectation]:
    """
    Run the model along a recording, with contact, without, and with the measured load.

    :param recording: with every motor's position.
    :param instrument: the network.
    :param scale: factors on motor positions, by channel; 1 where not given.
    :return: best agreement first; none where the model cannot follow.
    """
    names = motor_channels(instrument)
    time = _grid(recording, names)
    factors = scale or {}
    motion = {n: factors.get(n, 1.0) * _resampled(recording, n, time) for n in names}
    drive = _Drive(
        motion,
        {s: _resampled(recording, s.channel, time) for s in compared(recording, instrument)},
    )
    found = [_expectation(recording, instrument, drive, False, ())]
    if instrument.contacts:
        found.append(_expectation(recording, instrument, drive, True, ()))
    best = max((e.agreement for e in found if e), default=0.0)
    load = _load(recording, instrument, time) if instrument.contacts and best < AGREEING else ()
    if load:
        found.append(_expectation(recording, instrument, drive, False, load))
    return sorted((e for e in found if e), key=lambda e: -e.agreement)


@dataclass(frozen=True)
class _Drive:
    """A recording on one grid: what drives the model, and what it is compared with."""

    motion: Mapping[str, FloatArray]
    measured: Mapping[Sensor, FloatArray]


def _expectation(
    recording: Recording,
    instrument: Instrument,
    drive: _Drive,
    touching: bool,
    load: Sequence[tuple[str, FloatArray]],
) -> Expectation | None:
    """Return one run of the model; None where it cannot follow the motion."""
    rig = replace(
        instrument,
        contacts=tuple(replace(c, enabled=touching) for c in instrument.contacts),
        control_period=STEP,
    )
    try:
        readings = _run(rig, list(drive.motion.values()), load)
    except SimulationError:
        return None
    comparisons = {
        s.channel: Comparison(
            s,
            measured,
            _low_passed(readings[s.channel]),
            bool(np.ptp(recording[s.channel].value) == 0.0),
            _noise_alone(recording[s.channel].value),
        )
        for s, measured in drive.measured.items()
        if not (load and s.channel.startswith('load_cell/'))
    }
    return Expectation(comparisons, drive.motion, loaded=bool(load))


def _noise_alone(value: FloatArray) -> bool:
    """Return whether no sample of a channel knows of the one before."""
    variance = float(np.var(value))
    return value.size > MANY and float(np.mean(np.diff(value) ** 2)) > ALONE * variance > 0.0


def _run(
    rig: Instrument, motion: Sequence[FloatArray], pushed: Sequence[tuple[str, FloatArray]]
) -> Mapping[str, FloatArray]:
    """Return the readings by channel, on the grid of the motion."""
    approach = 0.5 - 0.5 * np.cos(np.pi * np.minimum(np.arange(APPROACH) / (0.7 * APPROACH), 1.0))
    rows = [np.concatenate([approach * values[0], values]) for values in motion]
    rows += [np.concatenate([approach * values[0], values]) for _, values in pushed]
    result = predict(
        rig,
        Signals.smooth(0.0, STEP, np.array(rows)),
        rig.driven,
        len(rows[0]) - 1,
        pushed=tuple(name for name, _ in pushed),
        tolerance=TOLERANCE,
    )
    readings = result.reading[APPROACH:]
    n = len(motion[0])
    table = np.concatenate([readings, np.repeat(readings[-1:], n - len(readings), axis=0)])
    return {s.channel: table[:, q] for q, s in enumerate(rig.sensors)}


def _load(
    recording: Recording, instrument: Instrument, time: FloatArray
) -> tuple[tuple[str, FloatArray], ...]:
    """Return the torque that the measured load puts on each pulley that has no motor."""
    force = operating_force(instrument)
    channel = force.channel.replace('estimate/', 'load_cell/')
    if channel not in recording or not any(s.channel == channel for s in instrument.sensors):
        return ()
    value = _resampled(recording, channel, time)
    levers = zip(instrument.pulley_names, force.torque, strict=True)
    return tuple((n, lever * value) for n, lever in levers if lever and n in instrument.inner)


def _grid(recording: Recording, names: Sequence[str]) -> FloatArray:
    """Return the times at which a recording is looked at [s]."""
    start, end = shared_span(recording, names)
    if end - start > LONGEST:
        coarse = np.arange(start, end, 0.05)
        paths = [np.abs(np.diff(recording[n].at(coarse))) for n in names]
        path = np.concatenate([[0.0], np.cumsum(np.sum([p / (p.max() or 1.0) for p in paths], 0))])
        width = round(LONGEST / 0.05)
        start = float(coarse[int(np.argmax(path[width:] - path[:-width]))])
        end = start + LONGEST
    return np.asarray(start + STEP * np.arange(int((end - start) / STEP)))


def _resampled(recording: Recording, name: str, time: FloatArray) -> FloatArray:
    return _low_passed(recording[name].at(time))


def _low_passed(values: FloatArray) -> FloatArray:
    filtered: FloatArray = sosfiltfilt(_FILTER, values)
    return filtered


def _centred(values: FloatArray) -> FloatArray:
    return values - values.mean()
