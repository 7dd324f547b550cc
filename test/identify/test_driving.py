"""What drives the model: motion where there is an encoder, torque where there is none."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.intake.commands import lines
from tendon_ros.identify.binning import bin_length
from tendon_ros.identify.driving import (
    as_recorded,
    drives,
    encoder_channels,
    motor_channels,
    with_encoders,
)
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import segment_of
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument

TORQUE = 'actuator/pulley_{}/effort'
SPEED = 'pulley/pulley_roller/velocity'


@pytest.fixture(scope='module')
def belt():
    """Return a belt whose motors had no encoder that was recorded."""
    recorded = {SPEED, TORQUE.format('left'), TORQUE.format('right')}
    return as_recorded(load_instrument('belt_by_voltage'), recorded)


def pushed(belt, left=0.02, right=0.02, seconds=4.0):
    """Return a recording of constant torques."""
    time = np.arange(0.0, seconds, 0.02)
    channels = [
        Channel(TORQUE.format('left'), time, np.full(len(time), left)),
        Channel(TORQUE.format('right'), time, np.full(len(time), right)),
        Channel(SPEED, time, np.zeros(len(time))),
    ]
    return Recording(name='pushed', channels={c.name: c for c in channels})


def test_an_encoder_comes_before_a_torque(bench):
    assert [d.by_torque for d in drives(bench)] == [False, False]
    assert motor_channels(bench) == encoder_channels(bench)


def test_what_was_not_recorded_does_not_drive(belt):
    assert [d.by_torque for d in drives(belt)] == [True, True]
    assert motor_channels(belt) == (TORQUE.format('left'), TORQUE.format('right'))
    assert encoder_channels(belt) == ()


def test_what_was_recorded_stays(bench):
    assert as_recorded(bench, motor_channels(bench)) == bench


def test_encoders_that_nobody_recorded_come_back_to_control_an_experiment(bench):
    torques = [s.channel for s in bench.sensors if s.kind == 'motor_torque']
    recorded = as_recorded(bench, torques)
    assert [d.by_torque for d in drives(recorded)] == [True, True]
    found_out = replace(recorded.sensors[0], noise=1.0)
    known = replace(recorded, sensors=(found_out, *recorded.sensors[1:]))
    rig = with_encoders(known, bench)
    assert [s.name for s in rig.sensors] == [s.name for s in bench.sensors]
    assert found_out in rig.sensors


def test_without_either_nothing_drives(bench):
    with pytest.raises(RecordingError, match='motor M has neither encoder nor torque_sensor'):
        drives(replace(bench, sensors=()))


def test_torque_turns_the_belt_until_damping_takes_all_of_it(belt):
    segment = segment_of(belt, pushed(belt), 0.02)
    assert segment.prescribed == ()
    assert segment.pushed == ('left', 'right')
    [[speed]] = Rollouts(belt, [segment]).predicted([[]])
    damping = sum(p.damping for p in belt.pulleys)
    assert abs(speed[-1]) == pytest.approx(0.04 / damping, rel=0.01)


def test_gain_and_limit_are_those_of_the_motor(belt):
    segment = segment_of(belt, pushed(belt), 0.02)
    rollouts = Rollouts(belt, [segment])
    [[plain]] = rollouts.predicted([[]])
    gains = [EffectUse('torque_gain', f'motor_{m}', {'gain': 0.5}) for m in ('left', 'right')]
    [[half]] = rollouts.predicted([gains])
    assert half[-1] == pytest.approx(0.5 * plain[-1], rel=1e-3)
    limits = [
        EffectUse('torque_saturation', f'motor_{m}', {'limit': 0.005}) for m in ('left', 'right')
    ]
    [[quarter]] = rollouts.predicted([limits])
    assert quarter[-1] == pytest.approx(0.25 * plain[-1], rel=1e-3)


@pytest.mark.parametrize(
    ('sampling', 'tick', 'steps', 'early'),
    [
        (0.02, 0.001, True, 0.0),
        (0.02, 0.001, False, 0.01),
        # as seldom as it is set
        (0.02, 0.02, False, 0.0),
        (0.005, 0.005, True, 0.0),
        (0.005, 0.005, False, 0.0025),
    ],
)
def test_a_command_holds_until_the_next(belt, sampling, tick, steps, early):
    """One that is set seldom or by steps: as a line, a step begins half a sample too soon."""
    belt = replace(belt, control_period=tick)
    time = sampling * np.arange(round(4.0 / sampling))
    level = np.where((time // 0.5) % 2, 0.3, -0.2)
    own = level if steps else level + 1e-6 * np.arange(len(time))
    channels = {
        s.channel: Channel(s.channel, time, own if s.kind == 'motor_torque' else 0.0 * own)
        for s in belt.sensors
    }
    run = Recording('belt', channels)
    segment = segment_of(belt, run, sampling)
    assert bool(lines([run], belt)) == (not steps and sampling > 0.01 > tick)
    row = segment.motion.value[len(segment.prescribed)]
    when = segment.start + segment.time
    near = np.abs(when - 0.5) < 0.09
    rise = float(np.interp(0.05, row[near], when[near]))
    assert rise == pytest.approx(0.5 - early, abs=1e-3)


def test_where_torques_come_seldom_bins_are_finer_and_readings_in_their_middles(belt):
    time = 0.02 * np.arange(200)
    value = np.sin(time)
    channels = {s.channel: Channel(s.channel, time, value) for s in belt.sensors}
    run = Recording('belt', channels)
    assert bin_length([run], belt) == pytest.approx(0.004)
    segment = segment_of(belt, run, 0.004)
    read = np.isfinite(segment.measured[0].value)
    assert read.sum() == len(time) - 1
    assert (segment.start + segment.time)[read] == pytest.approx(time[:-1])
    assert segment.measured[0].value[read] == pytest.approx(value[:-1])
    assert segment.spacing == pytest.approx(0.02)
    # hours of it are seen as coarsely as ever
    long = 0.02 * np.arange(30_000)
    hours = {s.channel: Channel(s.channel, long, np.sin(long)) for s in belt.sensors}
    assert bin_length([Recording('belt', hours)], belt) == pytest.approx(0.02)
