"""Motions keep to the limits of motors and cables, and to their cycle."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.identify.excitation_motion import CYCLE, library, Motion
from tendon_ros.identify.excitation_rig import fitting, performed, reaches, touching
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.trajectory import check_limits


@pytest.fixture(scope='module')
def rig():
    """Return the bench."""
    return load_instrument('bench_rig')


def test_motions_begin_and_end_at_zero(rig):
    for motion in library(rig, reaches(rig)):
        trajectory = motion.trajectory(rig.motor_names, 3)
        assert trajectory.duration == pytest.approx(3 * CYCLE)
        angle = trajectory.sample(2e-3)
        assert np.abs(angle[[0, -1]]).max() < 1e-12


def test_middle_cycles_repeat(rig):
    n = round(CYCLE / 2e-3)
    for motion in library(rig, reaches(rig)):
        angle = motion.trajectory(rig.motor_names, 4).sample(2e-3)
        np.testing.assert_allclose(angle[n : 2 * n], angle[2 * n : 3 * n], atol=1e-9)


def test_limits_shrink_a_motion(rig):
    weak = tuple(replace(m, torque_limit=0.5, speed_limit=0.3) for m in rig.motors)
    slow = replace(rig, motors=weak)
    wished = Motion('ramps', {'M': 0.17}, {'M': 0.0}, 'tip')
    made = fitting(slow, wished)
    assert 0.0 < made.amplitude < wished.amplitude
    trajectory = made.trajectory(slow.motor_names)
    check_limits(trajectory, slow)
    rows, _ = performed(touching(slow, made), trajectory)
    assert np.abs(rows.effort).max() <= 0.5
    assert fitting(rig, replace(wished, swing={'M': 0.01})).amplitude == 0.01


def test_what_no_size_makes_possible_is_left_out(rig):
    stuck = tuple(replace(m, position_limit=(-1e-6, 1e-6)) for m in rig.motors)
    assert fitting(replace(rig, motors=stuck), Motion('ramps', {'M': 0.1}, {})) is None


def test_pressing_motions_press(rig):
    for motion in library(rig, reaches(rig)):
        if motion.against:
            rows, _ = performed(touching(rig, motion), motion.scaled(0.5).trajectory(('M', 'L')))
            assert rows.contact_force.max() > 1.0, motion
