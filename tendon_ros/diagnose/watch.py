"""
Watch an instrument beside the robot: whether the model still says what is measured.

Every so often the last seconds of measured motor motion drive the model, and what it predicts is
compared with what was measured. The windows end at whole multiples of their period in stamp time,
so a bag that is played back gives what was said live.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import TendonError
from tendon_ros.base.recording import Channel, FIELD_UNITS, Recording
from tendon_ros.diagnose.intake.limits import within_limits
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.watch_cause import as_lasting, places_of, Suspect, suspects_of
from tendon_ros.diagnose.watch_gap import GapJudge, WatchedGap
from tendon_ros.diagnose.watch_stream import Streams
from tendon_ros.estimate.observer import Measurement
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.driving import motor_channels
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.motion import reading_error
from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import Instrument

BoolArray = NDArray[np.bool_]
State = Literal['waiting', 'resting', 'learning', 'watching']

#: topics of one instant arrive one after the other: so long is waited for the last [s]
SLACK = 0.2
#: a channel so far behind the motors has stopped, or has another clock; so far ahead it has [s]
ASTRAY = 1.0
#: reading errors that motion must span before it counts as motion
MOVED = 30.0
#: a gap that grows is noticed after so long, or somewhat later [s]
NOTICED = 1.5
#: part of a window's bins, warm-up left out, that must count for it to be judged
ENOUGH = 0.4


@dataclass(frozen=True)
class WatchSettings:
    """
    How an instrument is watched.

    ``window`` [s] is rolled out every ``period`` [s]; its first ``warm_up`` [s] do not count.
    ``warn_ratio``: times the explained gap a gap may reach. ``learn`` [s] of motion teach what is
    explained, where ``explained`` (RMSE by channel) does not say it.
    """

    window: float = 6.0
    warm_up: float = 2.0
    period: float = 1.0
    warn_ratio: float = 2.0
    learn: float = 10.0
    explained: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class WatchReport:
    """
    What the last look has shown.

    ``end_ns`` [ns]: end of its window. ``state``: ``waiting`` for enough measurements,
    ``resting`` where the motors do not move and nothing can be judged, ``learning`` or
    ``watching``. ``faults``: by channel, or ``motors``, why it could not be compared. ``places``
    and ``suspects``: where a grown gap lies and what would explain it, most first.
    """

    end_ns: int = 0
    state: State = 'waiting'
    gaps: tuple[WatchedGap, ...] = ()
    faults: Mapping[str, str] = field(default_factory=dict)
    places: tuple[str, ...] = ()
    suspects: tuple[Suspect, ...] = ()

    @property
    def grown(self) -> tuple[WatchedGap, ...]:
        """The channels whose gap has grown past what is explained, most first."""
        found = [gap for gap in self.gaps if gap.grown]
        return tuple(sorted(found, key=lambda gap: -gap.gap / gap.limit))


class Watch:
    """
    Compares measurements with the model while they come.

    :meth:`update` only keeps what it is given, and may be called from another thread than the
    rest. :meth:`look` takes some 20 ms, :meth:`suspect` half a second.

    :param instrument: the network with the effects that are accepted: what they explain is no gap.
    :param settings: how it is watched.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """

    def __init__(self, instrument: Instrument, settings: WatchSettings | None = None) -> None:
        self.settings = settings or WatchSettings()
        #: the instrument as it is watched, and what was changed in it
        self.instrument, self.notes = as_lasting(instrument)
        self._motors = motor_channels(instrument)
        self._sensors = {s.channel: s for s in instrument.sensors}
        kept = self.settings.window + 2.0 * self.settings.period + SLACK
        self._streams = Streams(instrument, kept)
        self._period_ns = round(self.settings.period * 1e9)
        self.reset()

    def reset(self) -> None:
        """Forget everything: the next measurement is the first."""
        self._streams.clear()
        self._judges: dict[str, GapJudge] = {}
        self._problem: Problem | None = None
        self._report = WatchReport()
        # where the window of the problem starts, and the last one without a grown gap ends [ns]
        self._start_ns = self._small_ns = 0

    def rehearse(self) -> None:
        """Compare a second of rest before it counts: the first time is slow."""
        time = 0.005 * np.arange(200, dtype=np.float64)
        channels = {n: Channel(n, time, np.zeros(200)) for n in self._sensors}
        problem = prepared([Recording('rehearsal', channels)], self.instrument).whole
        suspects_of(problem, everyone(self.instrument, list(channels))[:1])

    def update(self, measurement: Measurement) -> None:
        """
        Take in what one topic says of one instant.

        :param measurement: any channels; those that the instrument does not measure are left.
        :raises StampError: on a stamp that steps back: the measurement is then left out.
        :raises RecordingError: on a value that is not finite, which is left out alone; on unknown
            joints: the measurement is then left out. The next good one is welcome.
        """
        self._streams.add(measurement)

    @property
    def due(self) -> bool:
        """Whether a window has come to its end since the last look."""
        return self._end_ns() > self._report.end_ns

    @property
    def report(self) -> WatchReport:
        """What the last look has shown."""
        return self._report

    @property
    def strangers(self) -> tuple[str, ...]:
        """Joints that were heard of, but that the instrument does not have."""
        return tuple(sorted(self._streams.strangers))

    @property
    def missing(self) -> tuple[str, ...]:
        """Positions or torques of motors that drive the model, never measured so far."""
        return self._streams.silent_motors

    def look(self) -> WatchReport:
        """
        Compare the last window that has come to its end.

        :return: what it shows.
        """
        end_ns = self._end_ns()
        start_ns = end_ns - round(self.settings.window * 1e9)
        recording = self._streams.window(start_ns, end_ns)
        faults = self._astray(end_ns)
        held = {n: c for n, c in recording.channels.items() if n not in faults}
        old = self._report
        new = replace(old, end_ns=end_ns, state='waiting', faults=faults)
        if self._covers(replace(recording, channels=held)):
            new = self._compared(replace(recording, channels=held), new)
        if not new.grown:
            new = replace(new, places=(), suspects=())
            self._small_ns = end_ns
        self._report = new
        return new

    def suspect(self) -> WatchReport:
        """
        Look for what would explain the gap of the last window that was compared.

        :return: the report with places and suspects.
        """
        if self._problem is None:
            return self._report
        [segment] = self._problem.rollouts.segments
        measured = [*self._motors, *(m.sensor.channel for m in segment.measured)]
        # what was measured before the gap grew says nothing of its cause
        late = segment.time > (self._small_ns - self._start_ns) * 1e-9 - NOTICED
        used = [late & self._problem.masks[0].any(axis=0)]
        problem = Problem(self._problem.rollouts, self._problem.tolerances, used)
        found = suspects_of(problem, everyone(self.instrument, measured))
        self._report = replace(self._report, places=places_of(found), suspects=found)
        return self._report

    def _end_ns(self) -> int:
        now = self._streams.now_ns
        if now is None:
            return 0
        return (now - round(SLACK * 1e9)) // self._period_ns * self._period_ns

    def _astray(self, end_ns: int) -> dict[str, str]:
        """Return the channels that have stopped or have another clock, with sentences."""
        faults = {}
        now_ns = self._streams.now_ns or end_ns
        for name in self._streams.heard:
            newest = self._streams.newest(name) or 0
            late, early = (end_ns - newest) * 1e-9, (newest - now_ns) * 1e-9
            if name in self._motors:
                continue
            if late > ASTRAY:
                faults[name] = (
                    f'{name}: its stamps end {late:.1f} s before those of the motors; see whether '
                    'its driver still runs, on the same clock'
                )
            elif early > ASTRAY:
                faults[name] = (
                    f'{name}: its stamps are {early:.1f} s ahead of those of the motors; see that '
                    'both have the same clock'
                )
        return faults

    def _covers(self, recording: Recording) -> bool:
        """Return whether a window has motors enough to be judged."""
        if any(name not in recording for name in self._motors):
            return False
        first = max(float(recording[name].time[0]) for name in self._motors)
        last = min(float(recording[name].time[-1]) for name in self._motors)
        wanted = self.settings.warm_up + ENOUGH * (self.settings.window - self.settings.warm_up)
        return last - first >= wanted

    def _compared(self, recording: Recording, report: WatchReport) -> WatchReport:
        """Return the report with the gaps of a window."""
        faults = dict(report.faults)
        kept, sentences = within_limits([recording], self.instrument)
        if not kept:
            faults['motors'] = sentences[0].removeprefix('window: ')
            return replace(report, faults=faults)
        if set(recording.channels) <= set(self._motors):
            faults['motors'] = (
                'nothing but motor positions is measured, so there is nothing to compare; publish '
                f'any of {", ".join(s for s in self._sensors if s not in self._motors)}'
            )
            return replace(report, faults=faults)
        try:
            problem = prepared([recording], self.instrument).whole
        except (TendonError, np.linalg.LinAlgError) as error:
            return replace(report, faults={**faults, 'motors': str(error)})
        [segment] = problem.rollouts.segments
        used = self._counted(segment, recording)
        if used.mean() < ENOUGH * (1.0 - self.settings.warm_up / self.settings.window):
            return replace(report, state='resting')
        problem = Problem(problem.rollouts, problem.tolerances, [used])
        left = problem.left(problem.written)
        if not np.isfinite(left).all():
            faults['motors'] = (
                f'the model of {self.instrument.name} cannot follow the measured motion; see '
                'whether the motor positions are in rad and belong to this instrument'
            )
            return replace(report, faults=faults)
        self._problem, self._start_ns = problem, recording.epoch_ns
        # a channel that this window cannot judge keeps what was said of it
        before = {gap.channel: gap for gap in report.gaps if gap.channel not in faults}
        gaps = tuple({**before, **self._gaps(problem, left)}.values())
        learning = any(math.isnan(gap.explained) for gap in gaps)
        return replace(
            report, state='learning' if learning else 'watching', gaps=gaps, faults=faults
        )

    def _counted(self, segment: Segment, recording: Recording) -> BoolArray:
        """
        Return the bins that count: those after the warm-up, once there has been motion.

        Before, how friction was left by what came earlier is not known.
        """
        moved = np.zeros(len(segment.time), dtype=np.bool_)
        # measured loads, if any, follow the motions
        for row, name in zip(segment.motion.value, self._motors, strict=False):
            error = reading_error(recording[name], self._sensors[name]).still
            span = np.maximum.accumulate(row) - np.minimum.accumulate(row)
            moved |= span > MOVED * error
        counted: BoolArray = moved & (segment.time > self.settings.warm_up)
        return counted

    def _gaps(self, problem: Problem, left: NDArray[np.float64]) -> dict[str, WatchedGap]:
        """Return the gap of every channel that a window can judge."""
        [segment] = problem.rollouts.segments
        learn = math.ceil(self.settings.learn / self.settings.period)
        found = {}
        for _, c, own in problem.groups(left):
            if not own.size:
                continue
            measured = segment.measured[c]
            noise = measured.noise[problem.masks[0][c]]
            channel = measured.sensor.channel
            if channel not in self._judges:
                unit = FIELD_UNITS[channel.rsplit('/', 1)[1]]
                explained = self.settings.explained.get(channel, math.nan)
                ratio = self.settings.warn_ratio
                self._judges[channel] = GapJudge(channel, unit, ratio, explained, learn)
            gap = float(np.sqrt(np.mean((own * noise) ** 2)))
            floor = float(np.sqrt(np.mean(noise**2)))
            found[channel] = self._judges[channel].take(gap, floor)
        return found
