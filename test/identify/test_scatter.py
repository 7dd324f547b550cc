"""Readings that scatter: by their stamps, by lost digits, and what shakes instead."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.identify.motion import motion_of, reading_error
from tendon_ros.identify.scatter import scatter
from tendon_ros.identify.smoothing import recounted
from tendon_ros.model.instrument import Sensor

COUNT, SAMPLING = 3.5e-4, 0.0025
ENCODER = Sensor('encoder_arm', 'angle', 'arm', 'actuator/pulley_arm/position', resolution=COUNT)
BEAT = SAMPLING * np.arange(4000)


def angle(time):
    """Return a motion of up to 26 rad/s that comes to rest from 4 s to 5 s."""
    swing = 3.0 * np.sin(2.0 * np.pi * 1.1 * time) + 0.4 * np.sin(2.0 * np.pi * 2.3 * time)
    away = np.clip(np.abs(time - 4.5) - 0.5, 0.0, 1.0)
    return swing * away**4 * (35.0 - 84.0 * away + 70.0 * away**2 - 20.0 * away**3)


def read(late=0.0, noise=0.0, jitter=0.0, seed=3):
    """Return what is read at scattered times and stamped some other time off."""
    rng = np.random.default_rng(seed)
    time = BEAT + jitter * SAMPLING * rng.random(BEAT.size)
    value = angle(time + late * rng.normal(size=time.size)) + noise * rng.normal(size=time.size)
    return Channel(ENCODER.channel, time, COUNT * np.round(value / COUNT))


@pytest.mark.parametrize('jitter', [0.0, 0.3])
def test_stamps_tell_times_to_some_hundredths_of_a_millisecond(jitter):
    found = scatter(read(late=2e-5, jitter=jitter), COUNT)
    assert found.late == pytest.approx(2e-5, rel=0.1)
    assert found.still < 1.6 * COUNT / np.sqrt(12.0)
    error = reading_error(read(late=2e-5, jitter=jitter), ENCODER)
    at_20 = error.apart(20.0 * BEAT, SAMPLING)[100:-100]
    assert at_20 == pytest.approx(4e-4, rel=0.15)


@pytest.mark.parametrize('jitter', [0.0, 0.3])
def test_true_stamps_are_no_noise(jitter):
    error = reading_error(read(jitter=jitter), ENCODER)
    assert (error.still, error.late) == (pytest.approx(COUNT / np.sqrt(12.0)), 0.0)


def test_digits_that_are_lost_scatter_at_any_speed():
    found = scatter(read(noise=10.0 * COUNT), COUNT)
    assert found.still == pytest.approx(10.0 * COUNT, rel=0.1)
    assert found.late * 20.0 < 5.0 * COUNT


def test_a_few_slips_are_no_scatter():
    channel = read()
    slipped = channel.value + np.where(np.arange(BEAT.size) % 200 == 7, 40.0 * COUNT, 0.0)
    assert scatter(replace(channel, value=slipped), COUNT).usual < 1.5 * COUNT / np.sqrt(12.0)


@pytest.mark.parametrize('readings', [0, 1, 5, 50])
def test_few_readings_tell_nothing(readings):
    channel = read()
    few = replace(channel, time=channel.time[:readings], value=channel.value[:readings])
    assert scatter(few, COUNT) is None


def test_what_shakes_does_not_scatter():
    time = BEAT
    shaking = angle(time) + 0.02 * np.sin(2.0 * np.pi * 45.0 * time)
    assert scatter(Channel('', time, shaking), COUNT).usual == 0.0
    assert scatter(Channel('', time, 1e-4 * shaking), COUNT) is None


def test_fast_parts_are_smoothed_by_their_stamps_and_slow_ones_by_counts():
    channel = read(late=2e-5)
    found = motion_of(channel, ENCODER, 0.0, SAMPLING, BEAT.size)
    inner = slice(40, -40)
    fast = (np.abs(np.gradient(angle(BEAT), SAMPLING)) > 10.0)[inner]
    off, raw = ((row - angle(BEAT))[inner] for row in (found, channel.value))
    assert np.std(off[fast]) < 0.6 * np.std(raw[fast])
    rests = ((BEAT > 4.1) & (BEAT < 4.9))[inner]
    assert np.abs(off[rests]).max() < COUNT


def test_a_motion_that_is_read_again_is_off_by_as_much():
    late = read(late=2e-5)
    error = reading_error(late, ENCODER)
    truth = angle(BEAT)
    found = motion_of(late, ENCODER, 0.0, SAMPLING, BEAT.size)
    again = recounted(found, error.still, error.apart(found, SAMPLING))
    inner = slice(40, 1100)  # before it rests
    assert np.std((again - found)[inner]) == pytest.approx(np.std((found - truth)[inner]), rel=0.4)
    assert np.array_equal(again, recounted(found, error.still, error.apart(found, SAMPLING)))
