"""The fixed step: converges to the default, and refuses what could not."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import SimulationError
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.simulation import Simulation


def test_converges_to_the_default(FixedStep, bench_rig, press):
    rig = bench_rig.five_pulleys(wall='hunt_crossley')
    right = Simulation(rig, tolerance=1e-10).run(press[:170])
    assert right.contact_force.max() > 1.0
    wrong = [
        np.abs(FixedStep(rig, step).run(press[:170]).angle - right.angle).max()
        for step in (1e-4, 2.5e-5)
    ]
    assert wrong[1] < 0.5 * wrong[0]
    assert wrong[1] < 1e-5


def test_has_order_four_where_nothing_sticks_or_touches(FixedStep, bench_rig, linear):
    rig = linear(bench_rig.five_pulleys())
    effects = (EffectUse('gravity', 'pulley_3', {'torque': 0.5}),)
    rig = replace(rig, effects=effects)
    still = np.zeros((20, 2))
    right = Simulation(rig, tolerance=1e-12).run(still)
    wrong = [
        np.abs(FixedStep(rig, step).run(still).angle - right.angle).max()
        for step in (5e-4, 2.5e-4)
    ]
    assert wrong[0] / wrong[1] > 10.0


@pytest.mark.parametrize('step', [1e-3, 5e-4])
def test_refuses_a_step_that_is_too_large(FixedStep, bench_rig, step):
    with pytest.raises(SimulationError, match=r'too large .* the largest allowed is 0\.0001\d* s'):
        FixedStep(bench_rig.five_pulleys(), step)


def test_refuses_a_step_that_does_not_divide_the_period(FixedStep, bench_rig):
    with pytest.raises(SimulationError, match=r'does not divide the control period of 0\.001 s'):
        FixedStep(bench_rig.five_pulleys(), 3e-4)


def test_the_largest_step_is_that_of_the_oscillator(FixedStep, body):
    # a lone inertia of 0.01 on 100 N m/rad swings with 100 rad/s: half a radian is 5 ms
    spring = EffectUse('joint_spring', 'pulley_body', {'stiffness': 100.0})
    one = FixedStep(body(effects=(spring,), control_period=1e-3), 1e-3)
    assert one.largest_step() == pytest.approx(0.5 / 100.0, rel=1e-4)


def test_sticks_exactly(FixedStep, body):
    uses = (
        EffectUse('coulomb_friction', 'pulley_body', {'torque': 0.2}),
        EffectUse('disturbance', 'pulley_body', {'torque': 0.5, 'start': 0.0, 'duration': 0.1}),
    )
    rows = FixedStep(body(effects=uses), 1e-3).run(np.zeros((400, 1)))
    stopped = rows.time > 0.252
    assert np.all(rows.velocity[stopped, 0] == 0.0)
    assert rows.angle[-1, 0] == pytest.approx(0.375, abs=5e-3)
