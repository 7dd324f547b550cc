"""Energy: nothing is made from nothing, whatever rubs, winds or touches."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.interpolate import PPoly

from tendon_ros.model.cable import elongation_at, uniform_cubic
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict, Simulation


class Books:
    """Keeps the books of an instrument's energy from recorded rows."""

    def __init__(self, instrument):
        self.one = instrument
        start, rate, cubic = uniform_cubic(instrument.curves[0])
        x = start + np.arange(len(cubic) + 1) / rate
        powers = rate ** np.arange(3, -1, -1)
        self.tension = PPoly(cubic[:, ::-1].T * powers[:, None], x)
        self.stored = self.tension.antiderivative()
        self.preload = np.array(
            [elongation_at(instrument.curves[0], loop.pretension) for loop in instrument.loops]
        )
        self.low, self.high = x[0], x[-1]

    def both(self, angle, of):
        """Return a function of elongation, of both cables of each loop: slack pulls nothing."""
        delta = angle @ self.one.routing().T
        ends = [np.clip(self.preload + way * delta, self.low, self.high) for way in (1, -1)]
        return of(ends[0]), of(ends[1])

    def energy(self, rows, wound=None):
        inertia = np.array([p.inertia for p in self.one.pulleys])
        a, b = self.both(rows.angle if wound is None else wound, self.stored)
        return 0.5 * rows.velocity**2 @ inertia + (a + b).sum(axis=1)

    def load(self, rows):
        a, b = self.both(rows.angle, self.tension)
        return (a + b) @ np.abs(self.one.routing())


def test_power_in_is_energy_and_what_is_rubbed_away(bench_rig):
    friction = 0.1
    rig: Instrument = replace(
        bench_rig.five_pulleys(friction=friction, wall='hunt_crossley'), control_period=1e-4
    )
    t = 1e-4 * np.arange(4001)
    wished = np.stack([0.09 * np.sin(8.0 * t), 0.03 * np.sin(11.0 * t)], axis=1)
    rows = Simulation(rig, tolerance=1e-9).run(wished)
    books = Books(rig)
    # a motor's torque is held from tick to tick, so its work is exact
    given = np.sum(rows.effort[:-1] * np.diff(rows.angle[:, :2], axis=0))
    energy = books.energy(rows)
    damping = np.array([p.damping for p in rig.pulleys])
    viscous = simpson(rows.velocity**2 @ damping, x=rows.time)
    rubbed = np.abs(rows.velocity[:, 2:]) * friction * books.load(rows)[:, 2:]
    dry = simpson(rubbed.sum(axis=1), x=rows.time)
    contact = rig.contacts[0]
    pushed = simpson(rows.contact_force[:, 0] * contact.arm * rows.velocity[:, 3], x=rows.time)
    assert min(dry, viscous, given) > 1e-3
    assert rows.contact_force.max() > 5.0
    assert given == pytest.approx(energy[-1] - energy[0] + viscous + dry + pushed, rel=2e-4)


def test_without_friction_the_network_keeps_its_energy(bench_rig, linear):
    rig = linear(bench_rig.five_pulleys(), damping=0.0)
    pose = {'M': 0.004, 'L': -0.006, '1': -0.003, '2': 0.005}
    rows = Simulation(rig, tolerance=1e-10, pose=pose).run(np.zeros((400, 2)))
    energy = Books(rig).energy(rows)
    swing = energy[0] - Books(rig).energy(Simulation(rig, engine='plain').run(np.zeros((1, 2))))[0]
    assert swing > 1e-3
    assert np.abs(energy - energy[0]).max() < 1e-5 * swing


def test_eccentric_winding_is_virtual_work(bench_rig, linear):
    # arc and lever of an eccentric pulley must belong together, or it would be a motor
    shape = {'1': (0.2, 0.7), '3': (0.15, -0.3)}
    effects = tuple(
        EffectUse('eccentricity', f'pulley_{name}', {'amplitude': a, 'phase': p})
        for name, (a, p) in shape.items()
    )
    rig = replace(linear(bench_rig.five_pulleys(), damping=0.0), effects=effects)
    pose = {'M': 0.03, 'L': -0.02, '1': -0.01, '2': 0.02}
    rows = Simulation(rig, tolerance=1e-10, pose=pose, engine='plain').run(np.zeros((100, 2)))
    wound = rows.angle.copy()
    for name, (a, p) in shape.items():
        i = rig.index(name)
        wound[:, i] += a * (np.sin(rows.angle[:, i] - p) + np.sin(p))
    energy = Books(rig).energy(rows, wound)
    kinetic = np.ptp(0.5 * rows.velocity**2 @ [p.inertia for p in rig.pulleys])
    assert kinetic > 1e-2
    assert np.abs(energy - energy[0]).max() < 1e-5 * kinetic


def test_the_printed_form_makes_energy(bench_rig, linear):
    # eq. (6) as printed feeds on itself with every B at 0.03, motors held: its 3 Hz mode grows by
    # 0.00584 a second (the eigenvalue), where the consistent form loses 0.754 a second
    rig = linear(bench_rig.five_pulleys(), damping=0.03)
    printed = replace(
        rig,
        loops=tuple(
            replace(loop, torque_sign={'3': -1.0}) if loop.name == '12' else loop
            for loop in rig.loops
        ),
    )
    pose = {'2': 3.57e-3, '3': -3.53e-3}
    rate = {}
    for name, one, seconds in (('consistent', rig, 4), ('printed', printed, 60)):
        rows = predict(
            one, Signals.held(np.zeros(2)), ('M', 'L'), 1000 * seconds, pose=pose, every=5,
            tolerance=1e-9,
        )  # fmt: skip
        size = np.abs(rows.angle[:, 4])
        late = size[-200:].max() / size[200:400].max()
        rate[name] = np.log(late) / (seconds - 2)
    assert rate['consistent'] == pytest.approx(-0.754, rel=0.05)
    assert rate['printed'] == pytest.approx(0.00584, rel=0.05)


@pytest.mark.parametrize(('sign', 'force', 'link'), [(1.0, 1.83, 1.0 / 3.0), (-1.0, 5.5, -1.0)])
def test_blocked_tip_in_series(bench_rig, linear, sign, force, link):
    # 1 degree at M, L held, tip blocked: three equal springs in series, delta = R theta / 3 each;
    # as printed, three times the force and the link the wrong way
    rig = linear(bench_rig.five_pulleys())
    loops = tuple(
        replace(loop, torque_sign={'3': sign}) if loop.name == '12' else loop for loop in rig.loops
    )
    held = Signals.held(np.deg2rad([1.0, 0.0, 0.0]))
    damped = tuple(replace(p, damping=p.damping + 0.9) for p in rig.pulleys)
    rows = predict(
        replace(rig, loops=loops, pulleys=damped), held, ('M', 'L', '2'), 4000, every=100,
        engine='auto',
    )  # fmt: skip
    torque = rows.loop_force[-1, 1] * 0.03
    assert np.rad2deg(rows.angle[-1, 4]) == pytest.approx(link, rel=1e-3)
    assert torque / 0.05 == pytest.approx(force, rel=5e-3)
    if sign > 0:
        exact = 17.5e3 * 0.03 * np.deg2rad(1.0) / 3.0
        assert rows.loop_force[-1, :2] == pytest.approx([exact, exact], rel=1e-6)


@pytest.mark.parametrize('share', [0.0, 0.7, 1.0])
def test_creep_in_situ_is_a_standard_linear_solid(bench_rig, linear, share):
    creep = EffectUse('cable_creep', 'cable_m1', {'fraction': 0.4, 'time': 0.05, 'share': share})
    rig = replace(linear(bench_rig.five_pulleys()), effects=(creep,))
    angles = np.zeros(5)
    angles[0] = 0.01
    rows = predict(
        rig, Signals.held(angles), rig.pulley_names, 200, engine='plain', tolerance=1e-9
    )
    delta = 0.03 * 0.01
    right = 17.5e3 * delta * (1.0 - 0.4 * (1.0 - np.exp(-rows.time / 0.05)))
    assert np.abs(rows.loop_force[:, 0] - right).max() < 1e-4 * right[0]


def test_creep_takes_tension_or_elongation(bench_rig):
    """A bent cable that is held keeps its part of the tension, or the tension of its part."""
    angles = np.zeros(5)
    angles[0] = 0.02
    held = {}
    for name, part, share in [('all', 0.0, 0.0), ('elongation', 0.4, 0.0), ('tension', 0.4, 1.0)]:
        creep = EffectUse(
            'cable_creep', 'cable_m1', {'fraction': part, 'time': 0.02, 'share': share}
        )
        rig = replace(bench_rig.five_pulleys(), effects=(creep,))
        rows = predict(rig, Signals.held(angles), rig.pulley_names, 300, engine='plain')
        held[name] = rows.loop_force[-1, 0]
    smaller = predict(
        bench_rig.five_pulleys(), Signals.held(0.6 * angles), rig.pulley_names, 10, engine='plain'
    ).loop_force[-1, 0]
    assert held['tension'] == pytest.approx(0.6 * held['all'], rel=1e-5)
    assert held['elongation'] == pytest.approx(smaller, rel=1e-5)
    assert held['elongation'] < 0.95 * held['tension']


def test_hysteresis_in_situ_takes_its_loop(bench_rig, linear):
    shape = {'force': 2.0, 'elongation': 2e-5}
    rig = replace(
        linear(bench_rig.five_pulleys()),
        effects=(EffectUse('cable_hysteresis', 'cable_m1', shape),),
    )
    t = 1e-3 * np.arange(1001)
    motion = np.zeros((5, len(t)))
    motion[0] = 0.02 * np.sin(4.0 * np.pi * t)
    signals = Signals.smooth(0.0, 1e-3, motion)
    rows = predict(rig, signals, rig.pulley_names, 1000, engine='plain')
    delta = 0.03 * rows.angle[:, 0]
    extra = rows.loop_force[:, 0] - 17.5e3 * delta
    second = slice(500, 1001)
    area = np.trapezoid(extra[second], delta[second])
    # a rectangle 4 F A, less its four rounded corners of about F e each
    assert area == pytest.approx(4.0 * 2.0 * (6e-4 - 2e-5 * np.log(2.0)), rel=0.02)
    assert np.abs(extra).max() == pytest.approx(2.0, rel=1e-3)
