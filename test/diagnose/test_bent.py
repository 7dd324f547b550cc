"""What a fit has bent an effect into goes by its own name; what is one event is one."""

import pytest

from tendon_ros.diagnose.bent import (
    as_one,
    at_once,
    degenerate,
    excuses,
    least_late,
    plain,
    simpler,
)
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

BENT = [
    ('asymmetric_friction', {'forward': 0.2, 'backward': 0.21}, {'torque': 0.205}),
    ('stribeck_friction', {'static': 0.02, 'sliding': 0.19, 'speed': 0.1}, {'torque': 0.2}),
    ('presliding_friction', {'torque': 0.3, 'angle': 1e-4}, {'torque': 0.3}),
]
OWN = [
    ('asymmetric_friction', {'forward': 0.2, 'backward': 0.4}),
    # what holding adds is a fifth of all
    ('stribeck_friction', {'static': 0.05, 'sliding': 0.2, 'speed': 0.1}),
    ('presliding_friction', {'torque': 0.3, 'angle': 0.01}),
    ('coulomb_friction', {'torque': 0.3}),
]


@pytest.mark.parametrize(('effect', 'values', 'plain'), BENT, ids=[b[0] for b in BENT])
def test_friction_that_is_plain_is_called_so(effect, values, plain):
    cause, parameters = simpler(Candidate(effect, 'pulley_3'), values)
    assert (cause.effect, cause.place) == ('coulomb_friction', 'pulley_3')
    assert parameters == pytest.approx(plain)


@pytest.mark.parametrize(('effect', 'values'), OWN, ids=[o[0] for o in OWN])
def test_friction_with_a_shape_of_its_own_keeps_its_name(sound_problem, effect, values):
    candidate = Candidate(effect, 'pulley_3')
    assert simpler(candidate, values) is None
    assert not degenerate(sound_problem, candidate, values)


@pytest.fixture(scope='module')
def sound_problem(bench, sound):
    return prepared(sound, bench).problem


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
    ],
)
def test_what_is_no_cause(sound_problem, effect, place, values, bent):
    assert degenerate(sound_problem, Candidate(effect, place), values) is bent


@pytest.mark.parametrize(('limit', 'excused'), [(3.0, False), (0.02, True)])
def test_a_limit_that_most_torques_pass_is_none(sound_problem, limit, excused):
    model = sound_problem.empty
    model = model.joined(Candidate('torque_gain', 'motor_M'), {'gain': 0.9})
    model = model.joined(Candidate('torque_saturation', 'motor_M'), {'limit': limit})
    assert excuses(sound_problem, model, 1) is excused
    assert not excuses(sound_problem, model, 0)


@pytest.mark.parametrize(
    ('effect', 'values', 'joined'),
    [
        (
            'stribeck_friction',
            {'static': 0.1, 'sliding': 0.05, 'speed': 0.1},
            {'static': 0.1, 'sliding': 0.25, 'speed': 0.1},
        ),
        (
            'asymmetric_friction',
            {'forward': 0.2, 'backward': 0.1},
            {'forward': 0.4, 'backward': 0.3},
        ),
    ],
)
def test_plain_friction_beside_friction_that_holds_it_is_one(
    sound_problem, effect, values, joined
):
    plain = Candidate('coulomb_friction', 'pulley_3')
    model = sound_problem.empty.joined(plain, {'torque': 0.2})
    model = model.joined(Candidate(effect, 'pulley_3'), values)
    elsewhere = model.joined(Candidate('coulomb_friction', 'pulley_2'), {'torque': 0.3})
    one = as_one(elsewhere)
    assert {(c.effect, c.place) for c in one.causes} == {
        (effect, 'pulley_3'),
        ('coulomb_friction', 'pulley_2'),
    }
    [k] = [k for k, c in enumerate(one.causes) if c.place == 'pulley_3']
    assert one.values(k) == pytest.approx(joined)


@pytest.mark.parametrize(
    ('effect', 'values', 'torque'),
    [
        # the pulleys of the bench turn by some tenths of a radian a second
        ('stribeck_friction', {'static': 0.1, 'sliding': 0.1, 'speed': 20.0}, 0.2),
        ('stribeck_friction', {'static': 0.1, 'sliding': 0.1, 'speed': 0.01}, None),
        ('asymmetric_friction', {'forward': 0.2, 'backward': 0.1}, None),
        ('asymmetric_friction', {'forward': 0.2, 'backward': 0.19}, 0.195),
        ('coulomb_friction', {'torque': 0.2}, None),
        ('viscous_friction', {'damping': 0.1}, None),
    ],
)
def test_a_law_of_which_nothing_was_seen_is_the_simple_one(sound_problem, effect, values, torque):
    model = sound_problem.empty.joined(Candidate(effect, 'pulley_3'), values)
    found = plain(sound_problem, model, 0)
    if torque is None:
        assert found is None
    else:
        cause, parameters = found
        assert (cause.effect, cause.place) == ('coulomb_friction', 'pulley_3')
        assert parameters == pytest.approx({'torque': torque}, rel=0.02)


def test_friction_of_the_file_stays_beside_another(sound_problem):
    known = Candidate('coulomb_friction', 'pulley_3', given=(('torque', 0.1),))
    model = sound_problem.empty.joined(known, {'torque': 0.2})
    shape = {'static': 0.1, 'sliding': 0.05, 'speed': 0.1}
    model = model.joined(Candidate('stribeck_friction', 'pulley_3'), shape)
    assert as_one(model) is model


def test_creep_that_is_over_at_once_is_a_softer_cable():
    other = simpler(Candidate('cable_creep', 'cable_12'), {'fraction': 0.2, 'time': 0.05})
    assert other == (Candidate('cable_stiffness', 'cable_12'), {'scale': 0.8})
    slow = {'fraction': 0.2, 'time': 3.0}
    assert simpler(Candidate('cable_creep', 'cable_12'), slow) is None


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


def test_what_all_sensors_are_late_by_is_the_clock(measured_on):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '4 s'), ('amplitude', '30 deg')))
    problem = prepared([run], body).problem
    one = problem.empty.joined(Candidate('sensor_delay', 'encoder_body'), {'time': 0.012})
    assert least_late(problem, one) is None
    both = one.joined(Candidate('sensor_delay', 'torque_body'), {'time': 0.011})
    assert least_late(problem, both) == 1
