"""Ripples are looked for where a motor passed enough of their waves to tell them."""

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.starting import Starting
from tendon_ros.identify.waves import shows, travel
from tendon_ros.model.instrument_file import load_instrument

RIPPLE = Candidate('torque_ripple', 'motor_body')


@pytest.fixture(scope='module')
def problem(measured_on):
    """Return the problem of a body that turns by some 20 degrees, on which a weight hangs."""
    body = load_instrument('single_body')
    weight = ('gravity', 'pulley_body', {'torque': 0.5, 'phase': 0.3})
    return prepared([measured_on(body, weight)], body).problem


def test_half_a_wave_shows_and_slow_ones_take_two(problem):
    turns = travel(problem, 'body') / (2.0 * np.pi)
    half = max(6.0, 0.5 / turns)
    assert shows(problem, 'motor_body', 1.01 * half)
    assert not shows(problem, 'motor_body', 0.99 * half)
    assert not shows(problem, 'motor_body', 2.0)


def test_fits_of_a_ripple_begin_where_it_can_be_told(problem):
    """The weight bends like a wave a turn, which would stand before any ripple that is one."""
    starts = Starting(problem, problem.fitted(problem.empty, rounds=0)).of(RIPPLE)
    assert starts
    assert all(shows(problem, RIPPLE.place, values['cycles']) for _, values in starts)
