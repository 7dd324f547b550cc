"""The gap in closed loop, or why there is none."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.closed_loop import closed_loop_gap
from tendon_ros.diagnose.prepare import prepared

SETPOINT = 'setpoint/pulley_M/position'


@pytest.fixture(scope='module')
def run(bench, measured_on):
    """Return a recording, and its segment."""
    recording = measured_on(bench)
    [segment] = prepared([recording], bench).whole.rollouts.segments
    return recording, segment


def without(recording, *names):
    """Return a recording that lacks channels."""
    kept = {n: c for n, c in recording.channels.items() if n not in names}
    return replace(recording, channels=kept)


def test_the_command_runs_by_both_files(bench, run):
    recording, segment = run
    found = closed_loop_gap([recording], bench, [bench], [segment])
    assert found.left_out == ()
    assert all(gap.before == gap.after for gap in found.gaps)
    assert {gap.channel for gap in found.gaps} >= {'actuator/pulley_M/effort'}


def test_a_set_point_that_is_missing_is_told(bench, run):
    recording, segment = run
    found = closed_loop_gap([without(recording, SETPOINT)], bench, [bench], [segment])
    assert found.gaps == ()
    assert found.left_out == (f'{recording.name}: no closed loop: no {SETPOINT} was recorded',)


def test_who_commanded_nothing_is_told_nothing(bench, run):
    recording, segment = run
    silent = without(recording, *(n for n in recording.channels if n.startswith('setpoint/')))
    assert closed_loop_gap([silent], bench, [bench], [segment]).left_out == ()


def test_a_load_that_pushed_is_told(bench, run):
    recording, segment = run
    pushed = replace(segment, pushed=('2',))
    [said] = closed_loop_gap([recording], bench, [bench], [pushed]).left_out
    assert 'the measured load pushed the model' in said


@pytest.mark.parametrize(
    ('wild', 'called'), [(0, 'the instrument file'), (1, 'the repaired file')]
)
def test_a_file_whose_controllers_diverge_is_told(bench, run, wild, called):
    recording, segment = run
    motors = tuple(
        replace(m, controller=replace(m.controller, kp=1e12, limit=1e12)) for m in bench.motors
    )
    files = [bench, bench]
    files[wild] = replace(bench, motors=motors)
    found = closed_loop_gap([recording], files[0], [files[1]], [segment])
    assert found.gaps == ()
    [said] = found.left_out
    assert f'{called} does not follow the command with its controllers: ' in said
