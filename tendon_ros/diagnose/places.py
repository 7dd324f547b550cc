"""
Which place is to blame for what no cause explains.

Each place is asked what an arbitrary torque, stretch or reading error there could explain: the
directions in which channels answer together differ from place to place, whatever the law behind
it. Where directions are alike, the law decides after all: an error of a place is a function of
what that place feels, its angle and direction, its speed, its torque or its force.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import drives
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.model.instrument import contact_place, Instrument
from tendon_ros.model.rows import Rows

FloatArray = NDArray[np.float64]

PIECE = 0.12  # [s] over which an unknown cause is taken as constant
ALIKE = 0.75  # part of the best place's gain from which on another may be the one
#: weight of what a function of what a place feels leaves, where any size at any time counts one
LAWFUL = 0.1
NOISE = 0.05  # power in noise deviations that says nothing of a place
LEVELS = 8  # of what a place feels
FINE = 24  # of an encoder's angle: an error of its wheel comes back within a turn
RELAXING = (0.5, 4.0)  # [s] in which a cable forgets a force
SAME = 0.99  # part of what one place answers that another can from which on they are as one


@dataclass(frozen=True)
class Blamed:
    """
    A place that may be to blame.

    ``power``: what it takes from each sample, shape (samples,); ``same``: places that no channel
    tells from it where that is, by what their laws leave.
    """

    place: str
    power: FloatArray
    same: tuple[str, ...]


class Places:
    """
    Asks each place of an instrument what it could explain.

    :param problem: the bins to judge by.
    :param fit: the state.
    """

    def __init__(self, problem: Problem, fit: Fit) -> None:
        self._problem = problem
        self._left = problem.left(fit.model)
        self._piece = problem.clusters(PIECE)
        self._count = int(self._piece.max()) + 1
        self._directions = {
            place: direction
            for place, direction in self._all(fit)
            if np.abs(direction).max(initial=0.0) > 1e-9
        }
        self._felt = _felt(problem, problem.rollouts.states(problem.uses(fit.model)))
        # what a wrong law has bent the file's numbers to, they give back beside the right place
        moving = len(problem.tolerances)
        self._slope = fit.slope[:, fit.slope.shape[1] - moving :]
        self._prior = problem.prior(fit.model)[fit.slope.shape[1] - moving :]
        self._moved = fit.model.moved
        self._likely = problem.begun.moved
        self._ends = np.array([t.axis.ends for t in problem.tolerances]).reshape(-1, 2)

    def _all(self, fit: Fit) -> list[tuple[str, FloatArray]]:
        problem = self._problem
        found = []
        for place, candidate, values in _probes(problem.rollouts.instrument):
            change = problem.left(fit.model.joined(candidate, values)) - self._left
            if np.isfinite(change).all():
                found.append((place, change))
        readings: dict[str, FloatArray] = {}
        for segment, channel, span in problem.spans():
            sensor = problem.rollouts.segments[segment].measured[channel].sensor
            places = [sensor.name]
            if sensor.kind == 'motor_torque':  # the motor itself may give another torque
                places.insert(0, f'motor_{sensor.of}')
            for place in places:
                readings.setdefault(place, np.zeros_like(self._left))[span] = 1.0
        return [*found, *readings.items()]

    def shares(self, most: int = 4) -> list[Blamed]:
        """
        Return what the places explain, the best first, each of what the ones before leave.

        :param most: so many places.
        :return: the places.
        """
        left, moved = self._left, self._moved
        rest = dict(self._directions)
        found: list[Blamed] = []
        while rest and len(found) < most:
            trials = {place: self._imitated(left, moved, d) for place, d in rest.items()}
            order = self._blamed(left, moved, {place: kept for place, (kept, _) in trials.items()})
            if not order:
                break
            best, *same = order
            kept, moved = trials[best]
            found.append(Blamed(best, left**2 - kept**2, tuple(same)))
            left = kept
            del rest[best]
        return found

    def _blamed(
        self, left: FloatArray, moved: FloatArray, kept: dict[str, FloatArray]
    ) -> list[str]:
        """
        Return the place to blame and those that no channel tells from it; none where none helps.

        ``kept``: what even any size at any time at a place leaves. That decides; where it is
        much alike, what a law of the place leaves does; and that alone where no channel can.
        """
        whole, noise = float(left @ left), NOISE * len(left)
        stays = {place: float(one @ one) for place, one in kept.items()}
        least = ALIKE * (whole - min(stays.values()))
        if least <= 0.0:
            return []
        near = {place: x + noise for place, x in stays.items() if whole - x >= least}
        law = {p: max(whole - self._lawful(p, left, moved), 0.0) + noise for p in near}
        best = min(near, key=lambda p: math.log(near[p]) + LAWFUL * math.log(law[p]))
        same = self._same(best, near, left**2 - kept[best] ** 2)
        return sorted([best, *same], key=lambda place: law[place])

    def _same(self, place: str, others: Iterable[str], power: FloatArray) -> list[str]:
        """
        Return the places that only a law could tell from one, and no channel can.

        A motor's torque, its reading and a torque on the pulley that it turns are such; so are a
        wall and the cable that presses on it, where all that is left lies in contact. ``power``:
        what the place takes from each sample, which says when it is asked.
        """
        own = self._directions[place]
        weight = np.maximum(self._summed(power), 0.0)
        weight /= max(float(weight.sum()), 1e-300)

        def alike(other: FloatArray) -> float:
            squares = np.maximum(self._summed(own**2) * self._summed(other**2), 1e-300)
            return float(weight @ (self._summed(own * other) ** 2 / squares))

        return [p for p in others if p != place and alike(self._directions[p]) > SAME]

    def _imitated(
        self, left: FloatArray, moved: FloatArray, direction: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return what a size that is constant in each piece leaves, and where the numbers go."""
        square = self._summed(direction**2)
        by_piece = 1.0 / np.maximum(square, 1e-12 + 1e-6 * square.max())

        def cleared(vector: FloatArray) -> FloatArray:
            size = self._summed(vector * direction) * by_piece
            return vector - size[self._piece] * direction

        slope = np.array([cleared(column) for column in self._slope.T]).reshape(-1, len(left)).T
        normal = slope.T @ slope + np.diag(self._prior + 1e-9)
        wish = slope.T @ cleared(left) + self._prior * (moved - self._likely)
        wished = moved - np.linalg.solve(normal, wish)
        after = np.clip(wished, self._ends[:, 0], self._ends[:, 1])
        left = left + self._slope @ (after - moved)
        pull = self._summed(left * direction)
        size = pull * by_piece
        # pieces in which noise alone would give as much are left alone
        size[pull**2 < 4.0 * square] = 0.0
        return left - size[self._piece] * direction, after

    def _summed(self, samples: FloatArray) -> FloatArray:
        """Return sums over pieces."""
        return np.bincount(self._piece, weights=samples, minlength=self._count)

    def _lawful(self, place: str, left: FloatArray, moved: FloatArray) -> float:
        """Return how much a function of what the place feels explains, the numbers moving."""
        design = self._felt[place] * self._directions[place][:, None]
        scale = np.sqrt(np.maximum(np.einsum('ij,ij->j', design, design), 1e-300))
        design = np.hstack([design / scale, self._slope])
        prior = np.concatenate([np.full(len(scale), 1e-9), self._prior])
        pull = design.T @ left
        pull[len(scale) :] += self._prior * (moved - self._likely)
        return float(pull @ np.linalg.solve(design.T @ design + np.diag(prior), pull))


def _probes(instrument: Instrument) -> list[tuple[str, Candidate, dict[str, float]]]:
    """Return a small disturbance at each place that is not a sensor of what is predicted."""
    found: list[tuple[str, Candidate, dict[str, float]]] = []
    for pulley in instrument.pulleys:
        place = f'pulley_{pulley.name}'
        values = {'torque': 0.02, 'start': 0.0, 'duration': 1e5}
        found.append((place, Candidate('disturbance', place), values))
    for loop in instrument.loops:
        place = f'cable_{loop.name}'
        found.append((place, Candidate('cable_slip', place), {'jump': 1e-5, 'time': 0.0}))
    for coupling in instrument.couplings:
        place = f'coupling_{coupling.name}'
        found.append((place, Candidate('cable_slip', place), {'jump': 1e-3, 'time': 0.0}))
    for contact in instrument.contacts:
        place = contact_place(instrument, contact)
        found.append((place, Candidate('contact_position', place), {'angle': 1e-4}))
    for drive in drives(instrument):
        if drive.by_torque:
            place = f'motor_{drive.motor}'
            found.append((place, Candidate('torque_bias', place), {'torque': 0.02}))
        else:
            place = drive.sensor.name
            found.append((place, Candidate('encoder_offset', place), {'angle': 1e-4}))
    return found


def _felt(problem: Problem, states: Sequence[Rows]) -> dict[str, FloatArray]:
    """Return functions of what each place feels, shape (samples, functions), by place."""
    instrument = problem.rollouts.instrument
    found: dict[str, FloatArray] = {}

    def keep(place: str, rows: Sequence[Sequence[FloatArray]]) -> None:
        """Keep functions, given as one list a segment, on the samples."""
        found[place] = np.stack(
            [problem.sampled([functions[k] for functions in rows]) for k in range(len(rows[0]))],
            axis=1,
        )

    for i, pulley in enumerate(instrument.pulleys):
        angle, speed = [s.angle[:, i] for s in states], [s.velocity[:, i] for s in states]
        # what rubs may do so by angle and direction, what drags by speed
        by_angle, by_speed = _levels(angle, speed), _levels(speed, None)
        both = [[*at, *fast] for at, fast in zip(by_angle, by_speed, strict=True)]
        keep(f'pulley_{pulley.name}', both)
        keep(f'encoder_{pulley.name}', _levels(angle, None, FINE))
    names = [*(f'cable_{x.name}' for x in instrument.loops)]
    names += [f'coupling_{x.name}' for x in instrument.couplings]
    for i, place in enumerate(names):
        force = [s.loop_force[:, i] for s in states]
        relaxed = [
            [_relaxed(f, segment.time, tau) for tau in RELAXING]
            for f, segment in zip(force, problem.rollouts.segments, strict=True)
        ]
        keep(place, [[*a, *b] for a, b in zip(_rising(force), relaxed, strict=True)])
    for j, motor in enumerate(instrument.motor_names):
        rows = _rising([s.effort[:, j] for s in states])
        others = [s.effort for s in states]
        extra = [[np.gradient(e[:, j]), *np.delete(e, j, axis=1).T] for e in others]
        keep(f'motor_{motor}', [[*a, *b] for a, b in zip(rows, extra, strict=True)])
    for k, contact in enumerate(instrument.contacts):
        keep(
            contact_place(instrument, contact),
            _rising([s.contact_force[:, k] for s in states]),
        )
    for q, sensor in enumerate(instrument.sensors):
        if sensor.name not in found:
            keep(sensor.name, _rising([s.reading[:, q] for s in states]))
    return found


def _rising(values: Sequence[FloatArray]) -> list[list[FloatArray]]:
    """Return levels of a force, those in which it rises apart from those in which it falls."""
    return _levels(values, [np.gradient(v) for v in values])


def _relaxed(force: FloatArray, time: FloatArray, tau: float) -> FloatArray:
    """Return a force that follows another with a delay of first order, at rest before."""
    kept = np.exp(-np.gradient(time).mean() / tau)
    begun = force[0]
    return np.asarray(begun + lfilter([1.0 - kept], [1.0, -kept], force - begun))


def _levels(
    values: Sequence[FloatArray], ways: Sequence[FloatArray] | None, count: int = LEVELS
) -> list[list[FloatArray]]:
    """Return indicators of levels, by direction where there is one, for each segment."""
    every = np.concatenate(values)
    edges = np.linspace(every.min(), every.max() + 1e-12, count + 1)[1:-1]
    found = []
    for n, value in enumerate(values):
        level = np.searchsorted(edges, value)
        row = [(level == k).astype(np.float64) for k in range(count)]
        if ways is not None:
            up = (ways[n] > 0.0).astype(np.float64)
            row = [r * way for r in row for way in (up, 1.0 - up)]
            row.append(ways[n])
        found.append(row)
    return found
