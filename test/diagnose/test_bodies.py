"""A motor, its pulley and who reads them are one body, on which two effects may be one."""

import pytest

from tendon_ros.diagnose.bodies import of_one_body
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.form import tie
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import equals
from tendon_ros.diagnose.one_body import instead
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

COUNTS = Candidate('encoder_gain', 'encoder_M')
WHEEL = Candidate('eccentricity', 'pulley_M')
STRONGER = Candidate('torque_gain', 'motor_M')
DAMPED = Candidate('viscous_friction', 'pulley_L')
OTHER = Candidate('viscous_friction', 'pulley_body')
RUBS = Candidate('coulomb_friction', 'pulley_body')
PULLED = Candidate('torque_bias', 'motor_body')
SIDED = Candidate('asymmetric_friction', 'pulley_body')


@pytest.mark.parametrize(
    ('place', 'other', 'same'),
    [
        ('motor_M', 'pulley_M', True),
        ('encoder_M', 'torque_M', True),
        ('pulley_3', 'encoder_3', True),
        ('motor_M', 'pulley_L', False),
        ('pulley_1', 'cable_m1', False),
        ('cable_m1', 'cable_m1', True),
        ('contact', 'load_cell', False),
    ],
)
def test_what_belongs_to_one_body(bench, place, other, same):
    assert of_one_body(bench, Candidate('', place), Candidate('', other)) is same


def test_two_effects_on_one_body_that_are_one_are_told_as_one(bench, measured_on):
    true = (
        (COUNTS.effect, COUNTS.place, {'gain': 1.06}),
        (DAMPED.effect, DAMPED.place, {'damping': 0.2}),
    )
    run = measured_on(bench, *true, touching=True, without=('pulley/', 'load_cell'))
    problem = prepared([run], bench).problem
    three = problem.empty.joined(WHEEL, {'amplitude': 0.06, 'phase': 0.0})
    three = three.joined(STRONGER, {'gain': 1.06}).joined(DAMPED, {'damping': 0.2})
    found = Found()
    found.states += [problem.fitted(problem.empty), problem.fitted(three)]
    Challenge(Steps(problem, [COUNTS, WHEEL, STRONGER, DAMPED], 1, lambda *_: None), {}).of(found)
    assert set(found.final.model.causes) == {COUNTS, DAMPED}
    gain = found.final.model.values(found.final.model.causes.index(COUNTS))['gain']
    assert gain == pytest.approx(1.06, abs=0.01)


BOTH = {RUBS: {'torque': 0.2}, PULLED: {'torque': -0.12}}
ONE = {SIDED: {'forward': 0.32, 'backward': 0.08}}


@pytest.fixture
def turned_little(measured_on):
    """Return a function that records a body, with effects, that turns round some times."""
    body = load_instrument('single_body')

    def record(there):
        effects = [(c.effect, c.place, values) for c, values in there.items()]
        slow = (('duration', '6 s'), ('amplitude', '60 deg'))
        return prepared([measured_on(body, *effects, settings=slow)], body).problem

    return record


def state_of(problem, causes):
    """Return the fit of causes from their own sizes."""
    model = problem.empty
    for cause, values in causes.items():
        model = model.joined(cause, values)
    return problem.fitted(model)


@pytest.mark.parametrize('there', [BOTH, ONE])
def test_friction_by_direction_is_not_told_from_a_bias_where_little_turns(turned_little, there):
    problem = turned_little(there)
    found = Found(states=[problem.fitted(problem.empty), state_of(problem, there)])
    steps = Steps(problem, [RUBS, PULLED, SIDED, OTHER], 1, lambda *_: None)
    Challenge(steps, {}).of(found)
    assert found.final.model.causes == (SIDED,)  # one fault is likelier than two
    assert set(BOTH) <= {r.candidate for r in equals(problem, found, 0)}


@pytest.mark.parametrize(
    ('there', 'expected'),
    [(BOTH, {RUBS: [SIDED], PULLED: [SIDED]}), (ONE, {SIDED: [RUBS, PULLED]})],
)
def test_two_take_the_place_of_one_and_one_that_of_two(turned_little, there, expected):
    problem = turned_little(there)
    state = state_of(problem, there)
    steps = Steps(problem, [RUBS, PULLED, SIDED, OTHER], 1, lambda *_: None)
    rivals = instead(steps, state)
    assert {c: [r.candidate for r in own] for c, own in rivals.items()} == expected
    for rival in (r for own in rivals.values() for r in own):
        assert rival.fit.cost < state.cost + tie(problem, state) * len(state.left)


def test_what_does_the_same_on_another_body_takes_no_place(bench, measured_on):
    problem = prepared([measured_on(bench)], bench).problem
    friction = Candidate('coulomb_friction', 'pulley_M')
    bias = Candidate('torque_bias', 'motor_L')
    state = problem.fitted(
        problem.empty.joined(friction, {'torque': 0.01}).joined(bias, {'torque': 0.01}), rounds=0
    )
    sided = [Candidate('asymmetric_friction', f'pulley_{name}') for name in 'ML']
    steps = Steps(problem, [friction, bias, *sided], 1, lambda *_: None)
    assert instead(steps, state) == {}
