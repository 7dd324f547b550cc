"""
Screening: what each candidate could explain of what is left, tolerances and causes refitted.

One rollout with the candidate at a typical size gives its signature. What tolerances and causes
can imitate is projected out, and the size that fits best follows by least squares; a second
rollout at that size corrects for friction and slack, which are far from linear.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate, starts
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

EVENTS = 2  # proposals of one event: in all recordings, or in one of them


@dataclass(frozen=True)
class Proposal:
    """
    A candidate with the values from which a fit may begin.

    ``gain``: by how much the squares fall, to first order; ``seen``: norm of the signature of
    typical size, in noise deviations, and ``own``: the part of it that nothing else imitates.
    """

    candidate: Candidate
    values: dict[str, float]
    gain: float
    seen: float
    own: float


class Screen:
    """
    Judges candidates against one fitted state.

    :param problem: the data.
    :param fit: the state.
    """

    def __init__(self, problem: Problem, fit: Fit) -> None:
        self.problem = problem
        self.fit = fit
        self._inverse = problem.covariance(fit)

    def proposals(self, candidate: Candidate) -> list[Proposal]:
        """
        Return what a candidate could explain to first order, one proposal for each start.

        :param candidate: the candidate.
        :return: the proposals, best first; empty where it changes nothing that was measured.
        """
        found = []
        for one, values in self._starts(candidate):
            first = self._signature(one, values)
            if first is None:
                continue
            size, gain, seen, own = first
            if not candidate.scales:
                found.append(Proposal(one, values, gain if size > 0.0 else 0.0, seen, own))
            elif size <= 0.0 and candidate.one_sided:
                found.append(Proposal(one, values, 0.0, seen, own))
            else:
                scaled = _scaled(candidate, values, float(np.clip(size, -30.0, 30.0)))
                found.append(Proposal(one, scaled, gain, seen, own))
        return sorted(found, key=lambda p: -p.gain)

    def corrected(self, proposal: Proposal) -> Proposal:
        """
        Return a proposal judged at the size that it proposes.

        :param proposal: of this state.
        :return: the same candidate, its size corrected once more.
        """
        candidate = proposal.candidate
        if not candidate.scales or proposal.gain <= 0.0:
            return proposal
        second = self._signature(candidate, proposal.values)
        if second is None:
            return proposal
        size, gain, _, _ = second
        values = _scaled(candidate, dict(proposal.values), float(np.clip(size, 0.1, 10.0)))
        return replace(proposal, values=values, gain=gain if size > 0.0 else 0.0)

    def _signature(
        self, candidate: Candidate, values: dict[str, float]
    ) -> tuple[float, float, float, float] | None:
        """Return the best multiple of the signature, its gain, and norms whole and own."""
        model = self.fit.model.joined(candidate, values)
        change = self.problem.left(model) - self.fit.left
        if not np.isfinite(change).all():
            return None
        square = float(change @ change)
        if square < 1e-6:
            return None
        across = self.fit.slope.T @ change
        own = square - float(across @ self._inverse @ across)
        if own <= 1e-9 * square:
            return 0.0, 0.0, np.sqrt(square), 0.0
        pull = float(change @ self.fit.left) - float(
            across @ self._inverse @ (self.fit.slope.T @ self.fit.left)
        )
        size = -pull / own
        return size, pull * pull / own, np.sqrt(square), float(np.sqrt(own))

    # -- starts that a coarse grid would miss

    def _starts(self, candidate: Candidate) -> list[tuple[Candidate, dict[str, float]]]:
        kinds = {p.search for p in candidate.parameters}
        grid = starts(candidate)
        if 'instant' in kinds:
            return self._instants(candidate, grid[0])
        if 'cycles' in kinds:
            grid = self._cycles(candidate, grid[0])
        if 'level' in kinds:
            grid = self._levels(candidate, grid[0])
        return [(candidate, values) for values in grid]

    def _instants(
        self, candidate: Candidate, values: dict[str, float]
    ) -> list[tuple[Candidate, dict[str, float]]]:
        """
        Find when an event began (and ended) from the signature of one that always lasts.

        In all recordings at one time, or in one of them alone.
        """
        [instant] = [p for p in candidate.parameters if p.search == 'instant']
        lasting = [p for p in candidate.parameters if p.search == 'duration']
        always = dict(values) | {instant.name: 0.0} | {p.name: 1e5 for p in lasting}
        model = self.fit.model.joined(candidate, always)
        change = self.problem.left(model) - self.fit.left
        if not np.isfinite(change).all() or not change.any():
            return []
        names = [s.name for s in self.problem.rollouts.segments]
        found: list[tuple[float, Candidate, dict[str, float]]] = []
        for only in ['', *(names if len(names) > 1 else [])]:
            one = replace(candidate, only=only)
            sums = self._running_sums(change, one)
            if sums is not None:
                gain, begun = _best_begin(one, values, *sums)
                found.append((gain, one, begun))
        found.sort(key=lambda entry: -entry[0])
        return [(one, begun) for _, one, begun in found[:EVENTS] if begun]

    def _running_sums(
        self, change: FloatArray, candidate: Candidate
    ) -> tuple[FloatArray, FloatArray, FloatArray] | None:
        """Return running sums over time of pull and square, over the segments where it acts."""
        segments = self.problem.rollouts.segments
        acting = [n for n, s in enumerate(segments) if candidate.acts_in(s.name)]
        bins = max(len(segments[n].time) for n in acting)
        period = segments[acting[0]].period
        pull, square = np.zeros(bins + 1), np.zeros(bins + 1)
        masks = self.problem.masks
        changes = self.problem.groups(change)
        lefts = self.problem.groups(self.fit.left)
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
        """Find the period of a ripple from what is left of the motor's torque over its angle."""
        instrument = self.problem.rollouts.instrument
        motors = [m for m in instrument.motors if f'motor_{m.name}' == candidate.place]
        if not motors:
            return [values]
        grid = np.concatenate([np.arange(1.0, 60.0, 0.5), np.arange(60.0, 400.0, 2.0)])
        power = np.zeros(len(grid))
        segments = self.problem.rollouts.segments
        for n, c, left in self.problem.groups(self.fit.left):
            sensor = segments[n].measured[c].sensor
            if sensor.kind != 'motor_torque' or sensor.of != motors[0].name:
                continue
            if not len(left):
                continue
            row = segments[n].prescribed.index(motors[0].pulley)
            angle = segments[n].motion.value[row][self.problem.masks[n][c]]
            wave = np.exp(1j * np.outer(grid, angle[::2]))
            wave -= wave.mean(1, keepdims=True)
            part = left[::2] - left[::2].mean()
            power += np.abs(wave @ part) ** 2 / np.maximum((np.abs(wave) ** 2).sum(1), 1.0)
        [name] = [p.name for p in candidate.parameters if p.search == 'cycles']
        peaks = [k for k in range(1, len(grid) - 1) if power[k - 1] <= power[k] >= power[k + 1]]
        peaks.sort(key=lambda k: -power[k])
        shapes = starts(candidate)
        return [one | {name: float(grid[k])} for k in peaks[:3] for one in shapes]

    def _levels(self, candidate: Candidate, values: dict[str, float]) -> list[dict[str, float]]:
        """Try limits below the largest torque that the motor reported."""
        instrument = self.problem.rollouts.instrument
        names = [m.name for m in instrument.motors if f'motor_{m.name}' == candidate.place]
        largest = max(
            (
                float(np.nanmax(np.abs(m.value)))
                for s in self.problem.rollouts.segments
                for m in s.measured
                if m.sensor.kind == 'motor_torque' and m.sensor.of in names
            ),
            default=0.0,
        )
        [name] = [p.name for p in candidate.parameters if p.search == 'level']
        return [
            values | {name: part * largest} for part in (0.98, 0.85, 0.7, 0.5) if largest > 0.0
        ]


def _best_begin(
    candidate: Candidate,
    values: dict[str, float],
    time: FloatArray,
    pull: FloatArray,
    square: FloatArray,
) -> tuple[float, dict[str, float]]:
    """
    Return by how much an event lowers the squares, with its values; none where it does nothing.

    ``time``, ``pull``, ``square``: running sums, shape (bins + 1,), of an event that lasts.
    """
    [instant] = [p for p in candidate.parameters if p.search == 'instant']
    lasting = [p for p in candidate.parameters if p.search == 'duration']
    [size] = [p for p in candidate.parameters if not p.is_shape]
    ends = len(time) - 1
    best = (0.0, 0, ends)
    for a in range(0, ends, max(1, ends // 400)):
        stop = np.arange(a + 1, ends + 1, 2) if lasting else np.array([ends])
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


def _scaled(candidate: Candidate, values: dict[str, float], size: float) -> dict[str, float]:
    """Return values with sizes multiplied about their neutral, within bounds."""
    found = dict(values)
    for p in candidate.parameters:
        if not p.is_shape:
            grown = p.neutral + size * (values[p.name] - p.neutral)
            found[p.name] = float(np.clip(grown, p.low, p.high))
    return found
