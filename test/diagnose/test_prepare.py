"""Preparation: noise, bins, and what no fit may see."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.prepare import held_out, prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.smoothing import smoothed
from tendon_ros.model.instrument_file import load_instrument


def test_noise_is_found_and_counts_are_part_of_it(bench, free):
    [segment] = prepared([free], bench).whole.rollouts.segments
    torque = next(m for m in segment.measured if m.sensor.channel == 'actuator/pulley_M/effort')
    # 10 mN m at 500 Hz, four samples a bin
    assert np.median(torque.noise) > 0.9 * 0.005
    assert np.median(torque.noise) < 2.0 * 0.005
    louder = Channel(
        torque.sensor.channel,
        free[torque.sensor.channel].time,
        free[torque.sensor.channel].value
        + np.random.default_rng(2).normal(0.0, 0.04, len(free[torque.sensor.channel].time)),
    )
    [other] = prepared([free.with_channels([louder])], bench).whole.rollouts.segments
    again = next(m for m in other.measured if m.sensor.channel == torque.sensor.channel)
    assert np.median(again.noise) == pytest.approx(0.02, rel=0.25)


def test_a_gap_is_no_noise_once_its_cause_is_known(bench, free, scaled):
    name = 'actuator/pulley_L/effort'

    def level(ready):
        [segment] = ready.whole.rollouts.segments
        return np.median(next(m for m in segment.measured if m.sensor.channel == name).noise)

    sound = level(prepared([free], bench))
    off = prepared(scaled([free], name, 1.25), bench)
    assert level(off) > 1.5 * sound
    cause = Candidate('torque_gain', 'motor_L')
    assert level(off.heard_again(off.whole.empty.joined(cause, {'gain': 0.8}))) < 1.3 * sound


def test_counts_make_as_much_less_of_a_torque_as_the_motor_gives(measured_on):
    body = load_instrument('single_body')
    ready = prepared([measured_on(body)], body)
    half = ready.whole.empty.joined(Candidate('inertia', 'pulley_body'), {'scale': 0.5})

    # what damps makes something of them, too
    def of_counts(noise):
        [[torque, *_]] = noise.counts
        return np.median(torque)

    assert of_counts(ready.heard_again(half).noise) == pytest.approx(
        0.5 * of_counts(ready.noise), rel=0.2
    )


def test_a_jump_of_some_counts_is_noise_and_rest_is_no_quieter(measured_on):
    # slow at first, and within a tenth of a second 50 counts: who knows with what acceleration
    name = 'actuator/pulley_body/position'
    body = load_instrument('single_body')
    [count] = [s.resolution for s in body.sensors if s.channel == name]
    run = measured_on(body)
    time = run[name].time
    counts = 100.0 * np.clip((time - 1.0) / 4.0, 0.0, 1.0) ** 2
    counts += 50.0 * np.clip((time - 3.0) / 0.1, 0.0, 1.0)
    # what counts make of the inertia's torque is small against such torques: bins stay short
    torque = run['actuator/pulley_body/effort']
    run = run.with_channels(
        [
            replace(run[name], value=count * np.round(counts)),
            replace(torque, value=100.0 * torque.value),
        ]
    )
    ready = prepared([run], body)
    [segment] = ready.whole.rollouts.segments
    [[counted]] = ready.noise.counts

    def about(level, when):
        return float(np.median(level[np.abs(segment.time - when) < 0.1]))

    assert about(counted, 3.0) > 1.7 * about(counted, 2.0)
    assert about(counted, 5.8) < 0.1 * about(counted, 2.0)
    noise = segment.measured[0].noise
    assert about(noise, 5.8) >= 0.99 * float(np.median(counted[~segment.still[0]]))


def test_no_fit_sees_what_is_held_out(bench, pressed, free):
    ready = prepared([pressed, free], bench)
    for fitted, held, whole in zip(
        ready.problem.masks, ready.held.masks, ready.whole.masks, strict=True
    ):
        assert not (fitted & held).any()
        assert np.array_equal(fitted | held, whole)
        assert 0.1 < held.sum() / whole.sum() < 0.4


def test_of_the_shortest_recording_something_is_held_out(bench, free):
    [segment] = prepared([free], bench).whole.rollouts.segments
    brief = replace(segment, time=np.linspace(0.0, 1.2, len(segment.time)))
    [held] = held_out([brief])
    assert 0.1 < held.mean() < 0.4


def test_of_many_recordings_whole_ones_are_held_out(bench, free):
    [segment] = prepared([free], bench).whole.rollouts.segments
    masks = held_out([segment] * 8)
    assert [bool(m.all()) for m in masks].count(True) == 2
    assert all(m.all() or not m.any() for m in masks)


def test_of_more_than_fits_need_those_that_differ_most_are_fitted(bench, free):
    [segment] = prepared([free], bench).whole.rollouts.segments
    minute = replace(segment, time=10.0 * segment.time)

    def faster(times):
        motion = replace(minute.motion, slope=times * minute.motion.slope)
        return replace(minute, motion=motion)

    # twelve alike, three that are faster, one without most of its channels
    segments = [faster(times) for times in (*[1.0] * 6, 3.0, *[1.0] * 6, 5.0, 8.0)]
    bare = replace(minute, measured=minute.measured[:1])
    fitted = [n for n, m in enumerate(held_out([*segments, bare])) if not m.any()]
    assert len(fitted) == 3
    assert {14, 15} < set(fitted)
    assert fitted != [n for n, m in enumerate(held_out([*segments, bare], 2)) if not m.any()]


def test_encoders_at_ten_kilohertz_are_read_a_thousand_times_a_second(bench, free, monkeypatch):
    def often(channel, rate):
        time = np.arange(channel.time[0], channel.time[-1], 1.0 / rate)
        return Channel(channel.name, time, channel.at(time))

    seen = []

    def noted(value, *args):
        seen.append(len(value))
        return smoothed(value, *args)

    monkeypatch.setattr('tendon_ros.identify.motion.smoothed', noted)
    found = {}
    for rate in (1e3, 1e4):
        channels = {n: often(c, rate) for n, c in free.channels.items()}
        ready = prepared([replace(free, channels=channels)], bench)
        [segment] = ready.whole.rollouts.segments
        found[rate] = segment.motion.value
    assert max(seen) <= 1.01e3 * (free.end - free.start)
    assert found[1e4] == pytest.approx(found[1e3], abs=1e-5)


def test_channels_weigh_by_what_a_model_leaves_of_them(bench, free):
    ready = prepared([free], bench)
    plain = ready.problem
    wrong = plain.empty.joined(Candidate('coulomb_friction', 'pulley_M'), {'torque': 0.3})
    weighed = ready.weighed(wrong)
    assert weighed.problem.by_misfit
    assert not plain.by_misfit
    left, before = weighed.problem.left(wrong), plain.left(wrong)
    for channel, samples in plain.channels().items():
        # what was off by noise alone weighs as it did
        squares = float(np.mean(before[samples] ** 2))
        assert np.mean(left[samples] ** 2) == pytest.approx(min(squares, 1.0), rel=0.1), channel
    # noise stays what it was, also where it is heard again
    for later in (weighed, weighed.heard_again(wrong)):
        assert later.problem.by_misfit
        for was, now in zip(
            ready.whole.rollouts.segments, later.whole.rollouts.segments, strict=True
        ):
            for a, b in zip(was.measured, now.measured, strict=True):
                assert np.median(b.noise) <= np.median(a.noise)
