"""What a logger makes of a sound sensor is used, and no fault of it."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.logged import is_logged, logged_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

INNER = 'pulley/pulley_2/position'
COUNT = 2.0 * np.pi / 16384
STAGE = """
pulleys:
  motor: {inertia: 3e-5 kg*m^2, damping: 2e-4 N*m*s/rad}
  carriage: {inertia: 2e-4 kg*m^2, damping: 1e-3 N*m*s/rad}
curves:
  belt: {elongation: {mm: [0, 5]}, tension: {N: [0, 500]}}
loops:
  belt: {route: {motor: 12 mm, carriage: -12 mm}, curve: belt, pretension: 100 N}
motors:
  motor:
    controller: {kp: 2 N*m/rad, kd: 0.03 N*m*s/rad, limit: 1 N*m}
    encoder: {counts: 1000}
    torque_sensor: {noise: 2e-3 N*m}
joint_sensors:
  carriage: {counts: 100000}
control: {rate: 1 kHz}
"""
ZERO = Candidate('encoder_offset', 'encoder_2')


@pytest.mark.parametrize(('counts', 'loggers'), [(0.6, True), (-1.2, True), (3.0, False)])
def test_an_angle_that_is_off_within_a_count_is_no_fault(bench, measured_on, counts, loggers):
    problem = prepared([measured_on(bench)], bench).problem
    assert is_logged(problem, ZERO, {'angle': counts * COUNT}) is loggers
    model = problem.empty.joined(ZERO, {'angle': counts * COUNT})
    words = logged_words(model, [0])
    assert words.startswith(f'encoder_2 reads {1e3 * counts * COUNT:.2g} mrad off, a count of')


@pytest.mark.parametrize(('counts', 'loggers'), [(0.6, True), (-1.2, True), (3.0, False)])
def test_a_scale_that_is_off_within_a_count_over_all_that_turns_is_no_fault(
    bench, measured_on, counts, loggers
):
    problem = prepared([measured_on(bench)], bench).problem
    [turned] = [
        np.ptp(m.value)
        for segment in problem.rollouts.segments
        for m in segment.measured
        if m.sensor.name == 'encoder_2'
    ]
    scale = Candidate('encoder_gain', 'encoder_2')
    values = {'gain': float(1.0 + counts * COUNT / turned)}
    assert is_logged(problem, scale, values) is loggers
    words = logged_words(problem.empty.joined(scale, values), [0])
    assert words.startswith(f'encoder_2 reads {values["gain"]:.5g} times its angle, over all')
    assert not is_logged(problem, replace(scale, given=(('gain', 1.02),)), values)
    drives = Candidate('encoder_gain', 'encoder_M')
    assert is_logged(problem, drives, {'gain': 1.0 + 1e-5})
    assert not is_logged(problem, drives, {'gain': 1.01})


@pytest.mark.parametrize(('counts', 'loggers'), [(0.5, True), (-0.5, True), (3.0, False)])
def test_a_motor_whose_counter_cuts_off_shifts_what_it_turns(
    measured_on, tmp_path, counts, loggers
):
    """A fine scale at the carriage sees that the coarse count of the motor leaves out the rest."""
    file = tmp_path / 'stage.yaml'
    file.write_text(STAGE)
    stage = load_instrument(file)
    problem = prepared([measured_on(stage)], stage).problem
    scale = Candidate('encoder_offset', 'encoder_carriage')
    # wheels of one size, so that a count of the motor moves the carriage by as much
    assert is_logged(problem, scale, {'angle': counts * np.radians(0.36)}) is loggers


@pytest.mark.parametrize('counts', [-0.6, -6.0])
def test_a_counter_that_cuts_off_is_told_and_not_named(bench, measured_on, counts):
    run = measured_on(bench)
    off = replace(run[INNER], value=run[INNER].value + counts * COUNT)
    told = diagnose([run.with_channels([off])], bench, jobs=1, plan=False).diagnosis
    named = [(c.effect, c.place) for c in told.causes]
    assert named == ([] if counts > -1.0 else [(ZERO.effect, ZERO.place)])
    assert told.verdict == ('no_gap' if counts > -1.0 else 'explained')
