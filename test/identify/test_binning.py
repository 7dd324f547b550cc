"""Bins are as long as they may be, and no longer than a drive's acceleration allows."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.binning import bin_length
from tendon_ros.model.instrument_file import load_instrument

ANGLE, TORQUE = 'actuator/pulley_body/position', 'actuator/pulley_body/effort'
INERTIA = 0.01  # of the body [kg m^2]


@pytest.fixture(scope='module')
def rig():
    body = load_instrument('single_body')
    pulley = replace(body.pulleys[0], inertia=INERTIA, damping=0.0)
    fine = tuple(replace(s, resolution=1e-7 * (s.kind == 'angle')) for s in body.sensors)
    return replace(body, pulleys=(pulley,), sensors=fine)


def swinging(frequency, seconds=4.0, count=0.0):
    """Return a recording of a body that swings, and nothing else."""
    time = np.arange(0.0, seconds, 1e-3)
    way = 2.0 * np.pi * frequency
    angle = 0.1 * np.sin(way * time)
    torque = -INERTIA * way**2 * angle
    if count:
        angle = count * np.round(angle / count)
    return Recording(
        'swinging', {ANGLE: Channel(ANGLE, time, angle), TORQUE: Channel(TORQUE, time, torque)}
    )


def inertia_of(body, run):
    """Return the inertia that a fit finds, by the file's."""
    problem = prepared([run], body).problem
    fit = problem.fitted(problem.empty)
    [inertia] = [
        t.use(z).parameters[t.parameter]
        for t, z in zip(problem.tolerances, fit.model.moved, strict=True)
        if t.quantity == 'inertia'
    ]
    return inertia


def test_fast_motion_has_short_bins(rig):
    assert bin_length([swinging(1.0)], rig) == pytest.approx(0.008)
    assert bin_length([swinging(10.0)], rig) == pytest.approx(0.004)


@pytest.fixture(scope='module')
def counting(rig):
    """Return a way to the rig whose inertia is guessed, with an encoder of so large a count."""
    guessed = replace(rig, tolerances={'pulley_body.inertia': math.inf})
    return lambda count: replace(
        guessed,
        sensors=tuple(replace(s, resolution=count * (s.kind == 'angle')) for s in rig.sensors),
    )


@pytest.mark.parametrize('frequency', [1.0, 2.0, 4.0])
@pytest.mark.parametrize('count', [1e-3, 2e-3])
def test_counts_of_a_hundredth_of_a_swing_leave_inertia_as_it_is(counting, frequency, count):
    body, run = counting(count), swinging(frequency, 20.0, count)
    assert inertia_of(body, run) == pytest.approx(1.0, abs=0.025)


@pytest.mark.parametrize(('count', 'within'), [(5e-3, 0.05), (1e-2, 0.08)])
def test_coarser_counts_have_longer_bins(counting, count, within):
    body, run = counting(count), swinging(1.0, 10.0, count)
    assert 0.06 < bin_length([run], body) <= 0.1
    assert inertia_of(body, run) == pytest.approx(1.0, abs=within)
    # a torque against which inertia is small asks for no longer ones
    loaded = run.with_channels([replace(run[TORQUE], value=run[TORQUE].value + 10.0)])
    assert bin_length([loaded], body) == pytest.approx(0.008)


def test_what_shakes_before_a_gear_is_no_acceleration_of_what_is_behind_it(counting):
    count = 1e-3
    body, run = counting(count), swinging(1.0, 10.0)
    time = run[ANGLE].time
    # 25 Hz by two counts would take nearly twice the torque that moves the body
    shaken = run[ANGLE].value + 2.0 * count * np.sin(2.0 * np.pi * 25.0 * time)
    shakes = run.with_channels([replace(run[ANGLE], value=count * np.round(shaken / count))])
    assert bin_length([shakes], body) > 0.015
    # a torque that does so is there
    driven = run[TORQUE].value + INERTIA * (50.0 * np.pi) ** 2 * (run[ANGLE].value - shaken)
    torque = replace(run[TORQUE], value=driven)
    assert bin_length([shakes.with_channels([torque])], body) == pytest.approx(0.008)


@pytest.mark.parametrize('seconds', [3.0, 5.0])
def test_the_slowest_motion_does_not_decide(rig, seconds):
    both = [swinging(1.0), swinging(10.0, seconds)]
    assert bin_length(both, rig) == pytest.approx(0.004)


def test_a_recording_of_few_bins_does_not_decide_either(rig):
    time = np.arange(0.0, 900.0, 0.05)
    angle = 0.1 * np.sin(time)
    long = Recording(
        'long',
        {ANGLE: Channel(ANGLE, time, angle), TORQUE: Channel(TORQUE, time, -INERTIA * angle)},
    )
    assert bin_length([long, swinging(1.0, 0.6)], rig) == bin_length([long], rig) > 0.1


def test_a_rotor_behind_its_gear_counts(rig):
    light = replace(rig, pulleys=(replace(rig.pulleys[0], inertia=1e-5),))
    [motor] = light.motors
    geared = replace(light, motors=(replace(motor, gear_ratio=30.0, rotor_inertia=1.11e-5),))
    assert bin_length([swinging(10.0)], light) == pytest.approx(0.008)
    assert bin_length([swinging(10.0)], geared) == pytest.approx(0.004)


def test_no_inertia_is_lost_in_a_bin(rig):
    problem = prepared([swinging(10.0)], rig).problem
    [segment] = problem.rollouts.segments
    [torque] = segment.measured
    predicted = problem.rollouts.predicted([[]])[0][0]
    inner = segment.time > 0.25
    ratio = predicted[inner] @ torque.value[inner] / (predicted[inner] @ predicted[inner])
    assert ratio == pytest.approx(1.0, abs=0.015)
