"""The kernel against an independent integration: dense matrices, DOP853, events by Brent."""

from dataclasses import replace

from hypothesis import given, settings, strategies
import numpy as np
import pytest
from scipy.linalg import expm

from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import Simulation


def compared(instrument, reference, setpoints, **how):
    """Return angles of kernel and reference, and how many events each found."""
    simulation = Simulation(instrument, **how)
    rows = simulation.run(setpoints)
    other = reference(instrument)
    right = other.run(setpoints)
    n = len(instrument.pulleys)
    return rows, right[:, :n], right[:, n : 2 * n], right[:, 2 * n :], simulation, other


@pytest.mark.parametrize('wall', ['spring_damper', 'hunt_crossley'])
def test_sampled_control_with_friction_slack_and_wall(bench_rig, reference, press, wall):
    rig = bench_rig.five_pulleys(wall=wall)
    rows, angle, velocity, force, ours, other = compared(rig, reference, press)
    assert other.events >= 10, 'the motion is too tame to say anything'
    assert force.max() > 3.0
    assert np.abs(rows.angle - angle).max() < 1e-6
    assert np.abs(rows.velocity - velocity).max() < 2e-3
    assert np.abs(rows.contact_force - force).max() < 1e-2
    assert abs(ours.counts['events'] - other.events) <= 2


def test_error_falls_with_the_tolerance(bench_rig, reference, press):
    rig = bench_rig.five_pulleys()
    angle = reference(rig).run(press[:200])[:, :5]
    wrong = [
        np.abs(Simulation(rig, tolerance=tolerance).run(press[:200]).angle - angle).max()
        for tolerance in (1e-7, 1e-9, 1e-11)
    ]
    assert wrong[0] > 5.0 * wrong[1] > 25.0 * wrong[2]
    assert wrong[2] < 1e-9


def test_continuous_control(bench_rig, reference):
    rig = bench_rig.five_pulleys(continuous=True)
    held = np.array([0.06, -0.02])
    signals = Signals.held(held)
    rows = Simulation(rig).follow(np.tile(held, (151, 1)))
    right = reference(rig).run(np.zeros((151, 2)), signals=lambda t: (held, np.zeros(2)))
    assert signals.value.shape == (2, 1)
    assert np.abs(rows.angle - right[: len(rows), :5]).max() < 1e-6


def test_stribeck_and_coulomb_together(bench_rig, reference, press):
    effects = (
        EffectUse('stribeck_friction', 'pulley_3',
                  {'static': 0.03, 'sliding': 0.01, 'speed': 0.5}),
        EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.01}),
        EffectUse('coulomb_friction', 'pulley_2', {'torque': 0.005}),
    )  # fmt: skip
    rig = bench_rig.five_pulleys(effects=effects)
    rows, angle, *_, other = compared(rig, reference, press[:250], tolerance=1e-9)
    assert other.events > 0
    assert np.abs(rows.angle - angle).max() < 2e-8


@pytest.mark.parametrize('name', ['single_body', 'wrist_two_jaws'])
def test_other_instruments(reference, name):
    # noise is off unless asked for, but a counting encoder counts always
    instrument = load_instrument(name)
    instrument = replace(
        instrument, sensors=tuple(replace(s, resolution=0.0) for s in instrument.sensors)
    )
    motors = len(instrument.motors)
    setpoints = 0.05 * np.ones((60, motors)) * np.arange(1, motors + 1)
    rows, angle, _, force, *_ = compared(instrument, reference, setpoints, engine='plain')
    assert np.ptp(angle, axis=0).max() > 1e-3
    assert np.abs(rows.angle - angle).max() < 1e-6
    if force.size:
        assert np.abs(rows.contact_force - force).max() < 1e-2


@settings(max_examples=8)
@given(
    parents=strategies.lists(strategies.integers(0, 4), min_size=1, max_size=6),
    seed=strategies.integers(0, 100),
    friction=strategies.sampled_from([0.0, 0.05]),
)
def test_any_network(chained, reference, parents, seed, friction):
    instrument = chained(parents, seed=seed)
    if friction:
        rubbed = (EffectUse('tension_friction', 'pulley_p1', {'coefficient': friction}),)
        instrument = replace(instrument, effects=rubbed)
    rows, angle, *_ = compared(
        instrument, reference, np.full((40, 1), 0.1), engine='plain', tolerance=1e-9
    )
    assert np.abs(rows.angle - angle).max() < 1e-7


def test_linear_network_against_the_matrix_exponential(bench_rig, linear):
    rig = linear(bench_rig.five_pulleys())
    n = len(rig.pulleys)
    inertia = np.array([p.inertia for p in rig.pulleys])
    damping = np.array([p.damping for p in rig.pulleys])
    # a preloaded pair of equal straight cables is twice as stiff as one
    stiffness = rig.routing().T @ (2.0 * 0.5 * 17.5e3 * np.eye(3)) @ rig.routing()
    system = np.block(
        [[np.zeros((n, n)), np.eye(n)],
         [-stiffness / inertia[:, None], -np.diag(damping / inertia)]]
    )  # fmt: skip
    pose = {'M': 0.004, 'L': -0.006, '1': -0.003, '2': 0.005, '3': 0.002}
    start = np.concatenate([list(pose.values()), np.zeros(n)])
    rows = Simulation(rig, tolerance=1e-11, pose=pose).run(np.zeros((301, 2)))
    right = np.array([expm(system * t) @ start for t in rows.time[::50]])
    assert np.abs(rows.angle[::50] - right[:, :n]).max() < 1e-8
    assert np.abs(rows.velocity[::50] - right[:, n:]).max() < 1e-6
