"""What of a cause may be no more than a friction whose law is wrong."""

import numpy as np
import pytest

from tendon_ros.diagnose.imitable import by_friction, imitable
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
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
    assert low <= by_friction(problem, does(angle, speed), 5.0 * np.sign(speed)) <= high


def test_where_friction_has_no_direction_one_stretch_goes_on(swung):
    problem, time = swung
    rests = np.abs(np.cos(3.0 * time)) < 0.2
    trembles = np.where(np.arange(len(time)) % 2 == 0, 0.1, -0.1)
    friction = np.where(rests, trembles, np.sign(np.cos(3.0 * time)))
    assert by_friction(problem, np.sin(3.0 * time), friction) < 0.2


@pytest.mark.parametrize(
    ('effect', 'values', 'low', 'high'),
    [
        ('gravity', {'torque': 0.1, 'phase': 0.0}, 0.0, 0.2),
        # the same ripple, and one with a wave that comes twice as often
        ('torque_ripple', {'amplitude': 0.1, 'cycles': 12.0, 'phase': 1.0}, 0.99, 1.0),
        ('torque_ripple', {'amplitude': 0.1, 'cycles': 24.0, 'phase': 0.0}, 0.99, 1.0),
    ],
)
def test_a_ripple_may_have_a_wave_of_another_shape_and_no_weight(swung, effect, values, low, high):
    problem, _ = swung
    ripple = Candidate('torque_ripple', 'motor_body')
    model = problem.empty.joined(ripple, {'amplitude': 0.3, 'cycles': 12.0, 'phase': 0.2})
    state = problem.fitted(model, rounds=0)
    place = 'motor_body' if effect == ripple.effect else 'pulley_body'
    also = problem.left(model.joined(Candidate(effect, place), values))
    assert low <= imitable(problem, state, 0, also - state.left) <= high
