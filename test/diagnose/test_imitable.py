"""What of a cause may be no more than a friction whose law is wrong."""

import numpy as np
import pytest

from tendon_ros.diagnose.imitable import imitable
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument


@pytest.fixture(scope='module')
def swung(measured_on):
    """Return the problem of a body that swings to and fro, and when its samples are [s]."""
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '8 s'), ('amplitude', '40 deg')))
    problem = prepared([run], body).problem
    [segment] = problem.rollouts.segments
    return problem, problem.sampled([segment.time])


@pytest.mark.parametrize(
    ('does', 'low', 'high'),
    [
        # a friction twice as large, and one that grows with speed
        (lambda _angle, speed: np.sign(speed), 0.99, 1.0),
        (lambda _angle, speed: speed, 0.97, 1.0),
        # one that differs from one way to the other
        (lambda _angle, speed: np.maximum(np.sign(speed), 0.0), 0.99, 1.0),
        # a spring, and a ripple of many waves
        (lambda angle, _speed: angle, 0.0, 0.15),
        (lambda angle, _speed: np.sin(12.0 * angle), 0.0, 0.2),
        (lambda angle, _speed: 0.0 * angle, 1.0, 1.0),
    ],
)
def test_a_spring_is_no_form_of_friction_and_a_damper_is(swung, does, low, high):
    problem, time = swung
    angle, speed = np.sin(3.0 * time), np.cos(3.0 * time)
    assert low <= imitable(problem, does(angle, speed), 5.0 * np.sign(speed)) <= high


def test_where_friction_has_no_direction_one_stretch_goes_on(swung):
    problem, time = swung
    rests = np.abs(np.cos(3.0 * time)) < 0.2
    trembles = np.where(np.arange(len(time)) % 2 == 0, 0.1, -0.1)
    friction = np.where(rests, trembles, np.sign(np.cos(3.0 * time)))
    assert imitable(problem, np.sin(3.0 * time), friction) < 0.2
