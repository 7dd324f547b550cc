"""What is noise in what a model leaves, and what has structure."""

import numpy as np
import pytest

from tendon_ros.identify.noise_estimate import heard, neighbours, unshared


@pytest.mark.parametrize('period', [0.002, 0.008, 0.017, 0.02, 0.024])
def test_acceleration_that_counts_make_up_has_no_structure(period):
    # a second difference of angles whose errors share nothing beyond a bin
    error = np.random.default_rng(4).normal(size=20_000)
    made_up = np.diff(error, 2)
    power = unshared(made_up, neighbours(period, counted=True))
    assert power == pytest.approx(np.mean(made_up**2), rel=0.05)


def test_slow_samples_and_motion_without_counts_are_compared_sooner():
    assert neighbours(0.1, counted=True) == 1
    assert neighbours(0.02, counted=False) == 2


@pytest.mark.parametrize('frequency', [28.0, 41.7, 63.0, 110.0])
def test_what_shakes_is_no_noise(frequency):
    # a controller with a late encoder: faster than bins that are neighbours are apart
    time = 0.002 * np.arange(6000)
    noise = 0.1 * np.random.default_rng(5).normal(size=time.size)
    left = 30.0 * np.sin(2.0 * np.pi * frequency * time) + noise
    apart = neighbours(0.002, counted=True)
    assert heard(left, apart) < 8.0
    assert unshared(left, apart) < 0.15 * np.mean(left**2)


@pytest.mark.parametrize('frequency', [4.0, 6.0, 11.0])
def test_what_swings_is_no_noise(frequency):
    # a cable whose damping is a guess: slower than that, and far from straight for so long
    time = 0.008 * np.arange(4000)
    left = 100.0 * np.sin(2.0 * np.pi * frequency * time)
    left += np.random.default_rng(5).normal(size=time.size)
    apart = neighbours(0.008, counted=True)
    assert heard(left, apart) < 10.0
    assert unshared(left, apart) < 0.6 * np.mean(left**2)


def test_noise_with_a_memory_keeps_all_its_power():
    # a torque through a filter of 10 ms: the nearest bins share most of it
    rng = np.random.default_rng(6)
    left = np.zeros(20_000)
    for n, kick in enumerate(rng.normal(size=left.size)):
        left[n] = 0.8 * left[n - 1] + kick
    apart = neighbours(0.002, counted=True)
    assert heard(left, apart) == pytest.approx(np.std(left), rel=0.1)
    assert unshared(left / np.std(left), apart) == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize('lasts', [4, 8])
def test_what_knocks_now_and_then_is_no_noise(lasts):
    # a gear whose teeth meet again after each reversal: nothing of it is left 40 ms later
    left = np.random.default_rng(7).normal(size=4000)
    for begun in range(100, 4000, 150):
        left[begun : begun + lasts] += 9.0 * np.exp(-np.arange(lasts) / 2.0)
    assert np.mean(left**2) > 1.7
    assert unshared(left, 8) < 0.8 * np.mean(left**2)


def test_a_sensor_that_spikes_is_noise():
    rng = np.random.default_rng(8)
    left = rng.normal(size=4000)
    left[rng.random(4000) < 0.02] += 12.0
    assert unshared(left, 4) == pytest.approx(np.var(left), rel=0.1)


def test_a_few_samples_do_not_shake_by_chance():
    # a push of a second at 50 Hz: nothing is a tenth of itself for lying near the ends
    for seed in range(20):
        left = np.cumsum(np.random.default_rng(seed).normal(size=60))
        bend = left[4:] - 2.0 * left[2:-2] + left[:-4]
        usual = 1.4826 * np.median(np.abs(bend)) / np.sqrt(6.0)
        assert heard(left, 2) > 0.5 * usual
