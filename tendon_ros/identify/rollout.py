"""
Rollouts: the model driven along measured motion, compared with everything else that was measured.

The controller is taken out: each residual then belongs to one equation, and nothing drifts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cached_property, lru_cache
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import EffectError, SimulationError
from tendon_ros.effects.sensor_delay import LONGEST
from tendon_ros.identify.beginning import Beginning
from tendon_ros.identify.effort import Effort
from tendon_ros.identify.means import averaged
from tendon_ros.identify.segment import Segment
from tendon_ros.identify.step_size import fineness, TOLERANCE
from tendon_ros.identify.true_motion import true_motion
from tendon_ros.identify.untold import as_held, as_reported, usual_part
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.rows import Rows
from tendon_ros.model.simulation import along, follow

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

WHOLE = 1e-6  # part of a bin that no delay is told by
#: [bytes] of predictions that are remembered: a quarter of what is asked was asked a moment ago,
#: mostly of recordings in which the event that moves did not happen
REMEMBERED = 3e7


class Rollouts:
    """
    Predicts all channels of all segments for any set of effects.

    :param instrument: the network; its own effects are always in force.
    :param segments: what was measured.
    :param jobs: threads for predictions that do not depend on each other.
    :param tolerance: of a step [rad]; as fine as the counts ask for where None.
    :param effort: where what predictions cost is counted; its own where None.
    """

    def __init__(
        self,
        instrument: Instrument,
        segments: Sequence[Segment],
        jobs: int = 1,
        tolerance: float | None = None,
        effort: Effort | None = None,
    ) -> None:
        self.instrument = instrument
        self.segments = tuple(segments)
        self.jobs = jobs
        self.effort = effort or Effort()
        self.tolerance = TOLERANCE * fineness(instrument) if tolerance is None else tolerance
        self._pool = ThreadPoolExecutor(jobs) if jobs > 1 else None
        plain = tuple(replace(s, resolution=0.0, noise=0.0) for s in instrument.sensors)
        self._base = tuple(
            replace(
                instrument,
                sensors=plain,
                control_period=segment.period,
                contacts=tuple(
                    replace(c, enabled=c.name in segment.contacts) for c in instrument.contacts
                ),
            )
            for segment in self.segments
        )
        self._layout = tuple(
            along(base, segment.prescribed, segment.pushed, self.tolerance)
            for base, segment in zip(self._base, self.segments, strict=True)
        )
        self._beginning = tuple(map(Beginning, self._base, self.segments))
        largest = 8 * max([1, *(len(s.measured) * len(s.time) for s in self.segments)])
        self._one = lru_cache(max(1, int(REMEMBERED / largest)))(self._computed)
        self._columns = tuple(
            [
                [s.channel for s in instrument.sensors].index(m.sensor.channel)
                for m in segment.measured
            ]
            for segment in self.segments
        )

    def like(self, segments: Sequence[Segment], tolerance: float | None = None) -> Rollouts:
        """
        Return rollouts of other segments, which count as effort of these.

        :param segments: what was measured.
        :param tolerance: of a step [rad]; as accurate as these where None.
        :return: the rollouts.
        """
        accurate = self.tolerance if tolerance is None else tolerance
        return Rollouts(self.instrument, segments, self.jobs, accurate, self.effort)

    @cached_property
    def measured(self) -> tuple[FloatArray, ...]:
        """What was measured, one array (channels, bins) a segment, NaN where nothing was."""
        return tuple(
            np.array([m.value for m in segment.measured]).reshape(-1, len(segment.time))
            for segment in self.segments
        )

    @cached_property
    def _torques(self) -> dict[str, FloatArray]:
        """All that each motor reported, by its name."""
        found: dict[str, list[FloatArray]] = {}
        for segment in self.segments:
            for m in segment.measured:
                if m.sensor.kind == 'motor_torque':
                    found.setdefault(m.sensor.of, []).append(m.value[np.isfinite(m.value)])
        return {name: np.concatenate(rows) for name, rows in found.items()}

    def usual(self, motor: str, gain: float) -> float:
        """
        Return the torque that is usually asked of a motor, or less.

        :param motor: its name.
        :param gain: of its torque by the reported one.
        :return: [N m]; 0 where it reported nothing.
        """
        reported = self._torques.get(motor, np.zeros(0))
        part = usual_part(self.instrument, motor)
        return float(np.quantile(np.abs(gain * reported), part)) if reported.size else 0.0

    def predicted(
        self, uses: Sequence[Sequence[EffectUse]], asked: Sequence[bool] | None = None
    ) -> tuple[FloatArray, ...]:
        """
        Predict every channel.

        :param uses: effects in force beside the instrument's own, for each segment.
        :param asked: of each segment whether it is asked for; all where None.
        :return: one array (channels, bins) a segment, zeros where it was not asked for; infinite
            where the model diverges.
        """
        found = []
        for n, own in enumerate(uses):
            segment = self.segments[n]
            if asked is None or asked[n]:
                rows, steps = self._one(n, tuple(own))
                self.effort.spend(steps, len(segment.time))
                found.append(rows)
            else:
                found.append(np.zeros((len(segment.measured), len(segment.time))))
        return tuple(found)

    def each[A, B](self, work: Callable[[A], B], items: Sequence[A]) -> list[B]:
        """
        Return what a function of predictions gives for each of several items.

        :param work: the function; it asks for nothing here itself.
        :param items: what to call it with.
        :return: in their order; the kernel leaves the interpreter free for other threads.
        """
        if self._pool is None or len(items) < 2:
            return [work(item) for item in items]
        return list(self._pool.map(work, items))

    def rest(self) -> dict[str, float]:
        """
        Return where the pulleys without a motor have come to at the end of the first segment.

        :return: angles [rad] by pulley.
        """
        base = self._base[0]
        last = self._rolled(0, ())[0].angle[-1]
        return {name: float(last[base.index(name)]) for name in base.inner}

    @cached_property
    def stretches(self) -> FloatArray:
        """By how much each cable is let out and stretched by the file [m], shape (loops,)."""
        least, most = self.let_out([()] * len(self.segments))
        return np.asarray(most - least)

    def let_out(self, uses: Sequence[Sequence[EffectUse]]) -> FloatArray:
        """
        Return how far the cable of each loop is let out at least and at most.

        :param uses: effects in force beside the instrument's own, for each segment.
        :return: [m], shape (2, loops); infinite where the model cannot be computed.
        """
        radius = self.instrument.routing()[: len(self.instrument.loops)]
        try:
            far = np.concatenate([rows.angle for rows in self.states(uses)]) @ radius.T
        except (SimulationError, EffectError):
            return np.outer([-np.inf, np.inf], np.ones(len(radius)))
        return np.stack([far.min(axis=0), far.max(axis=0)])

    def states(self, uses: Sequence[Sequence[EffectUse]]) -> list[Rows]:
        """
        Return what the model does inside, bin by bin.

        :param uses: effects in force beside the instrument's own, for each segment.
        :return: one a segment.
        :raises SimulationError: where the model diverges.
        """
        return [self._rolled(n, own)[0] for n, own in enumerate(uses)]

    def _rolled(
        self, n: int, uses: Sequence[EffectUse], late: float = 0.0, of: Sequence[str] = ()
    ) -> tuple[Rows, Numbers]:
        """
        Return what the model does along a segment, and its numbers with all effects.

        ``late``: how much later all of it happens [s], a part of a bin; ``of``: the sensors that
        are late by so much less.
        """
        segment = self.segments[n]
        base = self._base[n]
        effects = _sooner(in_force(base.effects, uses), late, of)
        arrays = self._layout[n].arrays(tuple(effects))
        motion = true_motion(base, arrays.numbers, segment, late)
        rows = follow(
            base,
            arrays,
            motion,
            len(segment.time) - 1,
            pose=self._beginning[n].pose(motion),
            resting=self._beginning[n].resting,
            loose=self._beginning[n].loose(arrays.numbers, motion),
        )
        return rows, arrays.numbers

    def _computed(self, n: int, uses: tuple[EffectUse, ...]) -> tuple[FloatArray, int]:
        """Return all channels of a segment, and steps; nobody may write into what is kept."""
        segment = self.segments[n]
        steps = 0
        try:
            rows, numbers = self._rolled(n, uses)
            steps = rows.steps
            found = self._told(n, rows, numbers)
            for late, channels in self._between_bins(n, numbers).items():
                names = [segment.measured[row].sensor.name for row in channels]
                later, numbers_then = self._rolled(n, uses, late, names)
                steps += later.steps
                found[channels] = self._told(n, later, numbers_then)[channels]
        except (SimulationError, EffectError):
            return np.full((len(segment.measured), len(segment.time)), np.inf), steps
        found.flags.writeable = False
        return found, steps

    def _told(self, n: int, rows: Rows, numbers: Numbers) -> FloatArray:
        """Return what a recording would have of what the model does."""
        segment = self.segments[n]
        readings = np.array([m.readings for m in segment.measured])
        found = averaged(rows.reading[:, self._columns[n]].T, readings)
        found = as_held(rows, numbers, segment, found)
        reported = as_reported(rows.instrument, numbers, segment, found, self.usual)
        return _zeroed(segment, reported)

    def _between_bins(self, n: int, numbers: Numbers) -> dict[float, list[int]]:
        """
        Return which channels are late by more than whole bins, by how much more [s].

        Read between two bins, a prediction would lose half of the noise that the motion's counts
        make, and half a bin of delay would explain that in any recording. All that drives the
        model is let happen later instead.
        """
        period = self.segments[n].period
        found: dict[float, list[int]] = {}
        # what stays of a delay is one of the catalogue: the nearest bin may be beyond the longest
        longest = math.floor(LONGEST / period)
        for row, late in enumerate(numbers['sensor_delay'][self._columns[n]].tolist()):
            part = late - period * min(round(late / period), longest)
            # a whole number of bins is one to within its last digits
            if abs(part) > WHOLE * period:
                found.setdefault(part, []).append(row)
        return found


def _sooner(
    effects: Sequence[EffectUse], time: float, names: Sequence[str]
) -> Iterator[EffectUse]:
    """Yield effects with the delays of some sensors shorter by a time [s], all of each as one."""
    late = dict.fromkeys(names, -time)
    for use in effects:
        if use.effect == 'sensor_delay' and use.place in late:
            age, filtered = (use.parameters.get(name, 0.0) for name in ('time', 'filtered'))
            late[use.place] += (1.0 - filtered) * age
            if filtered > 0.0:  # a filter makes late whatever drives
                smooth = {'time': filtered * age, 'filtered': 1.0}
                yield EffectUse('sensor_delay', use.place, smooth)
        else:
            yield use
    for name, rest in late.items():
        yield EffectUse('sensor_delay', name, {'time': max(rest, 0.0)})


def _zeroed(segment: Segment, found: FloatArray) -> FloatArray:
    """Return the predictions, those of angles without a zero as near as can be to the readings."""
    for row, measured in zip(found, segment.measured, strict=True):
        if not measured.sensor.zeroed:
            row += np.nanmean(measured.value - row)
    return found
