"""
Experiments tried on the model: a rig in which one explanation holds performs a motion.

The controllers of the file turn the command into the motors' motion. Driven along it, or by the
torques where no motion was recorded, the model gives what every channel would say under any other
explanation, as it does in a diagnosis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.beginning import Beginning
from tendon_ros.identify.candidate import Candidate, Values
from tendon_ros.identify.driving import Drive, motions_first
from tendon_ros.identify.effort import Effort
from tendon_ros.identify.excitation_channel import PER_COUNT, row_noise, Sensed
from tendon_ros.identify.excitation_evidence import Evidence
from tendon_ros.identify.excitation_motion import CYCLE, Motion
from tendon_ros.identify.excitation_rig import ACCURACY, performed, touching
from tendon_ros.identify.segment import driven_by, ENDING, Segment, SETTLING
from tendon_ros.identify.smoothing import smoothed
from tendon_ros.identify.tolerance import Tolerance
from tendon_ros.identify.true_motion import true_motion
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.limiting import given_by
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.rows import Rows
from tendon_ros.model.simulation import along, follow

FloatArray = NDArray[np.float64]
Explanation = tuple[Candidate, Values]

ROUNDS = 3  # of fitting the imitation
EVENT = 0.4 * CYCLE  # [s] when something that happens once would happen again
LASTING = 0.3 * CYCLE  # [s], at most


def _again(candidate: Candidate, values: Values) -> EffectUse:
    """Return an effect as it would act in a new experiment: events happen once more."""
    found = dict(values)
    for p in candidate.parameters:
        if p.search == 'instant':
            found[p.name] = EVENT
        elif p.search == 'duration':
            found[p.name] = min(found[p.name], LASTING)
    return candidate.use(found)


@dataclass(frozen=True)
class _Drive:
    """The motors' motion and the torques that they reported, as the rig's recording has them."""

    segment: Segment
    reported: FloatArray


class Trial:
    """
    One motion on a rig in which one explanation holds.

    :param instrument: the file; its own effects are always in force.
    :param driving: what drives the model.
    :param sensed: the channels that are looked at.
    :param tolerances: what else may move.
    :param motion: the motion.
    :param truth: the explanation that holds.
    :param effort: where what it costs is counted.
    :raises SimulationError: where the rig cannot perform the motion.
    :raises EffectError: where the effect cannot act at its place.
    """

    def __init__(
        self,
        instrument: Instrument,
        driving: Sequence[Drive],
        sensed: Sequence[Sensed],
        tolerances: Sequence[Tolerance],
        motion: Motion,
        truth: Explanation,
        effort: Effort,
    ) -> None:
        self._effort = effort
        self._driving = motions_first(driving)
        self._base = touching(instrument, motion)
        self._sensed = tuple(sensed)
        self._truth = _again(*truth)
        rig = replace(self._base, effects=in_force(self._base.effects, [self._truth]))
        rows, period = performed(rig, motion.trajectory(instrument.motor_names))
        known = self._driven_by(rows)
        self._used = slice(round(SETTLING / period), -max(1, round(ENDING / period)))
        self._drive = self._driven(known, rows.effort, period)
        self._said = self._predicted([self._truth])
        plain = self._predicted([])
        counted = self._predicted([self._truth], self._counted(known, period))
        own = np.array([[row_noise(s.sensor)] for s in sensed])
        shaken = PER_COUNT * np.mean((counted - self._said) ** 2, axis=1, keepdims=True)
        self._noise = np.sqrt(own**2 + shaken)
        self._signature = (((self._said - plain) / self._noise) ** 2).sum(axis=1)
        # the number of the file that the truth itself changes is no excuse for the other
        self._tolerances = [t for t in tolerances if not t.is_moved_by(truth[0])]
        if not motion.against:
            self._tolerances = [t for t in self._tolerances if not t.effect.startswith('contact')]
        self._by_tolerance = np.array(
            [self._predicted([self._truth, t.use(1.0)]) - self._said for t in self._tolerances]
        ).reshape(-1, *self._said.shape)

    def evidence(self, rival: Explanation | None) -> list[list[Evidence]]:
        """
        Return how far a rival's closest imitation stays from the truth, by channel.

        :param rival: the other explanation; None for the file as it is.
        :return: for each place on the way to the closest imitation by the measured channels,
            evidence of each channel, in the order of those looked at.
        :raises SimulationError: where the model diverges.
        """
        if rival is None:
            left = self._said - self._predicted([])
            return [self._weighed(left, self._by_tolerance, self._tolerances, 0)]
        candidate = rival[0]
        kept = np.array([not t.is_moved_by(candidate) for t in self._tolerances], dtype=np.bool_)
        allowed = [t for t, keep in zip(self._tolerances, kept, strict=True) if keep]
        by_tolerance = self._by_tolerance[kept]
        coordinates = candidate.coordinates
        axes = coordinates.axes
        ends = np.array([a.ends for a in (*axes, *(t.axis for t in allowed))]).reshape(-1, 2)
        free = len(axes)
        start = _again(*rival).parameters
        x = np.zeros(len(ends))
        x[:free] = coordinates.place(start)
        measured = [n for n, s in enumerate(self._sensed) if s.status == 'measured']
        found = []
        for _ in range(ROUNDS if measured else 1):
            here = self._imitated(candidate, allowed, x)
            own = np.empty((free, *here.shape))
            for j, axis in enumerate(axes):
                step = 0.05 if axis.log else 0.1 * max(1.0, abs(x[j]))
                step = -step if x[j] + step > ends[j, 1] else step
                moved = x.copy()
                moved[j] += step
                own[j] = (self._imitated(candidate, allowed, moved) - here) / step
            # priors are about the file's numbers, so tolerances count from there
            left = self._said - here + np.tensordot(x[free:], by_tolerance, 1)
            parts = self._weighed(left, np.concatenate([own, by_tolerance]), allowed, free)
            found.append(parts)
            if measured:
                best = Evidence.joined(parts[n] for n in measured).imitation()
                x[:free] += np.clip(best[:free], -2.0, 2.0)
                x[free:] = best[free:]
                x = np.clip(x, ends[:, 0], ends[:, 1])
        return found

    def _imitated(
        self, candidate: Candidate, allowed: Sequence[Tolerance], x: FloatArray
    ) -> FloatArray:
        """Return what the channels say at a place of a rival's parameters and tolerances."""
        free = len(candidate.parameters)
        values = candidate.coordinates.values(x[:free].tolist())
        moved = [t.use(float(z)) for t, z in zip(allowed, x[free:], strict=True) if z != 0.0]
        return self._predicted([candidate.use(values), *moved])

    def _weighed(
        self,
        difference: FloatArray,
        slopes: FloatArray,
        allowed: Sequence[Tolerance],
        free: int,
    ) -> list[Evidence]:
        """Return scalar products by channel, in noise deviations."""
        prior = np.array([0.0] * free + [t.axis.spread**-2 for t in allowed])
        rows = np.concatenate([difference[None], slopes]) / self._noise
        return [
            Evidence(rows[:, c] @ rows[:, c].T, prior, float(self._signature[c]), CYCLE)
            for c in range(len(self._sensed))
        ]

    def _driven_by(self, rows: Rows) -> FloatArray:
        """Return what a recording has of that which drives the model, shape (drives, rows)."""
        names = [s.name for s in self._base.sensors]
        motors = self._base.motor_names
        return np.array(
            [
                rows.effort[:, motors.index(d.motor)]
                if d.by_torque
                else rows.reading[:, names.index(d.sensor.name)]
                for d in self._driving
            ]
        )

    def _driven(self, known: FloatArray, reported: FloatArray, period: float) -> _Drive:
        bins = known.shape[1]
        segment = Segment(
            name='experiment',
            period=period,
            time=period * np.arange(bins, dtype=np.float64),
            prescribed=tuple(d.pulley for d in self._driving if not d.by_torque),
            pushed=tuple(d.pulley for d in self._driving if d.by_torque),
            motion=driven_by(self._driving, 0.0, period, known),
            measured=(),
            contacts=tuple(c.name for c in self._base.contacts if c.enabled),
            pose=dict.fromkeys(self._base.inner, 0.0),
        )
        return _Drive(segment, reported)

    def _counted(self, known: FloatArray, period: float) -> _Drive:
        """Return the motion as it is known from the motors' counts."""
        rows = []
        whole = np.ones(known.shape[1], dtype=np.bool_)
        for row, drive in zip(known, self._driving, strict=True):
            count = drive.sensor.resolution
            if count > 0.0 and not drive.by_torque:
                seen = count * np.round(row / count)
                rows.append(smoothed(seen, whole, count / np.sqrt(12.0), count))
            else:
                rows.append(row)
        return self._driven(np.array(rows), self._drive.reported, period)

    def _predicted(self, uses: Sequence[EffectUse], drive: _Drive | None = None) -> FloatArray:
        """Return what the channels say when the model is driven along the motion."""
        drive = drive or self._drive
        instrument = replace(self._base, control_period=drive.segment.period)
        effects = in_force(self._base.effects, uses)
        segment = drive.segment
        layout = along(instrument, segment.prescribed, segment.pushed, ACCURACY)
        arrays = layout.arrays(effects)
        motion = true_motion(instrument, arrays.numbers, segment)
        begun = Beginning(instrument, segment)
        rows = follow(
            instrument,
            arrays,
            motion,
            len(segment.time) - 1,
            pose=begun.pose(motion),
            resting=begun.resting,
        )
        self._effort.spend(rows.steps, len(segment.time))
        found = np.array([s.reading(rows) for s in self._sensed])
        _add_cut_off(found, self._sensed, instrument, arrays.numbers, drive.reported)
        return found[:, self._used]


def _add_cut_off(
    found: FloatArray,
    sensed: Sequence[Sensed],
    instrument: Instrument,
    numbers: Numbers,
    reported: FloatArray,
) -> None:
    """Add to each motor's torque what it reports and, beyond its limit, does not give."""
    for row, channel in zip(found, sensed, strict=True):
        if channel.sensor.kind == 'motor_torque':
            j = instrument.motor_names.index(channel.sensor.of)
            gain, bias = numbers['motor_gain'][j], numbers['motor_bias'][j]
            wanted = reported[: len(row), j]
            given, _ = given_by(numbers, j, wanted)
            row += wanted - (given - bias) / gain
