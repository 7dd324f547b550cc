"""A speed sensor measures from the model into a bag and back."""

import numpy as np
import pytest

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

SENSORS = 'speed_sensors: {M: {}, 3: {resolution: 0.01 rad/s}, 1: {noise: 0.1 rad/s}}\n'


@pytest.fixture(scope='module')
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp('speed')
    (folder / 'rig.yaml').write_text(
        'base: bench_rig\n'
        + SENSORS
        + 'effects: [{effect: sensor_rectified, place: speed_3, parameters: {rectified: 1}}]\n'
    )
    rig = load_instrument(folder / 'rig.yaml')
    given = {'duration': '1 s', 'fade': '0.1 s', 'frequency': '2 Hz'}
    recording = simulate(rig, chosen_trajectory('sine', rig.motor_names, given), seed=1)
    return recording, read_recording(write_recording(recording, folder / 'bag'))


def test_it_reads_the_slope_of_the_angle(run):
    recording, _ = run
    angle = recording['actuator/pulley_M/position']
    speed = recording['actuator/pulley_M/velocity'].value
    slope = np.gradient(angle.value, angle.time)
    assert np.ptp(speed) > 1.0
    np.testing.assert_allclose(speed[5:-5], slope[5:-5], atol=0.1)


def test_resolution_noise_and_effects_act_on_it(run):
    recording, _ = run
    rounded = recording['pulley/pulley_3/velocity'].value
    np.testing.assert_allclose(rounded / 0.01, np.round(rounded / 0.01), atol=1e-6)
    assert rounded.min() >= 0.0
    assert rounded.max() > 0.3
    noisy = np.diff(recording['pulley/pulley_1/velocity'].value[:20])
    assert 0.05 < noisy.std() < 0.3


def test_it_survives_the_bag(run):
    recording, back = run
    for name in ('actuator/pulley_M/velocity', 'pulley/pulley_3/velocity'):
        np.testing.assert_array_equal(back[name].value, recording[name].value)
