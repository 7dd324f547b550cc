"""What a fit has bent an effect into is none; what is one event is one."""

import math

import numpy as np
import pytest

from tendon_ros.diagnose.bent import (
    at_bound,
    at_once,
    biased,
    degenerate,
    is_constant,
    is_counted,
    overweight,
    spent,
    vanishes,
)
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

LOAD = (Candidate('tension_friction', 'pulley_3'), {'coefficient': 0.1})


@pytest.mark.parametrize(
    ('effect', 'place', 'values', 'bent'),
    [
        ('pretension', 'cable_12', {'scale': 0.97}, True),
        ('pretension', 'cable_12', {'scale': 0.8}, False),
        ('cable_slip', 'cable_12', {'jump': 1e-4, 'time': 0.1}, True),
        ('cable_slip', 'cable_12', {'jump': 1e-4, 'time': 6.0}, False),
        ('disturbance', 'pulley_3', {'torque': 0.1, 'start': 3.0, 'duration': 100.0}, True),
        ('disturbance', 'pulley_3', {'torque': 0.1, 'start': 3.0, 'duration': 0.4}, False),
        # the motor turns by some 13 degrees: of five waves a turn it never sees half a one
        ('torque_ripple', 'motor_M', {'amplitude': 0.1, 'cycles': 5.0, 'phase': 0.0}, True),
        ('torque_ripple', 'motor_M', {'amplitude': 0.1, 'cycles': 30.0, 'phase': 0.0}, False),
        # and friction that yields over 17 degrees of them is a spring
        ('presliding_friction', 'pulley_M', {'torque': 0.1, 'angle': 0.3}, True),
        ('presliding_friction', 'pulley_M', {'torque': 0.1, 'angle': 0.03}, False),
        # as is a loop that builds up over more than a cable is ever stretched
        ('cable_hysteresis', 'cable_12', {'force': 200.0, 'elongation': 0.01}, True),
        ('cable_hysteresis', 'cable_12', {'force': 2.0, 'elongation': 1e-4}, False),
        # a spring that is relaxed turns away is a bias of the motor, where there is one
        ('joint_spring', 'pulley_M', {'stiffness': 0.01, 'rest': 20.0}, True),
        ('joint_spring', 'pulley_M', {'stiffness': 0.01, 'rest': 2.0}, False),
        ('joint_spring', 'pulley_3', {'stiffness': 0.01, 'rest': 20.0}, False),
    ],
)
def test_what_is_no_cause(sound_problem, effect, place, values, bent):
    assert degenerate(sound_problem, Candidate(effect, place), values) is bent


@pytest.mark.parametrize(
    ('sliding', 'beside', 'gone'), [(0.001, (), True), (0.06, (), False), (0.001, (LOAD,), False)]
)
def test_friction_that_only_holds_is_none_where_nothing_else_rubs(
    sound_problem, sliding, beside, gone
):
    model = sound_problem.empty
    for candidate, values in beside:
        model = model.joined(candidate, values)
    holds = {'static': 0.2, 'sliding': sliding, 'speed': 0.001}
    model = model.joined(Candidate('stribeck_friction', 'pulley_3'), holds)
    assert vanishes(sound_problem, model, len(beside)) is gone


def test_a_motor_of_unknown_torque_may_give_way_all_along(measured_on):
    axis = load_instrument('driven_axis')
    problem = prepared([measured_on(axis, settings=(('duration', '6 s'),))], axis).problem
    limit = Candidate('torque_saturation', 'motor_axis')
    values = {'limit': 1.0, 'knee': 0.6}
    assert not degenerate(problem, limit, values)
    # but that is no limit
    assert spent(limit, values)
    assert not spent(limit, {'limit': 1.0, 'knee': 0.4})


@pytest.mark.parametrize(
    ('effect', 'place', 'values', 'bound'),
    [
        # a pulley that runs out by a fifth of its radius is another fault
        ('eccentricity', 'pulley_2', {'amplitude': 0.2, 'phase': 0.1}, True),
        ('eccentricity', 'pulley_2', {'amplitude': -0.2, 'phase': 0.1}, True),
        ('eccentricity', 'pulley_2', {'amplitude': 0.15, 'phase': 0.1}, False),
        ('tension_friction', 'pulley_2', {'coefficient': 1.0}, True),
        ('sensor_rectified', 'load_cell', {'rectified': 1.0}, False),
        ('coulomb_friction', 'pulley_2', {'torque': 1e5}, False),
        # half a radian of play, an encoder half a turn off, a wall a radian away are others, too
        ('backlash', 'motor_M', {'angle': 0.5, 'held': 0.5}, True),
        ('backlash', 'motor_M', {'angle': 0.4, 'held': 0.5}, False),
        ('encoder_offset', 'encoder_M', {'angle': -3.14}, True),
        ('contact_position', 'grasper', {'angle': 0.99}, True),
        # what is later than that is late
        ('sensor_delay', 'load_cell', {'time': 0.05}, False),
        ('torque_gain', 'motor_M', {'gain': 0.021}, True),
        ('torque_gain', 'motor_M', {'gain': 1.2}, False),
    ],
)
def test_no_size_at_its_bound_tells_what_is_there(effect, place, values, bound):
    candidate = Candidate(effect, place)
    assert at_bound(candidate, values) is bound
    assert spent(candidate, values) is bound


def test_a_constant_torque_is_a_bias_of_the_motor_and_elsewhere_nothing_that_has_a_name(
    sound_problem,
):
    far = {'stiffness': 0.01, 'rest': 20.0}
    driven, inner = (Candidate('joint_spring', place) for place in ('pulley_M', 'pulley_3'))
    assert biased(sound_problem, driven, far) == (
        Candidate('torque_bias', 'motor_M'),
        {'torque': pytest.approx(0.2)},
    )
    assert biased(sound_problem, inner, far) is None
    assert is_constant(sound_problem, inner, far)
    assert not is_constant(sound_problem, inner, {**far, 'rest': 2.0})


def test_a_play_within_a_count_is_what_counts_make(sound_problem):
    play = Candidate('backlash', 'motor_M')
    count = math.tau / 28000
    assert is_counted(sound_problem, play, {'angle': 1.2 * count, 'held': 1.0})
    assert not is_counted(sound_problem, play, {'angle': 3.0 * count, 'held': 1.0})
    assert not is_counted(sound_problem, *LOAD)


@pytest.mark.parametrize(('cycles', 'bent'), [(2.5, True), (5.0, False)])
def test_a_wave_that_comes_once_is_no_ripple_of_a_motor(measured_on, cycles, bent):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '6 s'), ('amplitude', '80 deg')))
    problem = prepared([run], body).problem
    assert np.ptp(run['actuator/pulley_body/position'].value) > 0.4 * math.tau
    ripple = Candidate('torque_ripple', 'motor_body')
    values = {'amplitude': 0.1, 'cycles': cycles, 'phase': 0.0}
    assert degenerate(problem, ripple, values) is bent


PUSH = {'torque': 0.1, 'start': 3.0, 'duration': 0.5}


@pytest.mark.parametrize(
    ('effect', 'place', 'only', 'values', 'same'),
    [
        ('disturbance', 'pulley_2', '', {'torque': 0.2, 'start': 3.6, 'duration': 0.3}, True),
        ('cable_slip', 'cable_12', 'free', {'jump': 1e-4, 'time': 2.8}, True),
        ('cable_slip', 'cable_12', 'mixed', {'jump': 1e-4, 'time': 2.8}, False),
        ('disturbance', 'pulley_3', 'free', {'torque': 0.2, 'start': 6.0, 'duration': 0.3}, False),
        ('coulomb_friction', 'pulley_3', '', {'torque': 0.2}, False),
    ],
)
def test_events_at_once_are_one(effect, place, only, values, same):
    push = Candidate('disturbance', 'pulley_3', 'free'), PUSH
    other = Candidate(effect, place, only), values
    assert at_once(push, other) is same
    assert at_once(other, push) is same


@pytest.mark.parametrize(('scale', 'over'), [(17.0, True), (0.09, True), (9.0, False)])
def test_nobody_takes_a_body_for_another_of_ten_times_its_inertia(scale, over):
    body = Candidate('inertia', 'pulley_2')
    assert overweight(body, {'scale': scale}) is over
    assert spent(body, {'scale': scale}) is over
