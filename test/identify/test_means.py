"""Means over bins, and what a smooth prediction in their middles is as such a mean."""

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.identify.means import averaged, binned
from tendon_ros.model.instrument import Sensor

PERIOD, BINS = 0.02, 200
SENSOR = Sensor('encoder_jaw', 'pulley/pulley_jaw/position', 'angle', 'jaw')


@pytest.mark.parametrize('each', [1, 2, 5, 20])
def test_a_curved_signal_in_the_middles_becomes_the_mean_of_its_readings(each):
    def signal(time):
        return np.sin(2.0 * np.pi * 3.0 * time)

    middles = PERIOD * (np.arange(BINS) + 0.5)
    within = (np.arange(each) + 0.5) / each
    time = (PERIOD * (np.arange(BINS)[:, None] + within)).ravel()
    channel = Channel(SENSOR.channel, time, signal(time))
    means, _, readings = binned(channel, SENSOR, 0.0, PERIOD, BINS)
    assert readings == pytest.approx(each)
    found = averaged(signal(middles)[None], np.array([readings]))[0]
    # but where it bends neither way
    inner = np.abs(np.sin(2.0 * np.pi * 3.0 * middles)) > 0.4
    inner[:2] = inner[-2:] = False
    plain = np.abs(signal(middles) - means)[inner].max()
    left = np.abs(found - means)[inner].max()
    assert left < 1e-12 if each == 1 else left < 0.05 * plain


@pytest.mark.parametrize(('scatter', 'off'), [(0.0, 3e-4), (0.1, 4e-4), (0.24, 1e-3), (0.4, 4e-3)])
@pytest.mark.parametrize('begin', [0.0, 0.5])
def test_stamps_that_scatter_leave_a_reading_in_every_bin(scatter, off, begin):
    """One a bin, in its middle or on its edge: strayed to the next bin, it would leave none."""

    def signal(time):
        return np.sin(2.0 * np.pi * time)

    rng = np.random.default_rng(3)
    time = PERIOD * (np.arange(BINS + 1) + begin + rng.uniform(-scatter, scatter, BINS + 1))
    channel = Channel(SENSOR.channel, time, signal(time))
    means, _, _ = binned(channel, SENSOR, 0.0, PERIOD, BINS)
    inner = slice(3, -3)
    if scatter < 0.25:
        assert np.isfinite(means[inner]).all()
    middles = PERIOD * (np.arange(BINS) + 0.5)
    even = 0.5 * (
        signal(middles - PERIOD * (0.5 - begin)) + signal(middles + PERIOD * (0.5 - begin))
    )
    assert np.nanstd((means - even)[inner]) < off


def test_a_jump_stays_a_jump():
    jump = np.where(np.arange(BINS) < 90, 0.0, 1.0)[None]
    assert np.array_equal(averaged(jump, np.array([10.0])), jump)


def test_what_falls_all_at_once_was_never_higher_before():
    """A reading is missing where a limit lets go: the slope after it says nothing of before."""
    time = PERIOD * (np.arange(BINS) + 0.5)
    value = np.clip(2.5 - 30.0 * (time - time[100]), 1.0, 2.5)
    missing = np.arange(BINS) != 99
    stamps = time + np.where(np.arange(BINS) == 100, 0.4 * PERIOD, 0.0)
    channel = Channel(SENSOR.channel, stamps[missing], value[missing])
    means, _, _ = binned(channel, SENSOR, 0.0, PERIOD, BINS)
    assert np.nanmax(means) == 2.5
    # beside, nothing changes
    assert np.allclose(means[:99], value[:99])
