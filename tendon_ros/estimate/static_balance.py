"""
Encoders and torques, no contact known: the angles and the force that balance the measured torques.

Each measurement gives the angles of some pulleys and some torques. Unknown are the other angles
and the operating force. The torques on every pulley must balance (the paper's (1)-(6) without
inertia), and the measured torques must be met as well as their noise lets them: weighted least
squares by Gauss-Newton, whose covariance is the stated uncertainty.

Where a pulley rests or turns round torques tell little of the force, since its friction is as
uncertain as the angles make it. So a measurement is weighed with what force and friction are
expected to be (:mod:`.expectation`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgels

from tendon_ros.base.errors import InstrumentError, listed, RecordingError
from tendon_ros.estimate.channels import (
    deviation,
    estimated_angles,
    operating_force,
    sensors_of,
    usual_channels,
)
from tendon_ros.estimate.equations import BALANCE, Equations
from tendon_ros.estimate.expectation import Expectation, Expected
from tendon_ros.estimate.observer import Estimate, Measurement, Observer
from tendon_ros.estimate.play import Play
from tendon_ros.estimate.rest import Rest
from tendon_ros.estimate.rigid import Rigid, told_if_rigid
from tendon_ros.estimate.rubbing import doubts_after, readable, Rubbing, unsure_angles
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.statics import Since, Statics

FloatArray = NDArray[np.float64]
#: what a search finds: cost, place of force and frictions in what is expected of them, slopes by
#: unknowns and by measured angles
Found = tuple[float, FloatArray, FloatArray, FloatArray]

#: a Newton step below this ends the search [rad, N or N m]
CLOSE = 1e-9
#: a step that promises to lower the weighted squares by less than this ends the search too
PROMISE = 1e-6
#: most steps of one search; where cables go slack the last ones change nothing to speak of
TRIES = 60
#: deviations by which every equation may be off, and for how many measurements in a row more
REFUSED, IN_A_ROW = 100.0, 20
#: deviations from which on the sides of a coupling's play are tried
DOUBTFUL = 1.5
#: velocities for the direction of friction are smoothed over this time [s]
SMOOTHING = 0.02
#: prior deviation of an angle about where it was carried; holds what no channel sees [rad]
WANDER = 1.0


class StaticBalanceObserver(Observer):
    """
    Solves the balance of torques at every measurement.

    :param instrument: the network.
    :param channels: channels to use; where None the motors' positions and efforts, or those of
        the shafts where no motor tells its torque.
    :param wander: by how much the force wanders in a second [N or N m]; None where nothing is
        known of it.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    :raises InstrumentError: where the channels cannot determine the operating force.
    """

    def __init__(
        self,
        instrument: Instrument,
        *,
        channels: Sequence[str] | None = None,
        wander: float | None = None,
        engine: str = 'auto',
    ) -> None:
        super().__init__(instrument)
        self._instrument = instrument
        self._operating = operating_force(instrument)
        known = sensors_of(instrument, ('angle', 'motor_torque', 'loop_torque'))
        if channels is None:
            channels = usual_channels(known)
        for name in channels:
            if name not in known:
                raise InstrumentError(
                    f'{instrument.name}: no sensor gives {name!r}; it has {listed(known)}'
                )
        self.needs = tuple(channels)
        self._angles = [
            (name, instrument.index(known[name].of))
            for name in channels
            if known[name].kind == 'angle'
        ]
        self._torques = [name for name in channels if known[name].kind != 'angle']
        if not self._angles or not self._torques:
            raise InstrumentError(
                f'{instrument.name}: this method needs at least one angle and one torque; the '
                f'channels chosen are {listed(channels)}'
            )
        self._fixed = [i for _, i in self._angles]
        self._free = [i for i in range(len(instrument.pulleys)) if i not in self._fixed]
        # what a model misses of an angle stays much the same from one reading to the next
        self._sigma_angle = np.array(
            [self._readings.slope(name) * deviation(known[name]) for name, _ in self._angles]
        )
        coarsest = max(known[name].resolution for name, _ in self._angles)
        self._statics = Statics(readable(instrument, coarsest), engine=engine)
        doubts = [(known[name], self._doubt(known[name])) for name in self._torques]
        self._equations = Equations(instrument, self._operating, doubts, self._free)
        count = len(self._equations.doubt)
        #: slopes of what free angles, force and frictions are expected to be
        self._prior = np.diag(
            np.append(np.full(len(self._free), 1.0 / WANDER), np.ones(1 + count))
        )
        least = told_if_rigid(instrument, doubts, self._operating)
        self._expectation = Expectation(least, wander, count)
        self._narrow = '' if wander is None else f', or the force wanders by more than {wander:g}'
        self._rigid = Rigid(instrument, self._free)
        noisy = dict(zip(self._fixed, self._sigma_angle.tolist(), strict=True))
        sound = replace(
            instrument, sensors=tuple(replace(s, misfit=0.0) for s in instrument.sensors)
        )
        trembling = unsure_angles(sound, self._rigid, noisy)
        missed = {i: self._doubt(known[name]) for name, i in self._angles}
        unsure = unsure_angles(instrument, self._rigid, missed)
        # by noise, and by all where a diagnosis left more than that
        levels = [trembling, unsure][: 1 + bool(np.any(unsure > trembling))]
        self._frictions = [Rubbing(self._statics, level) for level in levels]
        self._rest = Rest(unsure, self._equations.on_pulleys)
        self._play = Play(instrument, self._free, self._statics)
        self._reset()

    def _reset(self) -> None:
        self._statics.reset()
        self._angle = np.zeros(len(self._instrument.pulleys))
        for friction in self._frictions:
            friction.reset()
        self._velocity = np.zeros(len(self._instrument.pulleys))
        self._expectation.reset()
        self._unsure = np.zeros(len(self._equations.doubt))
        self._exact = self._equations.doubt
        self._rest.reset()
        self._refused = 0
        self._waited = 0.0  # since the last measurement that balanced [s]
        self._begun = False

    def _update(self, measurement: Measurement, gap: float) -> Estimate:
        gap += self._waited
        angle = self._angle.copy()
        for name, i in self._angles:
            angle[i] = measurement.values[name]
        carried = self._rigid.free(angle)
        if self._begun:  # along with the measured angles: play is not crossed on the way
            carried += self._angle[self._free] - self._rigid.free(self._angle)
        angle[self._free] = carried
        moving = self._begun and gap > 0.0
        # velocity by angle, solved for along with the angle: taking the last one instead would
        # feed a noisy angle back through the damping
        self._pace = 1.0 / (gap + SMOOTHING) if moving else 0.0
        self._drift = self._velocity * (SMOOTHING / (gap + SMOOTHING)) if moving else 0.0
        read = np.array([measurement.values[name] for name in self._torques])
        before = self._angle if self._begun else angle.copy()
        # friction builds up along with the angle, too: stiffer than a cable after a reversal
        self._since = Since(before, gap) if moving else None
        unsure = self._unsure
        same = self._rest.same(before, angle, read, unsure)
        expected = self._expectation.foreseen(gap, unsure, same)
        found, covariance = self._solve(angle, read, expected)
        velocity = self._moved(angle) if moving else self._velocity
        doubts = doubts_after(self._frictions, self._statics, before, angle, velocity, gap)
        trembles, doubt = (self._equations.on_pulleys @ doubts[k] for k in (0, -1))
        # what the model misses of angles leaves friction wrong by the same for as long as a pulley
        # rests, what noise makes of them by another each time
        unsure = np.sqrt(np.maximum(doubt**2 - trembles**2, 0.0))
        weighed, self._exact = self._exact, np.hypot(self._equations.doubt, trembles)
        if np.any(np.maximum(doubt, self._unsure) > BALANCE):  # seen only now: once more
            same = self._rest.same(before, angle, read, unsure)
            expected = self._expectation.foreseen(gap, unsure, same)
            found, covariance = self._solve(angle, read, expected)
        spread = self._expectation.deviation(covariance, expected)
        if self._strained <= REFUSED:
            self._statics.carry(before, angle, gap)
            for friction in self._frictions:
                friction.carry(before, angle, gap)
            self._rest.carry(before, angle, read)
            self._expectation.taken(found, covariance, expected, unsure, gap)
            self._angle, self._velocity, self._unsure = angle, velocity, unsure
            self._refused, self._waited, self._begun = 0, 0.0, True
        else:  # what does not balance says nothing of where the pulleys are, and leads nowhere
            self._exact = weighed
            self._refused += 1
            if self._refused > IN_A_ROW:
                raise RecordingError(
                    f'{", ".join(self.needs)}: no angles and force balance what was measured; a '
                    f'unit or a sign may be wrong{self._narrow}'
                )
            self._waited = gap
        values = {
            self._operating.channel: float(found[0]),
            # what does not balance is known so much less
            f'{self._operating.channel}_std': spread * self._strained,
            **estimated_angles(self._instrument, angle),
        }
        return Estimate(measurement.stamp_ns, values)

    def _moved(self, angle: FloatArray) -> FloatArray:
        """Return the smoothed velocities [rad/s] if the angles now are these."""
        return np.asarray(self._drift + self._pace * (angle - self._angle))

    def _solve(
        self, angle: FloatArray, read: FloatArray, expected: Expected
    ) -> tuple[FloatArray, FloatArray]:
        """Find free angles (in place), force and frictions; return these and their covariance."""
        self._expected = expected
        begun = angle.copy()
        doubtful = DOUBTFUL**2 * len(self._exact)

        def better(across: FloatArray, best: Found, least: float = 0.0, *, bold: bool) -> Found:
            again = self._searched(across, begun, read, bold=bold)
            if not again[0] < best[0] + least:
                return best
            angle[:] = across
            return again

        best = self._searched(angle, begun, read)
        if best[0] > doubtful:  # held at the edge of slack, perhaps
            best = better(angle.copy(), best, bold=True)
        # where torques change with no angle: at its edge they do
        within = self._play.inside(angle)
        if within or best[0] > doubtful:
            for across in self._play.sides(angle):
                best = better(across, best, PROMISE if within else 0.0, bold=False)
        if best[0] > doubtful:
            for across in self._play.corners(angle):
                best = better(across, best, bold=True)
        cost, place, rows, by_fixed = best
        orthogonal, upper = np.linalg.qr(rows)
        inverse = np.linalg.solve(upper, orthogonal.T)
        inverse = expected.spread @ inverse[len(self._free) :]
        through = inverse[:, : len(by_fixed)] @ (by_fixed * self._sigma_angle)
        # what overflows balances nothing: no number is to stay none
        self._strained = math.sqrt(max(cost / len(self._exact), 1.0))
        found = expected.mean + expected.spread @ place
        return found, inverse @ inverse.T + through @ through.T

    def _searched(
        self, angle: FloatArray, begun: FloatArray, read: FloatArray, *, bold: bool = False
    ) -> Found:
        """
        Descend from angles (in place): cost, force and frictions, slopes.

        Where a cable goes slack a step that only goes down ends at once; Newton's own, taken
        boldly, is over it.
        """
        place = np.zeros(self._expected.spread.shape[1])
        count = len(self._free)
        start = begun[self._free]
        cost, residual, rows, by_fixed = self._weighed(angle, start, place, read)
        for _ in range(TRIES):
            _, found, _ = dgels(rows, -residual)  # least squares; priors make every column count
            move = found[: rows.shape[1]]
            promised = float(np.sum(np.square(rows @ move)))
            if np.abs(move).max() < CLOSE or promised < PROMISE:
                break
            # the curve's knee and slack make a full step overshoot: shorten it until it helps
            part = min(1.0, 0.05 / max(float(np.abs(move[:count]).max(initial=0.0)), 0.05))
            for _ in range(12):
                trial = angle.copy()
                trial[self._free] += part * move[:count]
                after = self._weighed(trial, start, place + part * move[count:], read)
                if after[0] < cost or bold:
                    break
                part *= 0.4
            else:
                break  # no shorter step helps: this is the minimum to rounding
            angle[:] = trial
            place = place + part * move[count:]
            cost, residual, rows, by_fixed = after
        return cost, place, rows, by_fixed

    def _weighed(
        self, angle: FloatArray, start: FloatArray, place: FloatArray, read: FloatArray
    ) -> tuple[float, FloatArray, FloatArray, FloatArray]:
        """Return cost, residuals with the prior's, their slopes, and slopes by measured angles."""
        balance = self._statics.at(angle, self._moved(angle), self._since)
        force, *friction = self._expected.mean + self._expected.spread @ place
        residual, by_angle = self._equations.left(balance, self._pace, force, friction, read)
        weight = 1.0 / self._exact[:, None]
        by_angle = by_angle * weight
        residual = np.concatenate(
            [residual / self._exact, (angle[self._free] - start) / WANDER, place]
        )
        count, equations = len(self._free), len(by_angle)
        rows = np.zeros((len(residual), count + len(place)))
        rows[:equations, :count] = by_angle[:, self._free]
        rows[:equations, count:] = weight * self._equations.by_force @ self._expected.spread
        rows[equations:] = self._prior[: rows.shape[1], : rows.shape[1]]
        return float(residual @ residual), residual, rows, by_angle[:, self._fixed]
