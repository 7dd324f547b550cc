"""The same rig in general tools: scipy always, CasADi and MuJoCo where they are installed."""

from __future__ import annotations

import importlib
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import LSODA

from bench.reference import Reference
from bench.rig import five_pulleys, press_and_swing, RADIUS
from tendon_ros.model.cable import elongation_at
from tendon_ros.model.simulation import Simulation

FloatArray = NDArray[np.float64]

EPS = 1e-3  # [rad/s], over which the general tools smooth friction


class _Lsoda(Reference):
    """Scipy's stiff integrator on the reference's forces: friction smoothed, nothing located."""

    def _rhs(self, t: float, y: FloatArray) -> FloatArray:
        _, _, gap, _ = self._forces(y)
        self._closed = gap > 0.0
        return super()._rhs(t, y)

    def _advance(self, t: float, end: float, y: FloatArray) -> FloatArray:
        solver = LSODA(self._rhs, t, y, end, rtol=1e-7, atol=1e-9)
        while solver.status == 'running':
            solver.step()
        return np.asarray(solver.y)


def lsoda(right: FloatArray, seconds: float = 1.0) -> dict[str, float]:
    """
    Run sampled control with scipy's LSODA, restarted at each tick, forces in numpy.

    :param right: the reference's angles [rad].
    :param seconds: how long; the time is scaled to ten seconds.
    :return: time of ten seconds [s], error [rad].
    """
    setpoints = press_and_swing(seconds)
    begun = time.perf_counter()
    angle = _Lsoda(five_pulleys(), smooth=EPS).run(setpoints)[:, :5]
    spent = time.perf_counter() - begun
    return {
        'time': spent * 10.0 / seconds,
        'error': float(np.abs(angle - right[: len(angle)]).max()),
    }


def _held() -> tuple[FloatArray, FloatArray]:
    """Return set-points that press and stay, and the kernel's angles for them at 100 Hz."""
    held = np.tile(np.deg2rad([5.0, -2.0]), (10001, 1))
    rows = Simulation(five_pulleys(continuous=True), tolerance=1e-9).follow(held, every=10)
    return held[0], rows.angle


def casadi() -> dict[str, float] | None:
    """
    Run continuous control for ten seconds with CasADi's cvodes, friction smoothed.

    :return: time [s], error [rad]; None where CasADi is not installed.
    """
    try:
        ca: Any = importlib.import_module('casadi')
    except ImportError:
        return None
    one = five_pulleys(continuous=True)
    wished, right = _held()
    routing = one.routing()
    inertia = np.array([p.inertia for p in one.pulleys])
    damping = np.array([p.damping for p in one.pulleys])
    d0 = 1e3 * elongation_at(one.curves[0], 5.0)
    x = ca.SX.sym('x', 12)
    th, om, z = x[:5], x[5:10], x[10:]
    delta = 1e3 * ca.mtimes(ca.DM(routing), th)

    def cable(stretch: Any) -> Any:
        pulled = ca.fmax(stretch, 1e-12)
        return 7.77 * pulled + 1.35 * pulled**6.37

    first, second = cable(d0 + delta), cable(d0 - delta)
    torque = -damping * om - ca.mtimes(ca.DM(routing.T), first - second)
    contact = one.contacts[0]
    q, v = th[3], om[3]
    press = contact.arm**2 * (contact.stiffness * q + contact.damping * v)
    torque[3] -= ca.if_else(q > 0, ca.fmax(press, 0), 0)
    load = ca.mtimes(ca.DM(np.abs(routing).T), first + second)
    torque[2:] -= 0.1 * load[2:] * om[2:] / ca.sqrt(om[2:] ** 2 + EPS**2)
    gains = one.motors[0].controller
    error = ca.DM(wished) - th[:2]
    torque[:2] += ca.fmin(ca.fmax(gains.kp * error + gains.ki * z - gains.kd * om[:2], -5), 5)
    rate = ca.vertcat(om, torque / inertia, error)
    grid = 0.01 * np.arange(1, len(right))
    options = {'abstol': 1e-9, 'reltol': 1e-7}
    integrator = ca.integrator('rig', 'cvodes', {'x': x, 'ode': rate}, 0.0, grid, options)
    start = np.zeros(12)
    integrator(x0=start)
    begun = time.perf_counter()
    ends = np.array(integrator(x0=start)['xf'])
    spent = time.perf_counter() - begun
    return {'time': spent, 'error': float(np.abs(ends[:5].T - right[1:]).max())}


MUJOCO = """
<mujoco>
  <option timestep="1e-4" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>{bodies}</worldbody>
  <tendon>{tendons}</tendon>
  <actuator>{motors}</actuator>
</mujoco>
"""


def mujoco(integrator: str) -> dict[str, float] | None:
    """
    Time ten seconds of MuJoCo: straight cables, PD control, no friction, no wall, step 1e-4.

    MuJoCo has neither hardening pairs of cables nor friction by tension: only its time says
    something.

    :param integrator: ``RK4`` or ``implicitfast``.
    :return: time [s]; None where MuJoCo is not installed.
    """
    try:
        mj: Any = importlib.import_module('mujoco')
    except ImportError:
        return None
    one = five_pulleys()
    bodies = ''.join(
        f'<body><joint name="{p.name}" type="hinge" axis="0 0 1" damping="{p.damping}" '
        f'armature="{p.inertia}"/><geom size="0.001" mass="1e-6" contype="0"/></body>'
        for p in one.pulleys
    )
    tendons = ''.join(
        f'<fixed name="{loop.name}" stiffness="17500" springlength="0">'
        + ''.join(f'<joint joint="{n}" coef="{r}"/>' for n, r in loop.route.items())
        + '</fixed>'
        for loop in one.loops
    )
    motors = ''.join(f'<position joint="{m.pulley}" kp="20" kv="0.05"/>' for m in one.motors)
    text = MUJOCO.format(integrator=integrator, bodies=bodies, tendons=tendons, motors=motors)
    model = mj.MjModel.from_xml_string(text)
    data = mj.MjData(model)
    data.ctrl[:] = [RADIUS, -RADIUS]
    begun = time.perf_counter()
    mj.mj_step(model, data, 100_000)
    return {'time': time.perf_counter() - begun}
