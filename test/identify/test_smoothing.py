"""Smoothing: within the counts, smoother than the counts, and across gaps."""

import numpy as np
import pytest

from tendon_ros.identify.smoothing import at_rest, smoothed

COUNT = 2.0 * np.pi / 28000
TIME = 0.002 * np.arange(2000)


def swing(time):
    return 0.08 * np.sin(2.0 * np.pi * 0.5 * time) + 0.02 * np.sin(2.0 * np.pi * 1.7 * time)


def counted(value):
    return COUNT * np.round(value / COUNT)


def test_stays_within_a_count_and_is_nearer_to_the_truth():
    truth = swing(TIME)
    reading = counted(truth)
    known = np.ones(len(TIME), dtype=bool)
    found = smoothed(reading, known, COUNT / np.sqrt(12.0), COUNT)
    assert np.abs(found - reading).max() < COUNT
    assert np.std(found - truth) < 0.5 * np.std(reading - truth)


def test_what_is_fast_for_a_moment_is_no_reason_to_believe_in_counts_elsewhere():
    truth = swing(TIME)
    truth[900:925] += 2.0 * COUNT * np.sin(2.0 * np.pi * 40.0 * TIME[:25])
    known = np.ones(len(TIME), dtype=bool)
    found = smoothed(counted(truth), known, COUNT / np.sqrt(12.0), COUNT)
    assert np.abs(found - truth).max() < 1.2 * COUNT
    elsewhere = np.r_[100:800, 1000:1900]
    off = np.gradient(np.gradient(found - truth, TIME), TIME)[elsewhere]
    assert np.std(off) < 0.1


def test_acceleration_becomes_usable():
    truth = swing(TIME)
    found = smoothed(counted(truth), np.ones(len(TIME), dtype=bool), COUNT / np.sqrt(12.0), COUNT)
    inner = slice(100, -100)
    wanted = np.gradient(np.gradient(truth, TIME), TIME)[inner]
    off = np.gradient(np.gradient(found, TIME), TIME)[inner] - wanted
    raw = np.gradient(np.gradient(counted(truth), TIME), TIME)[inner] - wanted
    assert np.std(off) < 0.4 * np.std(wanted)
    assert np.std(raw) > 10.0 * np.std(off)


@pytest.mark.parametrize('length', [5, 40])
def test_bridges_a_gap_whatever_stands_there(length):
    truth = swing(TIME)
    reading = counted(truth)
    known = np.ones(len(TIME), dtype=bool)
    known[900 : 900 + length] = False
    reading[~known] = 7.0
    found = smoothed(reading, known, COUNT / np.sqrt(12.0), COUNT)
    # 80 ms of a swing of 1.7 Hz: a few counts
    assert np.abs(found - truth)[~known].max() < 4.0 * COUNT


def test_a_perfect_sensor_is_left_alone():
    value = swing(TIME)
    known = np.ones(len(TIME), dtype=bool)
    known[500] = False
    found = smoothed(value, known, 0.0, 0.0)
    assert np.array_equal(found[known], value[known])
    assert found[500] == pytest.approx(value[500], abs=1e-6)


def test_a_motor_at_rest_stays_at_rest():
    found = smoothed(np.full(500, 0.3), np.ones(500, dtype=bool), COUNT, COUNT)
    assert np.abs(found - 0.3).max() < 0.01 * COUNT


def test_a_quick_motion_is_not_flattened():
    # 5 Hz of two degrees: the smoother must not trade it for smoothness
    truth = np.deg2rad(2.0) * np.sin(2.0 * np.pi * 5.0 * TIME)
    found = smoothed(counted(truth), np.ones(len(TIME), dtype=bool), COUNT / np.sqrt(12.0), COUNT)
    assert np.abs(found - truth).max() < 1.5 * COUNT


def test_a_motor_that_flickers_between_two_counts_rests():
    flicker = np.random.default_rng(1).random(2000) < 0.1
    reading = COUNT * flicker
    found = smoothed(reading, np.ones(2000, dtype=bool), COUNT / np.sqrt(12.0), COUNT)
    assert np.ptp(found[50:-50]) < 0.15 * COUNT
    assert np.abs(found - reading).max() < COUNT


def test_a_sudden_start_does_not_spoil_the_rest():
    ramp = 0.09 * np.clip(TIME - 2.0, 0.0, 0.5)
    reading = counted(ramp)
    known = np.ones(len(TIME), dtype=bool)
    found = smoothed(reading, known, COUNT / np.sqrt(12.0), COUNT)
    away = (TIME > 2.1) & (TIME < 2.4)
    assert np.std((found - ramp)[away]) < 0.25 * np.std((reading - ramp)[away])
    assert np.abs(found - reading).max() < 1.0 * COUNT


def test_a_sensor_without_counts_is_smoothed_by_its_noise():
    noise = 1e-4
    truth = swing(TIME)
    reading = truth + np.random.default_rng(2).normal(0.0, noise, len(TIME))
    found = smoothed(reading, np.ones(len(TIME), dtype=bool), noise, 0.0)
    assert np.std(found - truth) < 0.5 * noise


@pytest.mark.parametrize(('frequency', 'rests'), [(1.0, True), (40.0, False)])
def test_a_motor_that_shakes_rests_nowhere(frequency, rests):
    time = np.arange(0.0, 2.0, 0.002)
    angle = 0.01 * np.sin(2.0 * np.pi * frequency * time)
    assert at_rest(angle, 1e-5, 0.002).any() == rests
    # and a motor that flickers between two counts does not shake
    assert at_rest(1e-3 * angle, 1e-5, 0.002).all()
