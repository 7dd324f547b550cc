"""The place of an error that no cause explains: found by directions, and by what a place feels."""

import pytest

from tendon_ros.diagnose.places import Places
from tendon_ros.diagnose.prepare import prepared


@pytest.fixture(scope='module')
def blamed(bench, measured_on):
    """Return a function that names places for a bench with an effect that nobody looks for."""

    def blame(*effect):
        run = measured_on(bench, effect, trajectory='paper_fig12', settings=(), touching=True)
        problem = prepared([run], bench).problem
        return Places(problem, problem.fitted(problem.empty)).shares()

    return blame


@pytest.mark.parametrize(
    ('effect', 'place', 'values'),
    [
        ('coulomb_friction', 'pulley_3', {'torque': 0.2}),
        ('viscous_friction', 'pulley_M', {'damping': 1.0}),
        ('joint_spring', 'pulley_1', {'stiffness': 1.0}),
        ('torque_gain', 'motor_M', {'gain': 1.3}),
        ('torque_gain', 'motor_L', {'gain': 1.3}),
        ('load_cell_gain', 'load_cell', {'gain': 1.2}),
        ('encoder_gain', 'encoder_1', {'gain': 1.05}),
        ('encoder_gain', 'encoder_L', {'gain': 1.05}),
    ],
)
def test_a_place_is_told_by_direction_and_by_what_it_feels(blamed, effect, place, values):
    found = blamed(effect, place, values)
    assert found[0][0] == place


def test_places_that_no_channel_tells_apart_are_the_same(bench, measured_on):
    problem = prepared([measured_on(bench, touching=True)], bench).problem
    places = Places(problem, problem.fitted(problem.empty))
    assert places.same('pulley_M') == ['motor_M', 'torque_M']
    assert places.same('motor_L') == ['pulley_L', 'torque_L']
    assert places.same('pulley_3') == []


def test_what_places_take_adds_up_to_no_more_than_there_is(bench, measured_on):
    run = measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.2}))
    problem = prepared([run], bench).problem
    fit = problem.fitted(problem.empty)
    taken = [float(t.sum()) for _, t in Places(problem, fit).shares()]
    assert 0.0 < sum(taken) <= fit.cost
    assert taken == sorted(taken, reverse=True)
