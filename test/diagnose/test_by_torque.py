"""A rig without any motor encoder: driven by its torques, its guesses found with the cause."""

import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.recording import Channel
from tendon_ros.base.resources import config_path
from tendon_ros.model.instrument_file import load_instrument, save_instrument

EARLY = 6.0  # [s]


@pytest.fixture(scope='module')
def outcome(quick, by_voltage):
    """Return what is said of the first seconds of the tutorial's recording."""
    mapping = load_mapping(config_path('imports/belt_by_voltage.yaml'))
    [run] = import_runs(by_voltage, mapping)
    early = [
        Channel(c.name, c.time[c.time < EARLY], c.value[c.time < EARLY])
        for c in run.channels.values()
    ]
    return quick([run.with_channels(early)], load_instrument('belt_by_voltage'))


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
