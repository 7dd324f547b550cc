"""Whether torques that come seldom hold is told by what either way leaves."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.zero_order_hold import as_set
from tendon_ros.identify.driving import as_recorded
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

DRIVEN = ('actuator/pulley_left/effort', 'actuator/pulley_right/effort')
READ = (*DRIVEN, 'pulley/pulley_roller/velocity')


@pytest.fixture(scope='module')
def belt():
    """Return the belt of the tutorial; all that it guesses is right."""
    return replace(load_instrument('belt_by_voltage'), tolerances={})


def logged(belt, tick):
    """Return fifty readings a second of a belt whose controllers tick at a period [s]."""
    motion = {'amplitude': '180 deg', 'duration': '8 s'}
    truth = replace(belt, control_period=tick)
    run = simulate(
        truth, chosen_trajectory('multisine', belt.motor_names, motion), rate=50.0, seed=3
    )
    return replace(run, channels={n: run[n] for n in READ})


@pytest.mark.parametrize(('tick', 'words'), [(0.02, 'set until the next'), (0.001, 'line')])
def test_seldom_torques_hold_where_that_leaves_less(belt, tick, words):
    run = logged(belt, tick)
    known = as_recorded(replace(belt, control_period=0.001), set(run.channels))
    ready = prepared([run], known)
    found, instrument, [said] = as_set(ready, [run], known, 1)
    held = tick > 0.01
    assert (found is not ready) == held
    assert instrument.control_period == pytest.approx(0.02 if held else 0.001)
    assert words in said
    assert 'torque_left, torque_right' in said


def test_what_the_file_says_is_not_asked(belt):
    run = logged(belt, 0.02)
    known = as_recorded(replace(belt, control_period=0.02), set(run.channels))
    ready = prepared([run], known)
    assert as_set(ready, [run], known, 1) == (ready, known, [])
