"""
An independent reference: the same physics by dense matrices and DOP853, events by root-finding.

Shares nothing with the kernel but the cable's table: matrices instead of lists, an explicit method
of order 8 at 1e-12 instead of RODAS4, Brent's root-finding on its dense output of order 7 instead
of the kernel's events. Slow, and therefore trusted.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from tendon_ros.model.cable import elongation_at, uniform_cubic
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]


class Reference:
    """
    An instrument with dry friction, contacts, slack, and sampled or continuous PID.

    :param instrument: its effects may be ``tension_friction``, ``coulomb_friction`` and
        ``stribeck_friction``.
    :param tolerance: relative and absolute, of every step.
    :param smooth: speed [rad/s] over which friction is smoothed; None where it sticks.
    """

    def __init__(
        self, instrument: Instrument, tolerance: float = 1e-12, smooth: float | None = None
    ) -> None:
        one = instrument
        self._instrument = one
        self._tolerance = tolerance
        self._smooth = smooth
        self._n = len(one.pulleys)
        self._J = np.array([p.inertia for p in one.pulleys])
        self._B = np.array([p.damping for p in one.pulleys])
        self._C = one.routing()
        self._A = self._C.copy()
        for k, loop in enumerate(one.loops):
            for name, sign in loop.torque_sign.items():
                self._A[k, one.index(name)] *= sign
        curve = one.curves[0] if one.curves else None
        if curve is not None:
            self._start, self._rate, self._cubic = uniform_cubic(curve)
            self._d0 = np.array([elongation_at(curve, loop.pretension) for loop in one.loops])
        self._soft = np.array([c.stiffness for c in one.couplings])
        self._damped = np.array([row.damping for row in (*one.loops, *one.couplings)])
        self._Q = np.zeros((len(one.contacts), self._n))
        for k, contact in enumerate(one.contacts):
            for name, ratio in contact.route.items():
                self._Q[k, one.index(name)] = ratio
        self._budgets = [
            self._budget(use.effect, use.place, use.parameters) for use in one.effects
        ]
        self._dry = np.zeros(self._n, dtype=bool)
        self._dry[[i for i, _ in self._budgets]] = True
        self._motor = np.array([one.index(m.pulley) for m in one.motors], dtype=int)
        self.events = 0

    def _budget(self, effect: str, place: str, p: object) -> tuple[int, Callable[..., float]]:
        i = self._instrument.index(place.removeprefix('pulley_'))
        values = dict(p)  # type: ignore[call-overload]
        if effect == 'tension_friction':
            return i, lambda speed, load: values['coefficient'] * load
        if effect == 'coulomb_friction':
            return i, lambda speed, load: values['torque']
        if effect == 'stribeck_friction':

            def falling(speed: float, load: float) -> float:
                fall = 1.0 + (np.sqrt(2.0) - 1.0) * (speed / values['speed']) ** 2
                return float(values['sliding'] + values['static'] / fall**2)

            return i, falling
        raise ValueError(f'the reference has no {effect}')

    def _cable(self, x: FloatArray) -> FloatArray:
        u = (x - self._start) * self._rate
        cell = np.clip(u.astype(int), 0, len(self._cubic) - 1)
        v = np.clip(u - cell, 0.0, 1.0)
        a, b, c, e = self._cubic[cell].T
        t = a + v * (b + v * (c + v * e))
        return t + np.maximum(u - len(self._cubic), 0.0) * (b + 2.0 * c + 3.0 * e)

    def _forces(self, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return torques without dry friction, budgets, contact gaps and slack reserves."""
        one, n = self._instrument, self._n
        th, om = y[:n], y[n : 2 * n]
        delta, rate = self._C @ th, self._C @ om
        tension = self._damped * rate
        L = len(one.loops)
        total = np.zeros(len(delta))
        slack = np.zeros(0)
        if L:
            first, second = self._cable(self._d0 + delta[:L]), self._cable(self._d0 - delta[:L])
            tension[:L] += first - second
            total[:L] = first + second
            slack = self._d0 - self._start - np.abs(delta[:L])
        tension[L:] += self._soft * delta[L:]
        torque = self._input - self._B * om - self._A.T @ tension
        gap = np.zeros(len(one.contacts))
        self.force = np.zeros(len(one.contacts))
        for k, c in enumerate(one.contacts):
            q, v = self._Q[k] @ th - c.position, self._Q[k] @ om
            if c.law == 'spring_damper':
                force = c.stiffness * c.arm * q + c.damping * c.arm * v
                gap[k] = min(q, force / (c.stiffness * c.arm))
            else:
                force = c.stiffness * c.arm * q * (1.0 + c.damping * c.arm * v)
                gap[k] = min(q, 1.0 + c.damping * c.arm * v)
            if not c.enabled:
                gap[k] = -1.0
            if self._closed[k]:
                self.force[k] = force
                torque -= self._Q[k] * c.arm * force
        load = np.abs(self._C).T @ total
        budget = np.zeros(n)
        for i, law in self._budgets:
            speed = self._mode[i] * om[i] if self._smooth is None else abs(om[i])
            budget[i] += law(speed, load[i])
        self.tension = tension
        return torque, budget, gap, slack

    def _pid(self, t: float, y: FloatArray, integral: FloatArray) -> FloatArray:
        value, slope = self._target(t)
        error = value - y[self._motor]
        gains = [m.controller for m in self._instrument.motors]
        wish = np.array(
            [
                g.kp * e + g.ki * z + g.kd * (s - w)
                for g, e, z, s, w in zip(
                    gains, error, integral, slope, y[self._n + self._motor], strict=True
                )
            ]
        )
        self._error = error
        return wish

    def _rhs(self, t: float, y: FloatArray) -> FloatArray:
        n = self._n
        out = np.zeros(len(y))
        if len(y) > 2 * n:
            self._input[self._motor] = self._pid(t, y, y[2 * n :])
            out[2 * n :] = self._error
        torque, budget, _, _ = self._forces(y)
        out[:n] = y[n : 2 * n]
        if self._smooth is None:
            rub = np.where(self._mode == 2, 0.0, -self._mode * budget)
        else:
            om = y[n : 2 * n]
            rub = -budget * om / np.sqrt(om**2 + self._smooth**2)
        out[n : 2 * n] = np.where(self._mode == 0, 0.0, (torque + rub) / self._J)
        return out

    def _due(self, y: FloatArray, low: FloatArray) -> FloatArray:
        """Return all event functions: positive as long as nothing has happened."""
        torque, budget, gap, slack = self._forces(y)
        om = y[self._n : 2 * self._n]
        moving = np.where(self._mode == 2, 1.0, self._mode * om)
        dry = np.where(self._mode == 0, budget - np.abs(torque), moving)
        meet = np.where(self._closed, gap, -gap)
        return np.concatenate([dry, meet, np.where(low > 0.0, slack, -slack)])

    def _free(self, y: FloatArray) -> None:
        """Let go what is pushed harder than it holds."""
        torque, budget, _, _ = self._forces(y)
        loose = (self._mode == 0) & (np.abs(torque) > budget)
        self._mode[loose] = np.sign(torque[loose])

    def _advance(self, t: float, end: float, y: FloatArray) -> FloatArray:
        n = self._n
        while t < end - 1e-13:
            self._free(y)
            _, _, _, low = self._forces(y)
            solver = DOP853(
                self._rhs, t, y, end, rtol=self._tolerance, atol=self._tolerance,
                first_step=min(self._first, end - t),
            )  # fmt: skip
            found = False
            while solver.status == 'running' and not found:
                solver.step()
                if solver.status == 'failed':
                    raise ArithmeticError(f'the reference failed at {solver.t} s')
                late = self._due(solver.y, low)
                # a loop that starts at the very edge of slack has no event there
                edge = np.concatenate([np.zeros(n + len(self._closed), bool), np.abs(low) < 1e-10])
                fallen = np.flatnonzero((late < 0.0) & ~edge)
                if not len(fallen):
                    continue
                dense = solver.dense_output()
                roots = [self._root(dense, e, solver.t_old, solver.t, low) for e in fallen]
                which = int(fallen[int(np.argmin(roots))])
                t = float(min(roots))
                y = dense(t)
                self._happen(which, y)
                self.events += 1
                found = True
            self._first = max(solver.step_size or self._first, 1e-6)
            if not found:
                return np.asarray(solver.y)
        return y

    def _root(
        self,
        dense: Callable[[float], FloatArray],
        event: int,
        start: float,
        end: float,
        low: FloatArray,
    ) -> float:
        """Return the time in a step at which an event happens."""
        start += 1e-12 * (end - start)
        if self._due(dense(start), low)[event] <= 0.0:
            return start
        return float(
            brentq(lambda x: self._due(dense(x), low)[event], start, end, xtol=1e-15, rtol=1e-15)
        )

    def _happen(self, which: int, y: FloatArray) -> None:
        n, K = self._n, len(self._closed)
        if which < n and self._mode[which] == 0:
            torque, _, _, _ = self._forces(y)
            self._mode[which] = np.sign(torque[which])
        elif which < n:
            y[n + which] = 0.0
            self._mode[which] = 0
        elif which < n + K:
            self._closed[which - n] ^= True

    def run(
        self,
        setpoints: FloatArray,
        *,
        pose: FloatArray | None = None,
        signals: Callable[[float], tuple[FloatArray, FloatArray]] | None = None,
        push: FloatArray | None = None,
    ) -> FloatArray:
        """
        Run from rest.

        :param setpoints: of sampled controllers [rad], shape (ticks, motors).
        :param pose: angles to start from [rad].
        :param signals: for continuous control: values and slopes of the set-points at a time.
        :param push: constant torques instead of any control [N m], shape (pulleys,).
        :return: angles, velocities and contact forces at each tick, shape (ticks, 2 n + contacts).
        """
        one, n = self._instrument, self._n
        dt = one.control_period
        motors = len(one.motors)
        y = np.zeros(2 * n + (motors if signals else 0))
        if pose is not None:
            y[:n] = pose
        self._mode = np.where(self._dry & (self._smooth is None), 0, 2)
        self._closed = np.zeros(len(one.contacts), dtype=bool)
        self._input = np.zeros(n) if push is None else np.array(push, dtype=float)
        self._first = 1e-5
        if signals:
            self._target = signals
            self._input[self._motor] = self._pid(0.0, y, y[2 * n :])
        _, _, gap, _ = self._forces(y)
        self._closed = gap > 1e-12
        total = np.zeros(motors)
        past: FloatArray | None = None
        rows = np.zeros((len(setpoints), 2 * n + len(one.contacts)))
        for tick, wished in enumerate(setpoints):
            if not signals and push is None:
                error = wished - y[self._motor]
                past = error if past is None else past
                for j, motor in enumerate(one.motors):
                    g = motor.controller
                    tried = total[j] + dt * error[j]
                    wish = g.kp * error[j] + g.ki * tried + g.kd * (error[j] - past[j]) / dt
                    give = min(max(wish, -g.limit), g.limit)
                    total[j] = tried if give == wish else total[j]
                    self._input[self._motor[j]] = give
                past = error
            self._forces(y)
            rows[tick] = np.concatenate([y[: 2 * n], self.force])
            y = self._advance(tick * dt, (tick + 1) * dt, y)
        return rows
