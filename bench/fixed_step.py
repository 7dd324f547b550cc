"""
A check on the default integration: Runge-Kutta at a fixed step, friction as a clipped budget.

It takes forces, sensors and controllers from the same kernel, and nothing of its integration: no
error control, no located events, no linear algebra. At the start of each step a pulley at rest
sticks if the other torques are within its budget; one that would reverse within the step is
stopped at its end. What it gives converges with the step to what the default gives. It refuses a
step that could not.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import SimulationError
from tendon_ros.model.cable import elongation_at
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.rows import Rows
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]

#: h * |lambda| above which an oscillation of the system is drawn too coarsely: RK4 then changes
#: its amplitude by more than 1e-3 in a period
COARSE = 0.5


class FixedStep:
    """
    An instrument with sampled controllers, integrated at a fixed step, in plain Python.

    :param instrument: the network with its effects.
    :param step: [s], a whole part of the control period.
    :raises SimulationError: on a step that is unstable or inaccurate; names the largest allowed.
    """

    def __init__(self, instrument: Instrument, step: float) -> None:
        self._instrument = instrument
        self._runner = Runner(instrument, arrays_of(instrument), 'plain')
        self._at = self._runner.structure
        self._kernel = self._runner.engine.module
        self._signals = Signals.none().flat.tolist()
        self._size = 2 * self._at['N'] + self._runner._d[self._at['ACTIVE']]
        whole = round(instrument.control_period / step)
        if whole < 1 or abs(whole * step - instrument.control_period) > 1e-9 * step:
            raise SimulationError(
                f'{instrument.name}: a fixed step of {step:g} s does not divide the control '
                f'period of {instrument.control_period:g} s; give a whole part of it'
            )
        limit = self.largest_step()
        if not step <= limit:
            raise SimulationError(
                f'{instrument.name}: a fixed step of {step:g} s is too large for its stiffness; '
                f'the largest allowed is {limit:.3g} s'
            )
        self._steps = whole
        self._step = step

    def largest_step(self) -> float:
        """
        Return the largest step that is stable, and fine enough for every oscillation.

        The eigenvalues are those of the right-hand side, linearised numerically at rest, with all
        cables as tight as the motors can pull them, and with closed contacts.

        :return: [s].
        """
        values = np.concatenate([np.linalg.eigvals(self._jacobian(*c)) for c in self._corners()])
        values = values[np.abs(values) > 1e-6]
        if not len(values):
            return float('inf')
        ringing = values[np.abs(values.imag) > np.abs(values.real)]
        fine = COARSE / np.abs(ringing).max() if len(ringing) else np.inf
        damped = values[values.real < 0.0]
        low, high = 0.0, min(10.0 / np.abs(values).max(), 1.0)
        for _ in range(60):
            h = 0.5 * (low + high)
            z = h * damped
            grows = np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))) > 1.0
            low, high = (low, h) if grows.any() else (h, high)
        return float(min(low, fine))

    def run(self, setpoints: FloatArray, every: int = 1) -> Rows:
        """
        Run from rest.

        :param setpoints: positions wished for the motors [rad], shape (ticks, motors).
        :param every: record every so many ticks.
        :return: what was recorded.
        :raises SimulationError: where it diverges.
        """
        at, kernel, run = self._at, self._kernel, self._runner
        run.rest({})
        wished = np.asarray(setpoints, dtype=np.float64)
        flat = wished.ravel().tolist()
        rows = [0.0] * ((len(wished) - 1) // every + 1) * run.width
        m, d, w, c = run._m, run._d, run._work, run._carried
        c[at['ROOM']] = float(len(rows) // run.width)
        for tick in range(len(wished)):
            c[at['TICK']] = float(tick)
            self._begin()
            kernel.sense(m, d, w, c, [], at['START'], 0)
            kernel.control(m, d, w, run._modes, self._signals, c, flat, at['U'] * tick)
            self._begin()
            kernel.sense(m, d, w, c, [], at['START'], 1)
            kernel.record(m, d, w, c, c[at['CLOCK']], rows, every, at['START'])
            for n in range(self._steps):
                if n:
                    self._begin()
                self._advance()
                c[at['CLOCK']] = tick * m[at['PERIOD']] + (n + 1) * self._step
            if not abs(run._state[0]) < 1e6:
                raise SimulationError(
                    f'{self._instrument.name}: the fixed-step simulation diverged near '
                    f'{c[at["CLOCK"]]:.4f} s; ask for a smaller step'
                )
        table = np.array(rows).reshape(-1, run.width)
        return Rows(self._instrument, at, table, len(wished) * self._steps)

    def _begin(self) -> None:
        """Let the kernel see anew which pulleys stick, slide which way, and what touches."""
        at, run = self._at, self._runner
        for i in range(at['N']):
            run._modes[at['MODE'] + i] = 2
        run._work[at['EPOCH']] = run._carried[at['CLOCK']] + 0.5 * self._step
        self._kernel.begin(
            run._m, run._d, run._work, run._modes, self._signals, run._carried, run._state
        )

    def _slope(self, state: list[float]) -> list[float]:
        """Return the right-hand side; contacts are looked at again."""
        at, run = self._at, self._runner
        w, g = run._work, run._modes
        trial = at['TRIAL']
        w[trial : trial + self._size] = state
        forces = (run._m, run._d, w, g, self._signals, run._carried, 0.0, trial)
        self._kernel.evaluate(*forces)
        closed = [int(w[at['GAP'] + k] > 0.0) for k in range(at['K'])]
        touch = slice(at['TOUCH'], at['TOUCH'] + at['K'])
        if closed != list(g[touch]):
            g[touch] = closed
            self._kernel.evaluate(*forces)
        return list(w[at['F'] : at['F'] + self._size])

    def _advance(self) -> None:
        """Take one classic Runge-Kutta step from the carried state; the directions hold."""
        run, h = self._runner, self._step
        y = list(run._state[: self._size])
        slopes = [self._slope(y)]
        for part in (0.5, 0.5, 1.0):
            slopes.append(
                self._slope([a + part * h * b for a, b in zip(y, slopes[-1], strict=True)])
            )
        n, at = self._at['N'], self._at
        for i in range(self._size):
            a, b, c, e = (slope[i] for slope in slopes)
            run._state[i] = y[i] + h / 6.0 * (a + 2.0 * b + 2.0 * c + e)
        for i in range(n):
            # the budget is no more than what stops the pulley within the step
            if run._d[at['DRY'] + i] == 1 and run._modes[at['MODE'] + i] * run._state[n + i] < 0.0:
                run._state[n + i] = 0.0

    def _corners(self) -> list[tuple[FloatArray, bool]]:
        """Return where it is stiffest: angles in the kernel's order, contacts closed or not."""
        one, at = self._instrument, self._at
        order = list(at.order)
        routing = one.routing()
        curves = {curve.name: curve for curve in one.curves}
        force = sum(
            min(m.controller.limit, m.torque_limit) / abs(routing[k, one.index(m.pulley)])
            for m in one.motors
            for k in np.flatnonzero(routing[:, one.index(m.pulley)])[:1]
        )
        tight = np.zeros(len(routing))
        for k, loop in enumerate(one.loops):
            curve = curves[loop.curve]
            most = min(max(force, loop.pretension), curve.tension[-1])
            tight[k] = elongation_at(curve, most) - elongation_at(curve, loop.pretension)
        angles = np.linalg.pinv(routing) @ tight if len(routing) else np.zeros(len(order))
        rest = np.zeros(len(order))
        return [(rest, False), (angles[order], False), (rest, True), (angles[order], True)]

    def _jacobian(self, angles: FloatArray, closed: bool) -> FloatArray:
        """Return the derivative of the right-hand side by differences, nothing sticking."""
        at, run = self._at, self._runner
        base = np.zeros(self._size)
        base[: at['N']] = angles
        for i in range(at['N']):
            run._modes[at['MODE'] + i] = 2

        def slope(state: FloatArray) -> FloatArray:
            for k in range(at['K']):
                run._modes[at['TOUCH'] + k] = int(closed and run._d[at['CONTACT_ON'] + k] == 1)
            trial = at['TRIAL']
            run._work[trial : trial + self._size] = state.tolist()
            self._kernel.evaluate(
                run._m, run._d, run._work, run._modes, self._signals, run._carried, 0.0, trial
            )
            return np.array(run._work[at['F'] : at['F'] + self._size])

        small = 1e-7
        columns = [
            (slope(base + small * e) - slope(base - small * e)) / (2.0 * small)
            for e in np.eye(self._size)
        ]
        run.rest({})
        return np.array(columns).T
