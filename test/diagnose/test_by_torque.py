"""A rig without any motor encoder: driven by its torques, its guesses found with the cause."""

import pytest

from tendon_ros.model.instrument_file import load_instrument, save_instrument

#: what nobody would take for a lost sign, or what guesses do as well: a short search
BESIDE = (
    'asymmetric_friction', 'backlash', 'cable_creep', 'cable_hysteresis', 'cable_slip',
    'cable_stiffness', 'damping', 'disturbance', 'eccentricity', 'gravity', 'inertia',
    'joint_spring', 'presliding_friction', 'pretension', 'sensor_delay', 'stribeck_friction',
    'tension_friction', 'torque_bias', 'torque_gain', 'torque_ripple', 'torque_saturation',
)  # fmt: skip


@pytest.fixture(scope='module')
def outcome(quick, by_voltage):
    """Return what is said of the first seconds of the tutorial's recording."""
    return quick([by_voltage(4.0)], load_instrument('belt_by_voltage'), withhold=BESIDE)


def test_a_speed_without_sign_is_found_beside_guesses(outcome):
    first = outcome.diagnosis.causes[0]
    assert (first.effect, first.place) == ('sensor_rectified', 'speed_roller')
    [gap] = outcome.diagnosis.gap
    assert gap.after < 0.15 * gap.before


def test_it_is_said_that_torque_drives_the_model(outcome):
    assert any(
        'the position of left, right was not recorded' in text
        for text in outcome.diagnosis.left_out
    )


def test_the_patched_file_can_be_written_and_read(outcome, tmp_path):
    # a belt found to be much softer than its curve still bears its pretension
    save_instrument(outcome.instrument, tmp_path / 'belt.yaml')
    assert load_instrument(tmp_path / 'belt.yaml').effects
