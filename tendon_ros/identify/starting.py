"""
Where fits begin, found in what is left: times of events, periods of ripples, levels of limits.

So are preloads that leave a cable slack. A coarse grid would miss them, and no derivative leads
there.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate, starts
from tendon_ros.identify.driving import drives
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.motor_gain import motor_gain
from tendon_ros.identify.step_size import fineness
from tendon_ros.identify.untold import usual_part
from tendon_ros.identify.waves import COARSE, powers, ripples
from tendon_ros.model.numbers import place_index

FloatArray = NDArray[np.float64]
Start = tuple[Candidate, dict[str, float]]

EVENTS = 2  # starts of one event: in all recordings, or in one of them
BEGUN = 0.1  # part of a recording before an event, and after: else it has always been there
FEWEST = 2  # ripples that can be compared
WAVES = 400.0  # of a ripple over a turn that are looked for, more where counts are finer
#: times from one limit of a motor's torque that is tried to the next: where the limit cuts peaks
#: only, one that is half as far again cuts none of them, or far too much
LEVELS = 1.25
#: times the preload at which a cable would begin to loosen
LOOSE = (1.2, 0.9, 0.65)
LASTS = 0.3  # part of a recording from which on what lasts is no event


class Starting:
    """
    Finds starts in what one fitted state leaves.

    :param problem: the data.
    :param fit: the state.
    """

    def __init__(self, problem: Problem, fit: Fit) -> None:
        self._problem = problem
        self._fit = fit

    def of(self, candidate: Candidate) -> list[Start]:
        """
        Return where fits of a candidate may begin.

        :param candidate: the candidate.
        :return: the candidate, an event perhaps in one recording alone, with values.
        """
        kinds = {p.search for p in candidate.parameters}
        grid = starts(candidate)
        if 'instant' in kinds:
            return self._instants(candidate, grid[0])
        if 'cycles' in kinds:
            grid = self._cycles(candidate, grid[0])
        if 'level' in kinds:
            grid = self._levels(candidate, grid[0])
        if 'slack' in kinds:
            grid += self._slack(candidate, grid[0])
        return [(candidate, values) for values in grid]

    def _instants(self, candidate: Candidate, values: dict[str, float]) -> list[Start]:
        """
        Find when an event began (and ended) from the signature of one that always lasts.

        In all recordings at one time, or in one of them alone.
        """
        [instant] = [p for p in candidate.parameters if p.search == 'instant']
        lasting = [p for p in candidate.parameters if p.search == 'duration']
        always = dict(values) | {instant.name: 0.0} | {p.name: 1e5 for p in lasting}
        model = self._fit.model.joined(candidate, always)
        change = self._problem.left(model) - self._fit.left
        if not np.isfinite(change).all() or not change.any():
            return []
        names = [s.name for s in self._problem.rollouts.segments]
        found: list[tuple[float, Candidate, dict[str, float]]] = []
        for only in ['', *(names if len(names) > 1 else [])]:
            one = replace(candidate, only=only)
            sums = self._running_sums(change, one)
            if sums is not None:
                first = 0.0 if between_recordings(self._problem, one) else BEGUN
                gain, begun = _best_begin(one, values, first, *sums)
                found.append((gain, one, begun))
        found.sort(key=lambda entry: -entry[0])
        return [(one, begun) for _, one, begun in found[:EVENTS] if begun]

    def _running_sums(
        self, change: FloatArray, candidate: Candidate
    ) -> tuple[FloatArray, FloatArray, FloatArray] | None:
        """Return running sums over time of pull and square, over the segments where it acts."""
        segments = self._problem.rollouts.segments
        acting = [n for n, s in enumerate(segments) if candidate.acts_in(s.name)]
        bins = max(len(segments[n].time) for n in acting)
        period = segments[acting[0]].period
        pull, square = np.zeros(bins + 1), np.zeros(bins + 1)
        masks = self._problem.masks
        changes = self._problem.groups(change)
        lefts = self._problem.groups(self._fit.left)
        for (n, c, own), (_, _, left) in zip(changes, lefts, strict=True):
            if n not in acting:
                continue
            at = np.flatnonzero(masks[n][c]) + 1
            np.add.at(pull, at, own * left)
            np.add.at(square, at, own * own)
        if square.sum() < 1e-6:
            return None
        time: FloatArray = period * np.arange(bins + 1, dtype=np.float64)
        return time, np.cumsum(pull), np.cumsum(square)

    def _cycles(self, candidate: Candidate, values: dict[str, float]) -> list[dict[str, float]]:
        """
        Find the period of a ripple from what is left of the motor's torque over its angle.

        A reading that knows no sign has it upside down where the torque is negative, as what the
        slowest of ripples would do to it tells.
        """
        instrument = self._problem.rollouts.instrument
        motors = [m for m in instrument.motors if f'motor_{m.name}' == candidate.place]
        encoded = {d.motor for d in drives(instrument) if not d.by_torque}
        if not motors or motors[0].name not in encoded:
            return [values]
        [cycles] = [p for p in candidate.parameters if p.search == 'cycles']
        [phase] = [p for p in candidate.parameters if p.search == 'phase']
        slow = dict(values) | {cycles.name: cycles.low, phase.name: phase.low}
        change = self._problem.left(self._fit.model.joined(candidate, slow)) - self._fit.left
        if not np.isfinite(change).all():
            return [values]
        most = min(WAVES / fineness(instrument), cycles.high)
        grid = ripples(self._problem, candidate.place, most)
        if len(grid) < FEWEST:
            return []
        power = np.zeros(len(grid))
        segments = self._problem.rollouts.segments
        groups, changed = (self._problem.groups(left) for left in (self._fit.left, change))
        for (n, c, left), (_, _, turned) in zip(groups, changed, strict=True):
            sensor = segments[n].measured[c].sensor
            if sensor.kind != 'motor_torque' or sensor.of != motors[0].name:
                continue
            if not len(left):
                continue
            row = segments[n].prescribed.index(motors[0].pulley)
            motion, mask = segments[n].motion.value[row], self._problem.masks[n][c]
            angle, moves = motion[mask], np.abs(np.gradient(motion))[mask]
            sign = np.sign(turned * np.sin(cycles.low * angle - phase.low))
            power += powers(grid, angle, moves, left, sign)
        around = np.concatenate([[-math.inf], power, [-math.inf]])
        peaks = [k for k in range(len(grid)) if around[k] <= power[k] >= around[k + 2]]
        peaks.sort(key=lambda k: -power[k])
        waves = [float(grid[k]) for k in peaks[:3]]
        if grid[1] - grid[0] < COARSE:
            # a motor's poles come again after a turn: what else is left has moved the peak
            waves = [*dict.fromkeys([*waves, *(float(round(w)) for w in waves)])]
        return [one | {cycles.name: w} for w in waves for one in starts(candidate)]

    def _levels(self, candidate: Candidate, values: dict[str, float]) -> list[dict[str, float]]:
        """Try limits between the largest torque of what the motor reported and the usual one."""
        instrument = self._problem.rollouts.instrument
        [motor] = [m.name for m in instrument.motors if f'motor_{m.name}' == candidate.place]
        known = [
            np.abs(m.value[np.isfinite(m.value)])
            for s in self._problem.rollouts.segments
            for m in s.measured
            if m.sensor.kind == 'motor_torque' and m.sensor.of == motor
        ]
        torques = np.concatenate(known) if known else np.zeros(0)
        # the limit is one of what it gives
        torques = motor_gain(self._problem, self._fit.model, motor) * torques
        if not torques.any():
            return []
        [name] = [p.name for p in candidate.parameters if p.search == 'level']
        largest = 0.98 * float(torques.max())
        usual = float(np.quantile(torques, usual_part(instrument, motor)))
        least = min(max(usual, 0.1 * largest), 0.8 * largest)
        levels = 1 + math.ceil(math.log(largest / least) / math.log(LEVELS))
        return [values | {name: float(v)} for v in np.geomspace(largest, least, levels)]

    def _slack(self, candidate: Candidate, values: dict[str, float]) -> list[dict[str, float]]:
        """Try preloads about the one at which the cable is slack where it is stretched least."""
        instrument = self._problem.rollouts.instrument
        _, k = place_index(instrument, candidate.place)
        loop = instrument.loops[k]
        [curve] = [c for c in instrument.curves if c.name == loop.curve]
        [name] = [p.name for p in candidate.parameters if p.search == 'slack']
        tension = np.interp(self._stretches[k], curve.elongation, curve.tension)
        begins = float(tension) / max(loop.pretension, 1e-12)
        if not begins < values[name]:
            return []
        return [values | {name: part * begins} for part in LOOSE]

    @cached_property
    def _stretches(self) -> FloatArray:
        """How far the cables of each loop are let out at most [m], shape (loops,)."""
        problem = self._problem
        let_out = problem.rollouts.let_out(problem.uses(self._fit.model))
        return np.asarray(np.abs(let_out).max(axis=0))


def between_recordings(problem: Problem, candidate: Candidate) -> bool:
    """
    Return whether a candidate may have happened before its one recording began.

    :param problem: the data.
    :param candidate: the candidate.
    :return: whether others of several recordings tell what was before, and nothing ends it.
    """
    lasts = any(p.search == 'duration' for p in candidate.parameters)
    return bool(candidate.only) and len(problem.rollouts.segments) > 1 and not lasts


def _best_begin(
    candidate: Candidate,
    values: dict[str, float],
    first: float,
    time: FloatArray,
    pull: FloatArray,
    square: FloatArray,
) -> tuple[float, dict[str, float]]:
    """
    Return by how much an event lowers the squares, with its values; none where it does nothing.

    ``first``: part of the time in which it does not begin; ``time``, ``pull``, ``square``: running
    sums, shape (bins + 1,), of an event that lasts.
    """
    [instant] = [p for p in candidate.parameters if p.search == 'instant']
    lasting = [p for p in candidate.parameters if p.search == 'duration']
    [size] = [p for p in candidate.parameters if not p.is_shape]
    ends = len(time) - 1
    # what begins with the first bin that counts has always been there
    seen = int(np.searchsorted(square, 1e-9 * square[-1], side='right'))
    begin = max(seen + 1, round(first * ends))
    longest = max(2, round(LASTS * ends))
    best = (0.0, min(begin, ends - 1), ends)
    for a in range(begin, round((1.0 - BEGUN) * ends), max(1, ends // 400)):
        stop = np.arange(a + 1, min(a + longest, ends) + 1, 2) if lasting else np.array([ends])
        p, s = pull[stop] - pull[a], square[stop] - square[a]
        gains = np.where(s > 0.05 * square[-1] / max(ends, 1), p * p / np.maximum(s, 1e-12), 0.0)
        k = int(np.argmax(gains))
        best = max(best, (float(gains[k]), a, int(stop[k])))
    gain, a, b = best
    grown = -float(pull[b] - pull[a]) / max(float(square[b] - square[a]), 1e-12)
    found = dict(values) | {instant.name: float(time[a])}
    found |= {p.name: max(float(time[b] - time[a]), p.low) for p in lasting}
    found[size.name] = float(
        np.clip(size.neutral + grown * (size.typical - size.neutral), size.low, size.high)
    )
    return gain, found if found[size.name] != size.neutral else {}
