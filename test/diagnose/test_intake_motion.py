"""Stamps and motion: gaps, clock jumps, what is too short or stands still."""

from dataclasses import replace
import re

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intake.breaks import breaks_of


def every_channel(recording, change):
    """Return a recording with another time and value in every channel."""
    return recording.with_channels(
        [Channel(n, *change(c.time, c.value)) for n, c in recording.channels.items()]
    )


def cut(low, high):
    def change(time, value):
        keep = (time < low) | (time > high)
        return time[keep], value[keep]

    return change


def test_too_short(bench, sound):
    brief = every_channel(sound[0], lambda t, v: (t[:200], v[:200]))
    intake = admitted([brief, sound[1]], bench)
    assert [r.name for r in intake.recordings] == ['free']
    assert 'contact: too short: the motors are measured together for 0.40 s' in intake.left_out[0]
    with pytest.raises(RecordingError, match=r'contact: too short.*; record at least 1 s'):
        admitted([brief], bench)


def test_too_slow(bench, sound):
    slow = every_channel(sound[0], lambda t, v: (1e3 * t, v))
    intake = admitted([slow, sound[1]], bench)
    assert [r.name for r in intake.recordings] == ['free']
    with pytest.raises(RecordingError, match=r'contact: too slow: .* every 2 s; .*unit of time'):
        admitted([slow], bench)


def test_without_motion(bench, sound):
    rest = every_channel(sound[0], lambda t, v: (t, np.full_like(v, v[0])))
    assert 'contact: without motion' in admitted([rest, sound[1]], bench).left_out[0]
    with pytest.raises(RecordingError, match=r'contact: without motion.*; move the motors'):
        admitted([rest], bench)


def test_a_short_gap_spoils_what_is_compared_around_it(bench, sound):
    gap = every_channel(sound[1], cut(3.0, 3.2))
    intake = admitted([sound[0], gap], bench)
    free = intake.recordings[1]
    assert np.array_equal(
        free['actuator/pulley_M/position'].time, gap['actuator/pulley_M/position'].time
    )
    for name in ('actuator/pulley_M/effort', 'pulley/pulley_3/position', 'load_cell/force'):
        assert not np.any((free[name].time > 2.96) & (free[name].time < 3.29))
    assert len(intake.left_out) == 1
    assert 'free: 1 gap in the motor positions' in intake.left_out[0]


def test_a_gap_elsewhere_is_simply_unmeasured(bench, sound, spoilt):
    runs = spoilt(sound, 'load_cell/force', cut(3.0, 4.0))
    assert admitted(runs, bench).left_out == ()


def test_a_long_gap_cuts_in_two(bench, sound):
    gap = every_channel(sound[1], cut(2.5, 3.5))
    intake = admitted([sound[0], gap], bench)
    assert [r.name for r in intake.recordings] == [
        'contact',
        'free [0.0-2.5 s]',
        'free [3.5-6.0 s]',
    ]
    assert 'has a gap of 1.004 s at 2.498 s; cut there' in intake.left_out[0]
    first, second = intake.recordings[1:]
    assert first.end <= 2.5 < 3.5 <= second.start + 0.01
    # what held when the second part began
    assert (
        second['setpoint/pulley_M/position'].time[0] <= second['actuator/pulley_M/effort'].time[0]
    )


def test_a_clock_that_jumps_forward_is_told_from_a_gap(bench, sound):
    jumped = every_channel(sound[1], lambda t, v: (np.where(t > 3.1, t + 60.0, t), v))
    intake = admitted([sound[0], jumped], bench)
    assert len(intake.recordings) == 3
    assert 'the clock of actuator/pulley_L/position jumps by 60' in intake.left_out[0] or (
        'the clock of actuator/pulley_M/position jumps by 60' in intake.left_out[0]
    )


def test_a_clock_that_jumped_back_leaves_a_leap(bench, sound):
    """The reader drops stamps that do not increase: motion is lost without a gap."""

    def lose(time, value):
        keep = (time < 2.0) | (time > 2.6)
        value, time = value[keep], time[keep]
        return np.where(time > 2.3, time - 0.6, time), value

    intake = admitted([sound[0], every_channel(sound[1], lose)], bench)
    assert len(intake.recordings) == 3
    assert 'leaps by' in intake.left_out[0]
    assert 'the clock jumped back' in intake.left_out[0]


def test_counts_that_are_lost_while_a_motor_turns_leave_a_leap(bench, sound):
    """A few times the steps around it, and another way than they go."""
    angle = sound[1]['actuator/pulley_M/position']
    steps = np.diff(angle.value)
    at = 1 + int(np.argmax(np.abs(steps)))
    lost = angle.value - 5.0 * steps[at - 1] * (np.arange(angle.value.size) > at)
    intake = admitted([sound[0], sound[1].with_channels([replace(angle, value=lost)])], bench)
    assert len(intake.recordings) == 3
    assert f'leaps by {4.0 * abs(steps[at]):.2g}'[:10] in intake.left_out[0]


def test_samples_that_are_lost_at_rest_leave_a_leap():
    """An axis that rested meanwhile went on, and rests again."""
    time = 1e-3 * np.arange(3000)
    angle = np.interp(time, [0.0, 1.0, 1.5, 3.0], [0.0, 0.0, 20.0, 20.0])
    lost = np.where(time > 2.0, 35.0, angle)
    (found,) = breaks_of(Channel('actuator/pulley_screw/position', time, lost))
    assert 'leaps by 15 rad between two samples at 2.000 s: the clock jumped back' in found.words


def test_a_servo_that_is_read_seldom_goes_from_rest_to_rest_within_a_sample():
    time = 0.1 * np.arange(200)
    angle = 0.3 * np.floor(time / 2.0) * (-1.0) ** np.floor(time / 2.0)
    assert breaks_of(Channel('actuator/pulley_arm/position', time, angle)) == []


def test_a_torque_may_leap():
    """A voltage that is all that drives a motor is set anew from one message to the next."""
    time = np.arange(0.0, 4.0, 0.02)
    torque = 0.01 * np.sin(7.0 * time) + np.where(time > 2.0, 0.5, 0.0)
    assert breaks_of(Channel('actuator/pulley_left/effort', time, torque)) == []
    assert len(breaks_of(Channel('actuator/pulley_left/position', time, torque))) == 1


def test_a_reading_that_begins_anew_each_turn_is_told_from_a_clock(bench, sound):
    def wrapped(time, value):
        return time, np.mod(value - np.median(value), 2.0 * np.pi)

    intake = admitted([sound[0], every_channel(sound[1], wrapped)], bench)
    assert 'begins anew: import it with wrap: 360 deg' in ' '.join(intake.left_out)


@pytest.mark.parametrize('rate', [50.0, 500.0])
def test_jitter_lost_samples_and_channels_of_their_own_clock_pass(bench, sound, rate):
    rng = np.random.default_rng(5)

    def shaken(time, value):
        own = np.arange(rng.uniform(0.0, 1e-3), time[-1], 1.0 / rate)
        own = own + rng.uniform(-0.3, 0.3, own.size) / rate
        own = own[(rng.random(own.size) > 0.03) & (own > 0.0)]
        return own, np.interp(own, time, value)

    intake = admitted([every_channel(r, shaken) for r in sound], bench)
    assert intake.left_out == ()
    assert all(
        r.channels.keys() == s.channels.keys()
        for r, s in zip(intake.recordings, sound, strict=True)
    )


def test_many_lost_samples_are_said(bench, sound):
    rng = np.random.default_rng(6)
    lost = every_channel(sound[1], lambda t, v: (t, v))
    keep = rng.random(lost['actuator/pulley_M/position'].time.size) > 0.2
    lost = every_channel(lost, lambda t, v: (t[keep], v[keep]))
    said = admitted([sound[0], lost], bench).left_out
    assert len(said) == 1
    assert re.search('lacks (19|20)% of its samples', said[0])


def test_a_channel_on_another_clock(bench, sound, spoilt):
    runs = spoilt(sound, 'load_cell/force', lambda t, v: (t + 1e4, v))
    intake = admitted(runs, bench)
    assert all('load_cell/force' not in r for r in intake.recordings)
    assert 'record all on one clock' in intake.left_out[0]


def test_a_dead_motor_encoder(bench, sound, spoilt):
    runs = spoilt(sound, 'actuator/pulley_M/position', lambda t, v: (t, np.zeros_like(v)))
    with pytest.raises(
        RecordingError, match='pulley_M/position is stuck at 0 rad while its set-p'
    ):
        admitted(runs, bench)


def test_a_motor_that_is_held_is_not_dead(bench, sound, spoilt):
    runs = spoilt(sound[:1], 'actuator/pulley_L/position', lambda t, v: (t, np.zeros_like(v)))
    assert admitted([runs[0], sound[1]], bench).left_out == ()


def test_beyond_the_limits(bench, sound, scaled):
    degrees = scaled(sound, 'actuator/pulley_M/position', 57.29578)
    with pytest.raises(
        RecordingError, match=r'beyond the position_limit.*in degrees it would fit'
    ):
        admitted(degrees, bench)
    narrow = replace(
        bench, motors=tuple(replace(m, position_limit=(-0.05, 0.05)) for m in bench.motors)
    )
    with pytest.raises(RecordingError, match='of motor M in bench_rig; give the file of this rig'):
        admitted(sound, narrow)


def test_a_loop_that_shakes_goes_beyond_the_limits(bench, sound, scaled):
    widest = max(np.abs(r['setpoint/pulley_M/position'].value).max() for r in sound)
    tight = replace(
        bench, motors=tuple(replace(m, position_limit=(-widest, widest)) for m in bench.motors)
    )
    shaking = scaled(sound, 'actuator/pulley_M/position', 1.6)
    assert not any('position_limit' in words for words in admitted(shaking, tight).left_out)
    asked = scaled(shaking, 'setpoint/pulley_M/position', 1.6)
    assert any('beyond the position_limit' in words for words in admitted(asked, tight).left_out)


def test_setpoints_that_contradict_the_motion_are_left_out(bench, sound, scaled):
    for factor, words in ((-1.0, 'one of the two has the wrong sign'), (57.29578, 'in degrees')):
        intake = admitted(scaled(sound, 'setpoint/pulley_M/position', factor), bench)
        assert all('setpoint/pulley_M/position' not in r for r in intake.recordings)
        assert len(intake.left_out) == 2
        assert all(words in sentence for sentence in intake.left_out)
