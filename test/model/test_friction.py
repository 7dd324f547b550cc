"""Dry friction: it sticks exactly, breaks away where it should, and never gives power."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict, Simulation


def coulomb(torque):
    return EffectUse('coulomb_friction', 'pulley_body', {'torque': torque})


def push(torque, start, duration):
    values = {'torque': torque, 'start': start, 'duration': duration}
    return EffectUse('disturbance', 'pulley_body', values)


def pushed(one, torques, every=1):
    """Return rows of a body that a torque over time pushes."""
    return predict(
        one, Signals.through(0.0, 1e-3, np.atleast_2d(torques)), (), len(torques) - 1,
        pushed=('body',), every=every, engine='plain',
    )  # fmt: skip


def test_slides_and_stops_in_closed_form(body):
    # 0.5 N m against 0.2 for 0.1 s: 3 rad/s, then 20 rad/s^2 to a stop at 0.25 s, and 0.375 rad
    one = body(effects=(coulomb(0.2), push(0.5, 0.0, 0.1)))
    rows = Simulation(one, engine='plain').run(np.zeros((400, 1)))
    t = rows.time
    fast = np.where(t < 0.1, 15.0 * t**2, 0.15 + 3.0 * (t - 0.1) - 10.0 * (t - 0.1) ** 2)
    right = np.where(t < 0.25, fast, 0.375)
    assert np.abs(rows.angle[:, 0] - right).max() < 1e-9
    assert np.all(rows.velocity[t > 0.2501, 0] == 0.0)


def test_a_pulley_really_sticks(bench_rig):
    # for two seconds the loops pull at pulley 3 with less than it holds: it does not move at all
    rig = bench_rig.five_pulleys(friction=0.4)
    t = 1e-3 * np.arange(3000)
    wished = np.stack([0.02 * np.minimum(t, 1.0), np.zeros_like(t)], axis=1)
    wished[1000:, 0] += 1e-3 * np.sin(40.0 * t[1000:])
    rows = Simulation(rig).run(wished)
    still = rows.angle[1200:, 4]
    assert np.ptp(rows.loop_force[1200:, 0]) > 0.1
    assert np.all(rows.velocity[1200:, 4] == 0.0)
    assert np.all(still == still[0])


def test_budget_is_held_to_its_last_part(body):
    torques = np.concatenate([np.full(200, 0.1999999), np.full(200, -0.1999999)])
    rows = pushed(body(effects=(coulomb(0.2),)), torques)
    assert np.all(rows.angle == 0.0)
    rows = pushed(body(effects=(coulomb(0.2),)), np.full(200, 0.2000001))
    assert rows.angle[-1, 0] > 0.0


def test_stribeck_breaks_away_at_the_static_level(body):
    shape = {'static': 0.1, 'sliding': 0.04, 'speed': 0.1}
    one = body(effects=(EffectUse('stribeck_friction', 'pulley_body', shape),))
    ramp = 0.2 * np.arange(1001) * 1e-3
    rows = pushed(one, ramp)
    away = rows.time[np.argmax(rows.velocity[:, 0] > 0.0)]
    assert away == pytest.approx(0.14 / 0.2, abs=1.5e-3)
    # once it moves it falls to the sliding level: acceleration is that of torque less 0.04
    last = np.diff(rows.velocity[-3:-1, 0]) / 1e-3
    assert last[0] == pytest.approx((0.2 - 0.04) / 0.01, rel=0.01)


@pytest.mark.parametrize('pretension', [3.0, 6.0])
def test_tension_friction_holds_by_the_tension(bench_rig, linear, pretension):
    # pulley 3 alone is pushed while all others are held: its breakaway is mu * R * 4 pretensions
    rig = linear(bench_rig.five_pulleys())
    use = EffectUse('tension_friction', 'pulley_3', {'coefficient': 0.1})
    loops = tuple(replace(loop, pretension=pretension) for loop in rig.loops)
    rig = replace(rig, effects=(use,), loops=loops)
    ramp = np.vstack([np.zeros((4, 1001)), 0.1 * np.linspace(0.0, 1.0, 1001)])
    rows = predict(
        rig, Signals.through(0.0, 1e-3, ramp), ('M', 'L', '1', '2'), 1000, pushed=('3',),
        engine='plain',
    )  # fmt: skip
    away = rows.time[np.argmax(rows.velocity[:, 4] != 0.0)]
    assert 0.1 * away == pytest.approx(0.1 * 0.03 * 4.0 * pretension, rel=0.03)


def test_without_cables_the_load_is_what_passes_through(body):
    # an arm swung slowly by its motor: a fifth of what its weight asks for is lost on the way
    arm = body(
        effects=(
            EffectUse('gravity', 'pulley_body', {'torque': 0.4, 'phase': 0.0}),
            EffectUse('tension_friction', 'pulley_body', {'coefficient': 0.2}),
        )
    )
    time = 1e-3 * np.arange(4001)
    swing, speed = 0.8 * np.sin(0.5 * np.pi * time), 0.4 * np.pi * np.cos(0.5 * np.pi * time)
    rows = predict(arm, Signals(swing[None, :], speed[None, :], 0.0, 1e-3), ('body',), 4000)
    angle, speed = rows.angle[:, 0], rows.velocity[:, 0]
    inertial = -0.01 * (0.5 * np.pi) ** 2 * angle
    held = rows.effort[:, 0] - inertial - 0.4 * np.sin(angle)
    moving = np.abs(speed) > 0.01
    expected = 0.2 * 0.4 * np.abs(np.sin(angle)) * np.sign(speed)
    assert held[moving] == pytest.approx(expected[moving], abs=1e-4)


def test_a_gear_rubs_with_what_it_transmits():
    # a motor winds up a spring through a shaft; its gear loses a part of what the shaft carries
    tool = load_instrument('davinci_grasper')
    rig = replace(
        tool,
        effects=(
            EffectUse('joint_spring', 'pulley_spindle', {'stiffness': 3.0}),
            EffectUse('tension_friction', 'pulley_motor', {'coefficient': 0.1}),
        ),
    )
    ramp = np.interp(1e-3 * np.arange(4001), [0.0, 2.0, 4.0], [0.0, 0.4, 0.1])
    rows = predict(rig, Signals.through(0.0, 1e-3, ramp[None, :]), ('motor',), 4000)
    carried = rows.loop_force[:, len(rig.loops)]
    assert carried.max() > 0.5
    for at, way in ((1500, 1.0), (3500, -1.0)):
        assert rows.effort[at, 0] == pytest.approx((1.0 + 0.1 * way) * carried[at], rel=1e-3)


def test_friction_never_gives_power(bench_rig, linear):
    # nothing drives and nothing damps but friction: the energy only falls
    rig = linear(bench_rig.five_pulleys(), damping=0.0)
    uses = (
        EffectUse('tension_friction', 'pulley_1', {'coefficient': 0.05}),
        EffectUse(
            'stribeck_friction', 'pulley_2', {'static': 0.05, 'sliding': 0.02, 'speed': 1.0}
        ),
        EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.05}),
        EffectUse('asymmetric_friction', 'pulley_M', {'forward': 0.02, 'backward': 0.05}),
    )
    rig = replace(rig, effects=uses)
    pose = {'M': 0.02, 'L': -0.006, '1': -0.01, '2': 0.02}
    rows = Simulation(rig, tolerance=1e-10, pose=pose).run(np.zeros((500, 2)))
    delta = rows.angle @ rig.routing().T
    kinetic = 0.5 * rows.velocity**2 @ [p.inertia for p in rig.pulleys]
    energy = kinetic + 0.5 * 17.5e3 * (delta**2).sum(axis=1)
    assert energy[-1] < 0.5 * energy[0]
    assert np.diff(energy).max() < 1e-9 * energy[0]


def test_presliding_tends_to_sticking(bench_rig, press):
    wrong = []
    rub = [EffectUse('tension_friction', f'pulley_{n}', {'coefficient': 0.1}) for n in '123']
    rigid = Simulation(bench_rig.five_pulleys()).run(press[:300])
    for angle in (1e-2, 1e-3, 1e-4, 1e-5):
        soft = [
            EffectUse('presliding_friction', f'pulley_{n}', {'torque': 0.0, 'angle': angle})
            for n in '123'
        ]
        rig = bench_rig.five_pulleys(effects=(*rub, *soft))
        rows = Simulation(rig).run(press[:300])
        wrong.append(np.abs(rows.angle - rigid.angle).max())
    assert all(b < a for a, b in pairwise(wrong))
    assert wrong[-1] < 5e-4 < wrong[0]


def test_presliding_is_a_spring_at_first(body):
    shape = {'torque': 0.2, 'angle': 0.01}
    one = body(effects=(EffectUse('presliding_friction', 'pulley_body', shape),))
    one = replace(one, pulleys=(replace(one.pulleys[0], damping=1.0),))
    rows = pushed(one, np.full(1000, 0.002))
    # far below the budget it settles where the spring torque / angle balances
    assert rows.angle[-1, 0] == pytest.approx(0.002 / (0.2 / 0.01), rel=0.01)


def test_a_trembling_takes_friction_away_from_holds_and_slow_motions(body):
    dither, angle = 1e-3, 5e-4
    shape = {'torque': 0.2, 'angle': angle, 'dither': dither}
    one = body(effects=(EffectUse('presliding_friction', 'pulley_body', shape),))
    one = replace(one, pulleys=(replace(one.pulleys[0], damping=0.0),))
    # at 3 mrad/s for two seconds, then held for one
    time = 1e-3 * np.arange(3001)
    rows = predict(
        one, Signals.through(0.0, 1e-3, 3e-3 * np.minimum(time, 2.0)[None, :]), ('body',), 3000
    )
    slow = 0.2 * 3e-3 / (3e-3 + dither)
    assert rows.effort[1900, 0] == pytest.approx(slow, rel=1e-3)
    held = slow * np.exp(-(time[2100:] - 2.0) * dither / angle)
    assert rows.effort[2100:, 0] == pytest.approx(held, rel=5e-3)


def motor_that_turns_back(step, speed, every, until):
    """Return a motion that stops within two samples, overshoots, stands and goes back."""
    time = step * np.arange(round(until / step))
    turns = np.arange(0.0, until + every, every)
    speeds = speed * np.resize([0.0, 1.0, 1.0, -0.025, 0.0, -1.0], len(turns))
    speeds = np.interp(time, turns, speeds)
    speeds[np.diff(np.floor(time / every), append=0.0) > 0.0] *= -0.02
    return Signals.smooth(0.0, step, (step * np.cumsum(speeds))[None, :])


def bent_along(motion, angle, parts=400):
    """Return how far bristles are bent at the samples of a motion: Dahl's law, bit by bit."""
    samples = motion.value.shape[1]
    time = motion.start + motion.step * np.arange(samples)
    fine = np.linspace(time[0], time[-1], parts * (samples - 1) + 1)
    path = CubicHermiteSpline(time, motion.value[0], motion.slope[0])(fine)
    bent = [0.0]
    for way in np.diff(path):
        bent.append(np.sign(way) + (bent[-1] - np.sign(way)) * np.exp(-abs(way) / angle))
    return np.array(bent[::parts])


@pytest.mark.parametrize('tolerance', [1e-4, 1e-6])
@pytest.mark.parametrize('sticking', [False, True])
@pytest.mark.parametrize('step', [1e-3, 4e-3])
def test_bristles_follow_a_given_motion_that_turns_back_in_a_moment(
    bench_rig, step, sticking, tolerance
):
    # however long the steps are, and whatever sticks beside
    rubs = [EffectUse('presliding_friction', 'pulley_M', {'torque': 0.2, 'angle': 1e-3})]
    if sticking:
        rubs += [EffectUse('coulomb_friction', f'pulley_{n}', {'torque': 1e4}) for n in '123']
    rig = replace(bench_rig.five_pulleys(), control_period=step)
    motion = motor_that_turns_back(step, 1.6, 0.12, 2.0)
    rows = predict(
        rig, motion, ['M'], motion.value.shape[1] - 1, effects=rubs, tolerance=tolerance
    )
    bent = bent_along(motion, 1e-3)
    assert np.count_nonzero(np.diff(np.sign(bent))) >= 6
    motor = rig.motor_names.index('M')
    assert -rows.dry_friction[:, motor] == pytest.approx(0.2 * bent, abs=1e-5)


def test_bristles_of_a_given_motion_are_carried_from_call_to_call(body):
    shape = {'torque': 0.2, 'angle': 1e-3}
    one = body(effects=(EffectUse('presliding_friction', 'pulley_body', shape),))
    motion = motor_that_turns_back(1e-3, 1.6, 0.12, 0.6)
    bent = bent_along(motion, 1e-3)
    runner = Runner(one, arrays_of(one, prescribed={'body': 0}))
    runner.rest({})
    rows = [
        runner.advance(np.zeros(0), count, every=1, smoothly=smoothly, signals=motion)
        for count, smoothly in ((100, True), (130, False), (150, True))
    ]
    rubbed = np.concatenate([r.dry_friction[:, 0] for r in rows])
    time = np.concatenate([r.time for r in rows])
    assert -rubbed == pytest.approx(0.2 * bent[np.rint(1e3 * time).astype(int)], abs=1e-5)


@pytest.mark.parametrize('names', [('gear',), ('gear', 'spindle', 'drum', 'jaw')], ids='-'.join)
def test_behind_a_stiff_shaft_no_pulley_creeps_from_stop_to_stop(names):
    # the dense output of a step over a shaft of kHz bends the wrong way where a pulley lets go
    rig = replace(load_instrument('davinci_grasper'), control_period=5e-3)
    time = rig.control_period * np.arange(2001)
    rubs = tuple(EffectUse('coulomb_friction', f'pulley_{n}', {'torque': 0.01}) for n in names)
    for seed in range(6):
        phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, 4)
        motor = 0.5 * np.sin(1.3 * time + phase[0]) + 0.1 * np.sin(3.1 * time + phase[1])
        load = 0.05 * np.sin(0.7 * time + phase[2]) + 0.01 * np.sin(23.0 * time + phase[3])
        signals = Signals.smooth(0.0, rig.control_period, np.array([motor, load]))

        def steps(effects, signals=signals):
            return predict(
                rig, signals, ['motor'], 2000, effects=(*rig.effects, *effects),
                pushed=['jaw'], tolerance=4e-6,
            ).steps  # fmt: skip

        assert steps(rubs) < 2 * steps(())
