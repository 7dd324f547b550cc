"""What a motor's controller does with its command, against the same motion in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument import Controller, EffectUse, Motor
from tendon_ros.model.limiting import limited
from tendon_ros.model.simulation import Simulation

INERTIA, KP, KD = 0.01, 2.0, 0.2
RATE = 0.5  # [rad/s] of the command


def lag(body, derivative, continuous):
    """Return by how much a body is behind a command that has long been running [rad]."""
    gains = Controller(kp=KP, ki=0.0, kd=KD, limit=100.0, derivative=derivative)
    rig = replace(body(motors=(Motor('body', 'body', gains),)), control_period=1e-3)
    if continuous:
        rig = replace(rig, continuous_control=True)
    time = 1e-3 * np.arange(2001)
    command = (RATE * time)[:, None]
    simulation = Simulation(rig)
    rows = simulation.follow(command) if continuous else simulation.run(command)
    return float(command[len(rows) - 1, 0] - rows.angle[-1, 0])


@pytest.mark.parametrize('continuous', [False, True])
@pytest.mark.parametrize(('derivative', 'behind'), [('error', 0.0), ('reading', KD / KP * RATE)])
def test_a_speed_loop_within_a_position_loop_lags(body, derivative, behind, continuous):
    assert lag(body, derivative, continuous) == pytest.approx(behind, abs=1e-3)


@pytest.mark.parametrize('continuous', [False, True])
@pytest.mark.parametrize('knee', [0.0, 0.3])
@pytest.mark.parametrize('bias', [0.0, 0.4])
def test_a_limit_sets_in_over_its_knee_and_a_bias_comes_on_top(body, bias, knee, continuous):
    weak = EffectUse('torque_saturation', 'motor_body', {'limit': 1.0, 'knee': knee})
    gains = Controller(kp=KP, ki=0.0, kd=0.0, limit=100.0, derivative='error')
    rig = replace(
        body(motors=(Motor('body', 'body', gains),)),
        control_period=1e-4,
        continuous_control=continuous,
        effects=(weak, EffectUse('torque_bias', 'motor_body', {'torque': bias})),
    )
    asked = np.array([-3.0, -1.1, -0.5, 0.6, 0.8, 0.95, 1.2, 1.4])
    given = []
    for torque in asked:
        command = np.full((3, 1), torque / KP)
        simulation = Simulation(rig)
        rows = simulation.follow(command) if continuous else simulation.run(command)
        given.append(INERTIA * (rows.velocity[2, 0] - rows.velocity[1, 0]) / rig.control_period)
    expected, slope = limited(asked, 1.0, knee)
    assert given == pytest.approx(expected + bias, rel=1e-3)
    assert np.all(np.abs(expected) <= np.minimum(np.abs(asked), 1.0))
    assert np.array_equal(slope == 1.0, np.abs(asked) <= 1.0 - knee)
