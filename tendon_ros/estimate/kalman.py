"""
Encoders and torques with dynamics: an extended Kalman filter on the mechanics itself.

State: angles and velocities of all pulleys, and the operating force as a random walk. The mean is
carried by the same kernel that simulates, driven by the measured torques; its linearisation
carries the covariance. The encoders of the motors correct both.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from tendon_ros.estimate.channels import (
    angle_channel,
    estimated_angles,
    operating_force,
    sensors_of,
)
from tendon_ros.estimate.observer import Estimate, Measurement, Observer
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals
from tendon_ros.model.statics import Linearisation, without_contacts

FloatArray = NDArray[np.float64]

#: how fast the operating force may wander where nothing is known of it: its deviation after a
#: second, at the tip [N/sqrt(s)]
FORCE_WANDER = 5.0
#: torque on every pulley that the model does not know: its deviation [N m sqrt(s)]
TORQUE_WANDER = 1e-3
#: what is known at first: deviation of angles [rad], velocities [rad/s] and force at the tip [N]
FIRST_ANGLE, FIRST_VELOCITY, FIRST_FORCE = 0.02, 0.1, 5.0


class KalmanObserver(Observer):
    """
    The filter.

    :param instrument: with encoder and torque of every motor.
    :param wander: by how much the force wanders in a second [N or N m].
    :param engine: ``auto``, ``compiled`` or ``plain``.
    """

    def __init__(
        self, instrument: Instrument, *, wander: float | None = None, engine: str = 'auto'
    ) -> None:
        super().__init__(instrument)
        self._instrument = instrument
        self._operating = operating_force(instrument)
        self._wander = FORCE_WANDER * self._operating.newton if wander is None else wander
        driven = instrument.driven
        self._positions = tuple(angle_channel(instrument, name) for name in driven)
        self._efforts = tuple(f'actuator/pulley_{name}/effort' for name in driven)
        self.needs = (*self._positions, *self._efforts)
        known = sensors_of(instrument, ('angle', 'motor_torque'))
        self._variance = np.array([self._doubt(known[name]) ** 2 for name in self._positions])
        self._torque_variance = np.array([self._doubt(known[name]) ** 2 for name in self._efforts])
        free = without_contacts(instrument)
        everyone = {name: row for row, name in enumerate(instrument.pulley_names)}
        arrays = arrays_of(free, pushed=everyone)
        self._runner = Runner(free, arrays, engine)
        self._linearisation = Linearisation(self._runner.structure)
        at = arrays.structure
        order = np.array(at.order)
        self._inertia = np.empty(len(order))
        self._inertia[order] = arrays.m[at['INERTIA'] : at['INERTIA'] + at['N']]
        self._driven = [instrument.index(name) for name in driven]
        self._n = len(instrument.pulleys)
        self._reset()

    def _reset(self) -> None:
        self._begun = False
        self._last_effort = np.zeros(len(self._driven))

    def _begin(self, position: FloatArray) -> None:
        """Start at rest, cables as they are without load."""
        n = self._n
        routing = self._instrument.routing()
        free = [i for i in range(n) if i not in self._driven]
        self._angle = np.zeros(n)
        self._angle[self._driven] = position
        found, *_ = np.linalg.lstsq(
            routing[:, free], -routing[:, self._driven] @ position, rcond=None
        )
        self._angle[free] = found
        self._velocity = np.zeros(n)
        self._force = 0.0
        first = [FIRST_ANGLE] * n + [FIRST_VELOCITY] * n + [FIRST_FORCE * self._operating.newton]
        self._covariance = np.diag(np.square(first))
        self._runner.rest(dict(zip(self._instrument.pulley_names, self._angle, strict=True)))
        self._begun = True

    def _update(self, measurement: Measurement, gap: float) -> Estimate:
        position = np.array([measurement.values[name] for name in self._positions])
        effort = np.array([measurement.values[name] for name in self._efforts])
        if not self._begun:
            self._begin(position)
        else:
            self._predict(0.5 * (effort + self._last_effort), gap)
        self._last_effort = effort
        self._correct(position)
        values = {
            self._operating.channel: self._force,
            f'{self._operating.channel}_std': float(np.sqrt(self._covariance[-1, -1])),
            **estimated_angles(self._instrument, self._angle),
        }
        return Estimate(measurement.stamp_ns, values)

    def _predict(self, effort: FloatArray, gap: float) -> None:
        n = self._n
        push = self._operating.torque * self._force
        push[self._driven] += effort
        self._runner.place(self._angle, self._velocity)
        row = self._runner.glide(self._runner.time + gap, Signals.held(push))
        self._angle, self._velocity = row.angle[0].copy(), row.velocity[0].copy()
        balance = self._linearisation.read(self._runner)
        slope = np.zeros((2 * n + 1, 2 * n + 1))
        slope[:n, n : 2 * n] = np.eye(n)
        slope[n : 2 * n, :n] = -balance.stiffness / self._inertia[:, None]
        slope[n : 2 * n, n : 2 * n] = -balance.damping / self._inertia[:, None]
        slope[n : 2 * n, -1] = self._operating.torque / self._inertia
        # modes of the stiff cables turn by a radian between samples: nothing less than the
        # exponential carries their covariance; the noise in between by Simpson's rule
        half = np.asarray(expm(0.5 * gap * slope))
        carry = half @ half
        density = np.zeros(2 * n + 1)
        density[n : 2 * n] = np.square(TORQUE_WANDER / self._inertia)
        density[-1] = self._wander**2
        noise = np.diag(density)
        spread = noise + 4.0 * half @ noise @ half.T + carry @ noise @ carry.T
        by_effort = np.zeros((2 * n + 1, len(self._driven)))
        for j, i in enumerate(self._driven):
            by_effort[n + i, j] = np.sqrt(self._torque_variance[j]) / self._inertia[i]
        shaken = gap / 6.0 * (by_effort + 4.0 * half @ by_effort + carry @ by_effort)
        self._covariance = (
            carry @ self._covariance @ carry.T + gap / 6.0 * spread + shaken @ shaken.T
        )

    def _correct(self, position: FloatArray) -> None:
        rows = self._driven
        seen = self._covariance[np.ix_(rows, rows)] + np.diag(self._variance)
        gain = np.linalg.solve(seen, self._covariance[rows]).T
        move = gain @ (position - self._angle[rows])
        n = self._n
        self._angle = self._angle + move[:n]
        self._velocity = self._velocity + move[n : 2 * n]
        self._force += float(move[-1])
        kept = self._covariance - gain @ self._covariance[rows]
        self._covariance = 0.5 * (kept + kept.T)
