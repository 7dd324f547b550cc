"""What a motor's controller does with its command, against the same motion in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument import Controller, Motor
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
