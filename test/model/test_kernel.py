"""The integration: order, Jacobian, events, switches, prescribed motion, live and batch alike."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import SimulationError
from tendon_ros.model.engine import compiler_installed
from tendon_ros.model.instrument import Coupling, EffectUse
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict, Simulation

#: what acts during the test of the order: every hook, every place in the Jacobian
IN_SITU = {
    'nothing': (),
    'viscous': (('viscous_friction', 'pulley_1', {'damping': 0.05}),),
    'gravity': (('gravity', 'pulley_3', {'torque': 0.3, 'phase': 0.4}),),
    'spring': (('joint_spring', 'pulley_2', {'stiffness': 2.0, 'rest': 0.1}),),
    'eccentricity': (
        ('eccentricity', 'pulley_1', {'amplitude': 0.2, 'phase': 0.7}),
        ('eccentricity', 'pulley_3', {'amplitude': 0.2, 'phase': -0.3}),
    ),
    'creep': (('cable_creep', 'cable_12', {'fraction': 0.5, 'time': 0.02, 'share': 0.3}),),
    'hysteresis': (('cable_hysteresis', 'cable_L3', {'force': 5.0, 'elongation': 1e-4}),),
    'tension': (
        ('tension_friction', 'pulley_1', {'coefficient': 0.1}),
        ('tension_friction', 'pulley_3', {'coefficient': 0.2}),
    ),
    'stribeck': (
        ('stribeck_friction', 'pulley_1', {'static': 0.05, 'sliding': 0.02, 'speed': 2.0}),
    ),
    'presliding': (
        ('tension_friction', 'pulley_1', {'coefficient': 0.1}),
        ('presliding_friction', 'pulley_1', {'torque': 0.02, 'angle': 0.02}),
    ),
    'creep with friction and eccentricity': (
        ('cable_creep', 'cable_12', {'fraction': 0.5, 'time': 0.02, 'share': 0.8}),
        ('eccentricity', 'pulley_1', {'amplitude': 0.2, 'phase': 0.7}),
        ('tension_friction', 'pulley_1', {'coefficient': 0.1}),
    ),
}


class Stepper:
    """The kernel's step at a fixed size, from a state in which everything moves one way."""

    def __init__(self, instrument, *, motion=(), references=()):
        names = {name: row for row, name in enumerate((*motion, *references))}
        arrays = arrays_of(
            instrument,
            prescribed={name: names[name] for name in motion},
            references={name: names[name] for name in references},
        )
        self.runner = Runner(instrument, arrays, 'plain')
        self.at = self.runner.structure
        t = 1e-3 * np.arange(-5, 26)
        # one cubic: the signals themselves must not limit the order
        values = np.array([0.05 + 2.0 * t - 30.0 * t**2 + 200.0 * t**3] * max(len(names), 1))
        slopes = np.array([2.0 - 60.0 * t + 600.0 * t**2] * max(len(names), 1))
        self.signals = Signals(values, slopes, t[0], 1e-3).flat.tolist()
        n = self.at['N']
        angle = {'M': 0.05, 'L': 0.03, '1': 0.04, '2': 0.02, '3': 0.01}
        speed = {'M': 2.0, 'L': 1.5, '1': 1.8, '2': 1.2, '3': 0.8}
        self.start = [0.0] * self.at['DIM']
        for at, own in enumerate(self.at.order):
            name = instrument.pulley_names[own]
            self.start[at] = angle[name]
            self.start[n + at] = speed[name]

    def run(self, count, duration=4e-3):
        """Return the state after so many equal steps."""
        run, at, kernel = self.runner, self.at, self.runner.engine.module
        run.rest({})
        m, d, w, g, c = run._m, run._d, run._work, run._modes, run._carried
        size = 2 * at['N'] + d[at['ACTIVE']]
        kernel.begin(m, d, w, g, self.signals, c, list(self.start))
        h = duration / count
        for n in range(count):
            kernel.linearise(m, d, w)
            kernel.hold(d, w, g)
            kernel.outer(m, d, w, g, self.signals, n * h)
            w[at['FIRST'] : at['FIRST'] + size] = w[at['F'] : at['F'] + size]
            kernel.step(m, d, w, g, self.signals, c, n * h, h)
            w[at['START'] : at['START'] + size] = w[at['NEXT'] : at['NEXT'] + size]
            kernel.evaluate(m, d, w, g, self.signals, c, (n + 1) * h, at['START'])
        return np.array(w[at['START'] : at['START'] + size])

    def linear_solves(self, h=1e-3, t=1.3e-3):
        """Return one stage's solution by the kernel, and by a dense system of differences."""
        run, at, kernel = self.runner, self.at, self.runner.engine.module
        run.rest({})
        m, d, w, g, c = run._m, run._d, run._work, run._modes, run._carried
        n, size = at['N'], 2 * at['N'] + d[at['ACTIVE']]

        def slope(t, state):
            w[at['TRIAL'] : at['TRIAL'] + size] = state.tolist()
            kernel.prescribe(m, d, w, self.signals, t, at['TRIAL'])
            kernel.evaluate(m, d, w, g, self.signals, c, t, at['TRIAL'])
            return np.array(w[at['F'] : at['F'] + size])

        kernel.begin(m, d, w, g, self.signals, c, list(self.start))
        kernel.prescribe(m, d, w, self.signals, t, at['START'])
        state = np.array(w[at['START'] : at['START'] + size])
        state[2 * n :] = 0.02
        small = 1e-7
        jacobian = np.array(
            [(slope(t, state + small * e) - slope(t, state - small * e)) / (2.0 * small)
             for e in np.eye(size)]
        ).T  # fmt: skip
        by_time = (slope(t + small, state) - slope(t - small, state)) / (2.0 * small)
        slope(t, state)
        w[at['START'] : at['START'] + size] = state.tolist()
        kernel.linearise(m, d, w)
        kernel.hold(d, w, g)
        kernel.outer(m, d, w, g, self.signals, t)
        per = 0.25 * h
        kernel.factor(m, d, w, 1.0 / per, per)
        free = np.array([not kernel.still(d, g, i) for i in range(n)])
        free = np.concatenate([free, free, np.ones(size - 2 * n, dtype=bool)])
        right = np.random.default_rng(0).standard_normal(size) * free
        w[at['RIGHT'] : at['RIGHT'] + size] = right.tolist()
        kernel.solve(m, d, w, 1.0 / per, per, at['STAGE'])
        ours = np.array(w[at['STAGE'] : at['STAGE'] + size])
        dense = np.linalg.solve(np.eye(size) / (0.25 * h) - jacobian * free[:, None], right)
        kicks = np.array(w[at['OUTER'] : at['OUTER'] + size])
        return ours, dense, kicks, by_time * free

    def order(self):
        """Return the order seen between 16 and 32 steps."""
        exact = self.run(256)
        coarse, fine = (np.abs(self.run(n) - exact).max() for n in (16, 32))
        return np.log2(coarse / fine), fine


def smooth_rig(bench_rig, effects=()):
    """Return the rig with a wall that is touched all along, and a gentle curve."""
    rig = bench_rig.five_pulleys(
        wall='hunt_crossley', effects=tuple(EffectUse(*use) for use in effects)
    )
    straight = replace(rig.curves[0], elongation=(0.0, 0.01), tension=(0.0, 175.0))
    contact = replace(rig.contacts[0], stiffness=2e4, position=-0.05)
    return replace(rig, curves=(straight,), contacts=(contact,),
                   loops=tuple(replace(loop, pretension=40.0) for loop in rig.loops))  # fmt: skip


def geared_rig(bench_rig):
    """Return the rig with gears for its cables, all rubbing with what passes through them."""
    rubbing = [('tension_friction', f'pulley_{n}', {'coefficient': 0.2}) for n in 'ML123']
    rig = smooth_rig(bench_rig, (*rubbing, *IN_SITU['gravity'], *IN_SITU['eccentricity']))
    gears = tuple(
        Coupling(loop.name, {name: 20.0 * arm for name, arm in loop.route.items()}, 30.0)
        for loop in rig.loops
    )
    return replace(rig, loops=(), curves=(), couplings=gears)


@pytest.mark.parametrize('name', IN_SITU)
def test_the_reduced_system_is_the_dense_one_with_every_law(bench_rig, name):
    ours, dense, *_ = Stepper(smooth_rig(bench_rig, IN_SITU[name])).linear_solves()
    assert np.abs(ours - dense).max() < 1e-6 * np.abs(dense).max()


@pytest.mark.parametrize('driven', [{}, {'motion': ('M',)}])
def test_the_reduced_system_is_the_dense_one_with_gears(bench_rig, driven):
    stepper = Stepper(geared_rig(bench_rig), **driven)
    ours, dense, kicks, by_time = stepper.linear_solves()
    assert np.abs(ours - dense).max() < 1e-6 * np.abs(dense).max()
    assert kicks == pytest.approx(by_time, rel=1e-5, abs=1e-2)
    order, error = stepper.order()
    assert order > 3.5
    assert error < 1e-4


@pytest.mark.parametrize('how', ['motion', 'references'])
def test_the_reduced_system_is_the_dense_one_with_signals(bench_rig, how):
    effects = (*IN_SITU['creep with friction and eccentricity'], *IN_SITU['hysteresis'])
    stepper = Stepper(smooth_rig(bench_rig, effects), **{how: ('M', 'L')})
    ours, dense, kicks, by_time = stepper.linear_solves()
    assert np.abs(ours - dense).max() < 1e-6 * np.abs(dense).max()
    assert np.abs(by_time).max() > 1.0
    assert kicks == pytest.approx(by_time, rel=1e-5, abs=1e-2)


@pytest.mark.parametrize(
    ('name', 'how'),
    [('nothing', {}), ('gravity', {}), ('eccentricity', {}), ('creep', {}), ('tension', {}),
     ('stribeck', {}), ('tension', {'motion': ('M', 'L')}), ('creep', {'references': ('M', 'L')})],
)  # fmt: skip
def test_order_is_four(bench_rig, name, how):
    order, error = Stepper(smooth_rig(bench_rig, IN_SITU[name]), **how).order()
    assert order > 3.5
    assert error < 1e-4


def test_a_wrong_jacobian_costs_the_order(bench_rig, monkeypatch):
    stepper = Stepper(smooth_rig(bench_rig, IN_SITU['tension']))
    kernel = stepper.runner.engine.module
    right = kernel.linearise

    def wrong(m, d, w):
        right(m, d, w)
        w[stepper.at['J_LOOP']] *= 1.05

    monkeypatch.setattr(kernel, 'linearise', wrong)
    assert stepper.order()[0] < 3.5


@pytest.mark.skipif(not compiler_installed(), reason='numba is not installed')
@pytest.mark.parametrize('wall', ['spring_damper', 'hunt_crossley'])
def test_plain_and_compiled_agree(bench_rig, press, wall):
    rig = bench_rig.five_pulleys(wall=wall)
    fast = Simulation(rig, engine='compiled').run(press[:250])
    plain = Simulation(rig, engine='plain').run(press[:250])
    assert np.abs(fast.angle - plain.angle).max() < 1e-9
    assert np.abs(fast.contact_force - plain.contact_force).max() < 1e-6


def test_a_slip_is_stopped_at_exactly(bench_rig, press):
    rig = bench_rig.five_pulleys(friction=0.0)
    time = 0.05037
    slip = EffectUse('cable_slip', 'cable_m1', {'jump': 5e-4, 'time': time})
    rows = Simulation(replace(rig, effects=(slip,)), tolerance=1e-10).run(press[:100])
    without = Simulation(rig, tolerance=1e-10).run(press[:100])
    before = rows.time <= time
    # the stop at the switch changes the steps, so equal within the tolerance, not bit for bit
    assert np.abs(rows.angle[before] - without.angle[before]).max() < 1e-9
    assert np.abs(rows.angle[~before] - without.angle[~before]).max() > 1e-4


def test_a_disturbance_has_its_closed_form(body):
    # torque 0.5 for 0.1 s from 0.0123 s on inertia 0.01: 5 rad/s, 0.25 rad while it lasts
    push = {'torque': 0.5, 'start': 0.0123, 'duration': 0.1}
    free = body(effects=(EffectUse('disturbance', 'pulley_body', push),))
    rows = Simulation(free, engine='plain').run(np.zeros((201, 1)))
    late = rows.time - 0.0123
    during = np.clip(late, 0.0, 0.1)
    right = 25.0 * during**2 + 5.0 * np.maximum(late - 0.1, 0.0)
    assert np.abs(rows.angle[:, 0] - right).max() < 1e-11
    assert rows.velocity[-1, 0] == pytest.approx(5.0, abs=1e-11)


def test_prescribed_motion_repeats_what_torques_did(bench_rig):
    # drive by torques, then prescribe the motor motion that came out: everything else must follow
    rig = replace(
        bench_rig.five_pulleys(friction=0.05, wall='hunt_crossley', continuous=True),
        control_period=2e-4,
    )
    t = 2e-4 * np.arange(1501)
    wished = np.stack([0.06 * np.sin(9.0 * t) ** 2, -0.03 * np.sin(7.0 * t) ** 2], axis=1)
    driven = Simulation(rig, tolerance=1e-9).follow(wished)
    motion = Signals(
        driven.angle[:, :2].T.copy(), driven.velocity[:, :2].T.copy(), 0.0, rig.control_period
    )
    given = predict(rig, motion, ('M', 'L'), len(t) - 1, tolerance=1e-9)
    assert np.abs(given.angle - driven.angle).max() < 1e-6
    assert np.abs(given.contact_force - driven.contact_force).max() < 2e-2
    # the effort comes from the second derivative of the cubic: compare its size over time
    miss = np.sqrt(np.mean((given.effort - driven.effort)[50:] ** 2))
    assert miss < 0.02 * np.abs(driven.effort).max()


def test_divergence_names_the_time(body):
    one = body()
    one = replace(one, pulleys=(replace(one.pulleys[0], damping=-1.0),))
    push = EffectUse('disturbance', 'pulley_body', {'torque': 1.0, 'start': 0.0, 'duration': 1.0})
    simulation = Simulation(replace(one, effects=(push,)), engine='plain')
    with pytest.raises(SimulationError, match=r'body: .*diverged near 0\.\d+ s; '):
        simulation.run(np.zeros((1000, 1)))
