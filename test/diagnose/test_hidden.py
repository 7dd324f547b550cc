"""What noise hides is said: as a note, or as a doubt that there is no gap."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.hidden import coarse_words, loud_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_body/effort'


@pytest.fixture
def steady():
    """Return one body on a motor whose loop damps so little that it hardly shakes by counts."""
    body = load_instrument('single_body')
    [motor] = body.motors
    return replace(body, motors=(replace(motor, controller=replace(motor.controller, kd=0.005)),))


@pytest.mark.parametrize(('more', 'told'), [(0.0, True), (0.05, True), (0.05, False)])
def test_what_shakes_faster_than_bins_is_said_where_the_sensor_is_known(
    steady, measured_on, more, told
):
    body = steady
    run = measured_on(body)
    effort = run[EFFORT]
    shaken = effort.value + more * np.random.default_rng(1).standard_normal(effort.value.size)
    run = run.with_channels([replace(effort, value=shaken)])
    if not told:
        sensors = [replace(s, noise=0.0, resolution=0.0) for s in body.sensors]
        body = replace(body, sensors=tuple(sensors))
    words = loud_words(prepared([run], body))
    assert [w.split()[0] for w in words] == ([EFFORT] if more and told else [])
    # the sensor's own noise is 5 mN m, and counts make some more
    assert all(4 <= int(w.split()[2]) <= 10 for w in words)


@pytest.mark.parametrize('times', [1.0, 30.0])
def test_what_counts_hide_is_said_where_it_is_more_than_the_sensors_own_noise(
    steady, measured_on, times
):
    body = steady
    sensors = [
        replace(s, noise=s.noise / times, resolution=s.resolution / times)
        if s.channel == EFFORT
        else s
        for s in body.sensors
    ]
    body = replace(body, sensors=tuple(sensors))
    ready = prepared([measured_on(body)], body)
    words = coarse_words(ready)
    assert bool(words) is (times > 1.0)
    assert all('finer encoder' in said and ' N m and no better' in said for said in words)
    # counts account for it: nothing shakes
    assert not loud_words(ready)
    # a small part of what it does: a note, and no doubt of the verdict
    assert not coarse_words(ready, much=True)


def test_noise_that_hides_most_of_what_a_channel_does_makes_one_doubt_that_there_is_no_gap(
    steady, measured_on
):
    # a torque sensor that tells what counts make of it, and hardly any motion
    sensors = [
        replace(s, noise=s.noise / 30.0) if s.channel == EFFORT else s for s in steady.sensors
    ]
    body = replace(steady, sensors=tuple(sensors))
    still = measured_on(body, settings=(('duration', '6 s'), ('amplitude', '0.3 deg')))
    ready = prepared([still], body)
    [said] = [one for one in coarse_words(ready, much=True) if one.startswith(EFFORT)]
    assert said.endswith('that there is no gap says little')
    assert not any(one.startswith(EFFORT) for one in coarse_words(ready))
