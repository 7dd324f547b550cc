"""The model begins at rest, and where the motors truly are."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.beginning import Beginning
from tendon_ros.identify.segment import SETTLING
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.numbers import Numbers


@pytest.fixture(scope='module')
def free(sound_problem):
    """Return rollouts of a recording with nothing to touch, in which all may turn at will."""
    rollouts = sound_problem.rollouts
    return rollouts.like([replace(s, contacts=()) for s in rollouts.segments])


def angles(rollouts, effect, place, **parameters):
    """Return what the pulleys do with an effect, shape (bins, pulleys), [rad]."""
    return rollouts.states([[EffectUse(effect, place, parameters)]])[0].angle


@pytest.mark.parametrize('motor', ['M', 'L'])
def test_what_hangs_on_a_motor_begins_where_the_motor_truly_is(free, motor):
    sound = free.states([[]])[0].angle
    moved = angles(free, 'encoder_offset', f'encoder_{motor}', angle=-0.02) - sound
    assert abs(moved[:, free.instrument.index(motor)] - 0.02).max() < 1e-6
    # a shift of the whole rig stretches nothing, at the beginning as later
    assert abs(moved - moved[-1]).max() < 1e-5


def test_a_weight_has_stretched_its_cables_before_the_recording_begins(free):
    at = free.instrument.index('3')
    hung = angles(free, 'gravity', 'pulley_3', torque=0.4, phase=np.pi / 2)
    sound = free.states([[]])[0].angle
    first = (hung - sound)[:10, at]
    assert abs(first).min() > 0.01
    assert np.ptp(first) < 0.05 * abs(first).max()


def test_friction_holds_nothing_where_it_never_was(free):
    rubs = EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.2})
    off = EffectUse('encoder_offset', 'encoder_L', {'angle': -0.02})
    [with_both], [with_friction] = free.states([[rubs, off]]), free.states([[rubs]])
    moved = with_both.angle - with_friction.angle
    bins = free.segments[0].time > SETTLING
    at = free.instrument.index('3')
    assert np.ptp(moved[bins, at]) < 1e-3


def test_what_plays_or_hangs_slack_goes_along_too(bench, sound_problem):
    [segment] = sound_problem.rollouts.segments
    loose = replace(bench, loops=tuple(replace(loop, pretension=0.0) for loop in bench.loops))
    tight, slack = (Beginning(one, segment) for one in (bench, loose))
    shift = replace(segment.motion, value=segment.motion.value + np.array([[0.01], [0.0]]))
    for begun in (tight, slack):
        moved = begun.pose(shift)
        assert moved['2'] - segment.pose['2'] == pytest.approx(0.01, rel=1e-3)
        assert moved['3'] - segment.pose['3'] == pytest.approx(0.0, abs=1e-5)


GEARED = """
pulleys:
  rotor: {inertia: 0.015 kg*m^2, damping: 0.08 N*m*s/rad}
  arm: {inertia: 0.02 kg*m^2, damping: 0.005 N*m*s/rad}
couplings:
  gear: {route: {rotor: 1, arm: -1}, stiffness: 60 N*m/rad, damping: 0.05 N*m*s/rad}
motors:
  rotor:
    controller: {kp: 30 N*m/rad, kd: 0.7 N*m*s/rad, limit: 5 N*m}
    encoder: {counts: 200000}
    torque_sensor: {noise: 15 mN*m}
joint_sensors:
  arm: {counts: 200000}
control: {rate: 1 kHz}
"""


@pytest.mark.parametrize(('play', 'lies'), [(0.06, True), (0.01, False), (0.0, False)])
def test_what_lies_within_a_play_begins_where_it_is_read(tmp_path, measured_on, play, lies):
    """Wherever a weight would come to rest; an arm that hangs free swings there for seconds."""
    path = tmp_path / 'geared.yaml'
    path.write_text(GEARED, encoding='utf-8')
    rig = load_instrument(path)
    rollouts = prepared([measured_on(rig)], rig).problem.rollouts
    [segment] = rollouts.segments
    read = tuple(
        replace(m, value=m.value + 0.02) if m.sensor.of == 'arm' else m for m in segment.measured
    )
    weight = EffectUse('gravity', 'pulley_arm', {'torque': 1.2, 'phase': -0.01})
    loose = EffectUse('backlash', 'coupling_gear', {'angle': play})
    moved = rollouts.like([replace(segment, measured=read)])
    [rows] = moved.states([[weight, loose]])
    [first] = [m.value[0] for m in read if m.sensor.of == 'arm']
    assert (abs(rows.angle[0, rig.index('arm')] - first) < 1e-3) == lies
    # an encoder that reads past the truth is seen through
    past = EffectUse('encoder_offset', 'encoder_arm', {'angle': 0.005})
    [rows] = moved.states([[weight, loose, past]])
    assert (abs(rows.angle[0, rig.index('arm')] - first + 0.005) < 1e-3) == lies


@pytest.fixture(scope='module')
def softly(tmp_path_factory, measured_on):
    """Return an arm behind a soft gear, which swings for seconds, and a recording of it."""
    path = tmp_path_factory.mktemp('soft') / 'soft.yaml'
    path.write_text(GEARED.replace('60 N*m/rad', '8 N*m/rad').replace('0.05 N*m', '0.005 N*m'))
    rig = load_instrument(path)
    return rig, measured_on(rig, settings=(('duration', '8 s'), ('amplitude', '20 deg')))


def cut(run, start, stop=math.inf):
    """Return a part of a recording."""
    return run.with_channels(
        [
            replace(c, time=c.time[own], value=c.value[own])
            for c in run.channels.values()
            for own in [(c.time >= start) & (c.time < stop)]
        ]
    )


def test_a_recording_that_begins_on_the_way_begins_as_it_is_read(softly):
    rig, run = softly
    problem = prepared([cut(run, 2.3)], rig).problem
    [segment] = problem.rollouts.segments
    begun = Beginning(rig, segment).loose(Numbers(rig), segment.motion)
    arm = run['pulley/pulley_arm/position']
    at = segment.start + segment.time[0]
    speed = np.interp(at, arm.time[50:-50], np.gradient(arm.value, arm.time)[50:-50])
    assert begun['arm'] == (
        pytest.approx(np.interp(at, arm.time, arm.value), abs=2e-3),
        pytest.approx(speed, rel=0.2, abs=0.05),
    )
    # a motor that rested once so near the beginning has begun there
    begins = (np.arange(len(segment.time)) == 0,)
    unknown = problem.rollouts.like([replace(segment, still=begins)])
    [read], [at_rest] = problem.rollouts.predicted([[]]), unknown.predicted([[]])
    row = [m.sensor.of for m in segment.measured].index('arm')
    off, swings = (np.std(segment.measured[row].value - x[row]) for x in (read, at_rest))
    assert off < 0.03 * swings


def test_a_recording_that_begins_at_rest_begins_there(softly):
    rig, run = softly
    [segment] = prepared([run], rig).problem.rollouts.segments
    assert Beginning(rig, segment).loose(Numbers(rig), segment.motion) == {}


@pytest.mark.parametrize('creep', [0.0, 0.02])
def test_what_swings_farther_than_motors_take_it_begins_as_it_is_read(softly, creep):
    rig, run = softly
    held = run['actuator/pulley_rotor/position']
    arm = run['pulley/pulley_arm/position']
    swing = 0.03 * np.cos(9.0 * arm.time + 0.7)
    still = run.with_channels([replace(held, value=creep * held.time), replace(arm, value=swing)])
    [segment] = prepared([still], rig).problem.rollouts.segments
    begun = Beginning(rig, segment).loose(Numbers(rig), segment.motion)
    at = segment.start + segment.time[0]
    assert begun['arm'][0] == pytest.approx(0.03 * np.cos(9.0 * at + 0.7), abs=1e-3)
    assert begun['arm'][1] == pytest.approx(-0.27 * np.sin(9.0 * at + 0.7), rel=0.1)


def test_a_model_that_torques_drive_comes_to_no_rest(measured_on):
    body = load_instrument('single_body')
    [along] = prepared([measured_on(body)], body).problem.rollouts.segments
    assert Beginning(body, along).resting > 0.0
    driven = replace(along, prescribed=(), pushed=along.prescribed)
    assert Beginning(body, driven).resting == 0.0
