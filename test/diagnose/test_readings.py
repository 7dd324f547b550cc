"""Readings that scatter far beyond an encoder's counts are noise, and are said to be."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake.readings import as_read
from tendon_ros.identify.motion import reading_error
from tendon_ros.model.instrument_file import load_instrument

CHANNEL = 'actuator/pulley_body/position'


@pytest.fixture(scope='module')
def body():
    """Return one body on a motor."""
    return load_instrument('single_body')


def changed(run, change, time=None):
    """Return a recording whose motor's angle is off."""
    own = run[CHANNEL]
    channel = Channel(CHANNEL, own.time if time is None else time, own.value + change)
    return replace(run, channels={**run.channels, CHANNEL: channel})


def encoder(instrument):
    """Return the motor's encoder."""
    return next(s for s in instrument.sensors if s.channel == CHANNEL)


def test_an_encoder_that_only_counts_is_what_the_file_says(body, measured_on):
    assert as_read([measured_on(body)], body) == (body, ())


def test_readings_at_unknown_times_are_noisy_where_they_move(body, measured_on):
    """A driver that is polled: half of the rows hold what was read a little before."""
    run = measured_on(body)
    own = run[CHANNEL]
    late = np.random.default_rng(8).uniform(0.0, 0.004, len(own.time))
    polled = changed(run, own.at(own.time - late) - own.value)
    same, [said] = as_read([polled], body)
    assert same == body
    assert 'encoder_body: in motion its readings scatter by' in said
    assert 'the faster the more: their stamps are taken to be off by' in said
    error = reading_error(polled[CHANNEL], encoder(body))
    assert error.late == pytest.approx(np.std(late), rel=0.25)


def test_lost_digits_are_noise_that_the_file_is_given(body, measured_on):
    run = measured_on(body)
    own = run[CHANNEL]
    noise = 10.0 * encoder(body).resolution
    lost = changed(run, np.random.default_rng(8).normal(0.0, noise, len(own.time)))
    noisy, [said] = as_read([lost], body)
    assert encoder(noisy).noise == pytest.approx(noise, rel=0.15)
    assert 'that is taken for its noise' in said
    # what the file states is not said again
    assert as_read([lost], noisy) == (noisy, ())


def test_what_shakes_is_not_noisy(body, measured_on):
    run = measured_on(body)
    time = run[CHANNEL].time
    shaking = changed(run, 0.02 * np.sin(2.0 * np.pi * 45.0 * time))
    assert as_read([shaking], body) == (body, ())


def test_stamps_that_tell_when_a_reading_was_taken_make_no_noise(body, measured_on):
    run = measured_on(body)
    own = run[CHANNEL]
    time = own.time + np.random.default_rng(9).uniform(0.0, 0.4, len(own.time)) * own.sampling
    true = changed(run, np.interp(time, own.time, own.value) - own.value, time)
    assert as_read([true], body) == (body, ())
