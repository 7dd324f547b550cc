"""
Where the gap lies: which place, in which regime.

For a cause that was found, its place is its own. For what stays unexplained, each place is asked
what an arbitrary torque, stretch or reading error there could explain: the directions in which
channels answer together differ from place to place, whatever the law behind it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import contact_place, Instrument

FloatArray = NDArray[np.float64]
TextArray = NDArray[np.str_]

TURN = 0.25  # [s] about a reversal
STILL = 0.03  # part of the largest speed below which a motor holds
PIECE = 0.12  # [s] over which an unknown cause is taken as constant


@dataclass(frozen=True)
class Spot:
    """A place, a regime, and the power of the gap there."""

    place: str
    regime: str
    power: float


def regimes(segment: Segment, force: FloatArray | None) -> TextArray:
    """
    Return the regime of each bin: how the motors move, and what presses on the tip.

    :param segment: the recording.
    :param force: predicted force of all contacts, shape (bins,); None without contacts.
    :return: texts, shape (bins,).
    """
    speed = segment.motion.slope
    largest = np.abs(speed).max(axis=1, keepdims=True) + 1e-9
    relative = np.abs(speed) / largest
    leading = relative.argmax(axis=0)
    bins = np.arange(speed.shape[1])
    own = speed[leading, bins]
    moving = relative[leading, bins] > STILL
    names = np.full(len(bins), 'holding', dtype='<U40')
    names[moving & (own > 0.0)] = 'moving forward'
    names[moving & (own < 0.0)] = 'moving backward'
    width = max(1, round(TURN / segment.period))
    for row in speed:
        sign = np.sign(np.where(np.abs(row) > STILL * np.abs(row).max(), row, 0.0))
        told = sign[sign != 0.0]
        at = np.flatnonzero(sign)
        for turn in at[1:][np.diff(told) != 0.0]:
            names[max(0, turn - width) : turn + width] = 'reversal'
    if force is not None and np.abs(force).max(initial=0.0) > 0.0:
        strong = np.abs(force) > 0.5 * np.abs(force).max()
        touching = (np.abs(force) > 0.02 * np.abs(force).max()) & ~strong
        names[touching] = np.char.add(names[touching], ', contact')
        names[strong] = np.char.add(names[strong], ', high force')
    return names


class Places:
    """
    Asks each place of an instrument what it could explain.

    :param problem: the bins to judge by.
    :param fit: the state.
    """

    def __init__(self, problem: Problem, fit: Fit) -> None:
        self._left = problem.left(fit.model)
        self._piece = problem.clusters(PIECE)
        count = int(self._piece.max()) + 1
        self._directions = {
            place: problem_direction
            for place, problem_direction in self._all(problem, fit)
            if np.abs(problem_direction).max(initial=0.0) > 1e-9
        }
        self._count = count

    def _all(self, problem: Problem, fit: Fit) -> list[tuple[str, FloatArray]]:
        instrument = problem.rollouts.instrument
        probes = _probes(instrument)
        found = []
        for place, candidate, values in probes:
            change = problem.left(fit.model.joined(candidate, values)) - self._left
            if np.isfinite(change).all():
                found.append((place, change))
        readings: dict[str, FloatArray] = {}
        for segment, channel, span in problem.spans():
            sensor = problem.rollouts.segments[segment].measured[channel].sensor
            if sensor.kind != 'motor_torque':
                readings.setdefault(sensor.name, np.zeros_like(self._left))[span] = 1.0
        return [*found, *readings.items()]

    def shares(self, most: int = 4) -> list[tuple[str, FloatArray]]:
        """
        Return what the places explain, the best first, each of what the ones before leave.

        :param most: so many places.
        :return: place, and the power that it takes from each sample, shape (samples,).
        """
        left = self._left.copy()
        rest = dict(self._directions)
        found = []
        for _ in range(most):
            best, least, kept = '', 0.0, left
            for place, direction in rest.items():
                trial = left - self._imitated(left, direction)
                gain = float(left @ left - trial @ trial)
                if gain > least:
                    best, least, kept = place, gain, trial
            if not best:
                break
            found.append((best, left**2 - kept**2))
            left = kept
            del rest[best]
        return found

    def _imitated(self, left: FloatArray, direction: FloatArray) -> FloatArray:
        """Return what an unknown of this direction, constant in each piece, explains."""
        pull = np.bincount(self._piece, weights=left * direction, minlength=self._count)
        square = np.bincount(self._piece, weights=direction**2, minlength=self._count)
        size = pull / np.maximum(square, 1e-12 + 1e-6 * square.max())
        # pieces in which noise alone would give as much are left alone
        size[pull**2 < 4.0 * square] = 0.0
        return size[self._piece] * direction


def _probes(instrument: Instrument) -> list[tuple[str, Candidate, dict[str, float]]]:
    """Return a small disturbance at each place that is not a sensor."""
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
    return found
