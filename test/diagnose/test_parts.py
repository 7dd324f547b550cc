"""What acts like a simpler effect goes by its name; two of which one holds the other are one."""

import pytest

from tendon_ros.diagnose.bent import degenerate
from tendon_ros.diagnose.parts import as_one, plain, simpler
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


@pytest.mark.parametrize(
    ('static', 'speed', 'named'),
    [
        (0.02, 2e-3, True),
        # it holds with far more than it slides with, or its fall is seen in motion
        (0.1, 2e-3, False),
        (0.02, 0.2, False),
    ],
)
def test_what_falls_before_a_motor_is_seen_to_move_is_plain_if_it_is_little(
    measured_on, static, speed, named
):
    body = load_instrument('single_body')
    run = measured_on(body, trajectory='minimum_jerk', settings=(('amplitude', '40 deg'),))
    problem = prepared([run], body).problem
    values = {'static': static, 'sliding': 0.1, 'speed': speed}
    model = problem.empty.joined(Candidate('stribeck_friction', 'pulley_body'), values)
    found = plain(problem, model, 0)
    assert (found is not None) == named
    if found:
        assert found[1] == pytest.approx({'torque': 0.1}, rel=0.03)


def test_friction_of_the_file_stays_beside_another(sound_problem):
    known = Candidate('coulomb_friction', 'pulley_3', given=(('torque', 0.1),))
    model = sound_problem.empty.joined(known, {'torque': 0.2})
    shape = {'static': 0.1, 'sliding': 0.05, 'speed': 0.1}
    model = model.joined(Candidate('stribeck_friction', 'pulley_3'), shape)
    assert as_one(model) is model


def test_creep_that_is_over_at_once_is_a_softer_cable():
    fast = {'fraction': 0.2, 'time': 0.05, 'share': 0.5}
    other = simpler(Candidate('cable_creep', 'cable_12'), fast)
    assert other == (Candidate('cable_stiffness', 'cable_12'), {'scale': 0.8})
    slow = {**fast, 'time': 3.0}
    assert simpler(Candidate('cable_creep', 'cable_12'), slow) is None
