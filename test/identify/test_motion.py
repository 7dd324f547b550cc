"""Motion on an even grid from readings whose stamps scatter."""

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.identify.motion import motion_of
from tendon_ros.model.instrument import Sensor

COUNT, SAMPLING = 1e-4, 0.01
ENCODER = Sensor('encoder_arm', 'angle', 'arm', 'actuator/pulley_arm/position', resolution=COUNT)


@pytest.mark.parametrize('scatter', [0.0, 0.05, 0.2])
def test_a_motion_does_not_bend_with_its_stamps(scatter):
    """Straight between readings, 3 Hz would be off by 2 mrad here and 0 there: 20 counts."""
    rng = np.random.default_rng(4)
    beat = np.arange(600)
    time = SAMPLING * (beat + scatter * rng.random(beat.size))
    time[0] = 0.0

    def angle(at):
        return np.sin(2.0 * np.pi * 3.0 * at)

    channel = Channel(ENCODER.channel, time, COUNT * np.round(angle(time) / COUNT))
    found = motion_of(channel, ENCODER, 0.0, SAMPLING, beat.size)
    inner = slice(10, -10)
    assert np.std((found - angle(SAMPLING * beat))[inner]) < COUNT
