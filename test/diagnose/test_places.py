"""The place of an error that no cause explains: found by directions, and by what a place feels."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.places import Places
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument


@pytest.fixture(scope='module')
def blamed(bench, measured_on):
    """Return a function that names places for a bench with an effect that nobody looks for."""

    def blame(*effect):
        run = measured_on(bench, effect, trajectory='paper_fig12', settings=(), touching=True)
        problem = prepared([run], bench).problem
        return Places(problem, problem.fitted(problem.empty)).shares()

    return blame


@pytest.mark.parametrize(
    ('effect', 'place', 'values', 'same'),
    [
        ('coulomb_friction', 'pulley_3', {'torque': 0.2}, set()),
        ('viscous_friction', 'pulley_M', {'damping': 1.0}, {'motor_M', 'torque_M'}),
        ('joint_spring', 'pulley_1', {'stiffness': 1.0}, set()),
        ('torque_gain', 'motor_M', {'gain': 1.3}, {'pulley_M', 'torque_M'}),
        ('torque_gain', 'motor_L', {'gain': 1.3}, {'pulley_L', 'torque_L'}),
        ('load_cell_gain', 'load_cell', {'gain': 1.2}, set()),
        ('encoder_gain', 'encoder_1', {'gain': 1.05}, set()),
        ('encoder_gain', 'encoder_L', {'gain': 1.05}, {'cable_L3'}),
    ],
)
def test_a_place_is_told_by_direction_and_by_what_it_feels(blamed, effect, place, values, same):
    first = blamed(effect, place, values)[0]
    assert (first.place, set(first.same)) == (place, same)


def test_a_wall_and_the_cable_that_presses_on_it_are_the_same_without_inner_encoders(
    bench, measured_on
):
    softer = ('contact_stiffness', 'contact', {'scale': 0.5})
    run = measured_on(
        bench, softer, trajectory='paper_fig12', settings=(), touching=True, without=('pulley/',)
    )
    problem = prepared([run], bench).problem
    first = Places(problem, problem.fitted(problem.empty)).shares()[0]
    assert {'contact', 'cable_L3'} <= {first.place, *first.same}


def test_what_places_take_adds_up_to_no_more_than_there_is(bench, measured_on):
    run = measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.2}))
    problem = prepared([run], bench).problem
    fit = problem.fitted(problem.empty)
    taken = [float(one.power.sum()) for one in Places(problem, fit).shares()]
    assert 0.0 < sum(taken) <= fit.cost
    assert taken == sorted(taken, reverse=True)


def test_what_drags_by_speed_lies_at_the_pulley(measured_on):
    # as the square of the speed: a fan, or what stirs oil
    axis = load_instrument('driven_axis')
    [motor] = axis.motors
    settings = {'duration': '12 s', 'amplitude': '40 deg'}
    run = measured_on(axis, settings=tuple(settings.items()))
    effort, position = (
        f'actuator/pulley_{motor.pulley}/{quantity}' for quantity in ('effort', 'position')
    )
    channel = run[effort]
    step = 0.02
    ahead, behind = (run[position].at(channel.time + lag) for lag in (step, -step))
    speed = (ahead - behind) / (2.0 * step)
    dragged = replace(channel, value=channel.value + 0.05 * speed * np.abs(speed))
    run = replace(run, channels={**run.channels, effort: dragged})
    problem = prepared([run], axis).problem
    first = Places(problem, problem.fitted(problem.empty)).shares()[0]
    assert first.place == f'pulley_{motor.pulley}'
