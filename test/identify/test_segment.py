"""Segments: bins of one length from channels of any rate, each value where its stamps are."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.identify.binning import bin_length
from tendon_ros.identify.motion import reading_error
from tendon_ros.identify.segment import loaded, segment_of
from tendon_ros.identify.true_motion import true_motion
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.laws import modified

ANGLE, TORQUE = 'actuator/pulley_body/position', 'actuator/pulley_body/effort'


@pytest.fixture(scope='module')
def body():
    return load_instrument('single_body')


def ramps(time, torque_time=None):
    """Return a recording in which angle and torque are known functions of time."""
    torque_time = time if torque_time is None else torque_time
    angle = Channel(ANGLE, time, 0.3 * np.sin(2.0 * time))
    torque = Channel(TORQUE, torque_time, 0.1 * torque_time)
    return Recording('ramps', {ANGLE: angle, TORQUE: torque})


def binned(body, run):
    period = bin_length([run], body)
    segment = segment_of(body, run, period)
    [torque] = segment.measured
    return segment, torque


@pytest.mark.parametrize(
    ('rate', 'wanted'), [(50.0, 0.02), (500.0, 0.008), (1000.0, 0.008), (10_000.0, 0.008)]
)
def test_any_rate(body, rate, wanted):
    time = np.arange(0.0, 4.0, 1.0 / rate)
    segment, torque = binned(body, ramps(time))
    assert segment.period == pytest.approx(wanted)
    known = np.isfinite(torque.value)
    assert known.mean() > 0.99
    middle = segment.start + segment.time
    assert torque.value[known] == pytest.approx(0.1 * middle[known], abs=1e-6)
    motion = segment.motion.value[0]
    assert motion == pytest.approx(0.3 * np.sin(2.0 * middle), abs=1e-3)


def test_what_shakes_is_seen_alike_by_encoder_and_torque(body):
    # four samples to a period: half a sample between the two would be an eighth of a period
    time = np.arange(0.0, 4.0, 0.002)
    shakes = np.sin(2.0 * np.pi * 120.0 * time)
    run = Recording(
        's', {ANGLE: Channel(ANGLE, time, shakes), TORQUE: Channel(TORQUE, time, shakes)}
    )
    segment = segment_of(body, run, 0.002)
    [torque] = segment.measured
    inner = slice(50, -50)
    # but for what the counts make a smoother take off
    assert torque.value[inner] == pytest.approx(segment.motion.value[0][inner], abs=0.1)


def test_hours_of_data_are_seen_more_coarsely(body):
    time = np.arange(0.0, 1000.0, 0.01)
    assert bin_length([ramps(time)], body) == pytest.approx(0.12)


def test_stamps_that_are_not_in_the_middle_are_corrected(body):
    time = np.arange(0.0, 4.0, 0.002)
    # the torque comes every 8 ms, always late in its bin
    segment, torque = binned(body, ramps(time, np.arange(0.0071, 3.99, 0.008)))
    middle = segment.start + segment.time
    inner = np.isfinite(torque.value) & (middle > 0.02) & (middle < 3.97)
    assert torque.value[inner] == pytest.approx(0.1 * middle[inner], abs=1e-6)


def test_jitter_does_not_become_noise(body):
    rng = np.random.default_rng(5)
    time = np.arange(0.0, 4.0, 0.002)
    shaken = time + rng.uniform(-0.0009, 0.0009, len(time))
    segment, torque = binned(body, ramps(shaken, shaken))
    known = np.isfinite(torque.value)
    inner = slice(5, -5)
    middle = segment.start + segment.time
    assert torque.value[known][inner] == pytest.approx(0.1 * middle[known][inner], abs=2e-5)


def test_a_channel_that_pauses_is_unknown_there(body):
    time = np.arange(0.0, 4.0, 0.002)
    paused = time[(time < 1.0) | (time > 1.5)]
    segment, torque = binned(body, ramps(time, paused))
    inside = (segment.time > 1.01) & (segment.time < 1.49)
    assert np.isnan(torque.value[inside]).all()
    assert np.isfinite(torque.value[segment.time < 0.99]).all()


def test_means_are_less_noisy_than_samples(body):
    slow = binned(body, ramps(np.arange(0.0, 4.0, 0.008)))[1]
    fast = binned(body, ramps(np.arange(0.0, 4.0, 0.0005)))[1]
    # a single reading is shared by two bins, which have half of two each
    assert fast.floor == pytest.approx(np.sqrt(2.0) * slow.floor / 4.0, rel=0.05)


def test_without_an_encoder_the_torque_drives_the_model(body):
    blind = replace(body, sensors=tuple(s for s in body.sensors if s.kind != 'angle'))
    segment = segment_of(blind, ramps(np.arange(0.0, 4.0, 0.002)), 0.008)
    assert segment.prescribed == ()
    assert segment.pushed == ('body',)
    assert segment.measured == ()


def test_without_encoder_and_torque_nothing_drives_the_model(body):
    with pytest.raises(RecordingError, match='neither encoder nor torque_sensor'):
        bin_length([ramps(np.arange(0.0, 4.0, 0.002))], replace(body, sensors=()))


def test_the_error_of_a_reading_is_found_where_the_file_is_silent(body):
    [sensor] = [s for s in body.sensors if s.channel == ANGLE]
    count = 1e-3
    time = np.arange(0.0, 4.0, 0.002)
    channel = Channel(ANGLE, time, count * np.round(np.sin(time) / count))
    silent = replace(sensor, resolution=0.0, noise=0.0)
    assert reading_error(channel, silent).still == pytest.approx(count / np.sqrt(12.0), rel=1e-3)
    own = sensor.resolution
    counted = Channel(ANGLE, time, own * np.round(np.sin(time) / own))
    assert reading_error(counted, sensor).still == pytest.approx(own / np.sqrt(12.0))


def test_a_measured_load_turns_into_a_torque_on_its_pulley(bench, sound_run):
    cell = sound_run['load_cell/force']
    pressed = sound_run.with_channels([Channel(cell.name, cell.time, 0.0 * cell.value + 2.0)])
    segment = segment_of(bench, pressed, bin_length([pressed], bench))
    pushed = loaded(bench, pressed, segment)
    assert pushed.pushed == ('2',)
    assert pushed.contacts == ()
    # the instrument pushes with 2 N at 50 mm, so the tip is pushed back
    assert pushed.motion.value[-1] == pytest.approx(-0.1, abs=1e-6)
    assert 'load_cell/force' not in {m.sensor.channel for m in pushed.measured}


def test_a_load_that_pushes_is_what_the_cell_read_less_its_faults(bench, sound_run):
    cell = sound_run['load_cell/force']
    pressed = sound_run.with_channels([Channel(cell.name, cell.time, 0.0 * cell.value + 2.0)])
    segment = segment_of(bench, pressed, bin_length([pressed], bench))
    pushed = loaded(bench, pressed, segment)
    effects = [
        EffectUse('load_cell_gain', 'load_cell', {'gain': 1.25}),
        EffectUse('load_cell_bias', 'load_cell', {'force': -0.5}),
    ]
    driven = true_motion(bench, modified(bench, effects), pushed)
    assert driven.value[-1] == pytest.approx(-0.05 * (2.0 + 0.5) / 1.25, abs=1e-6)
    np.testing.assert_array_equal(driven.value[:-1], pushed.motion.value[:-1])


def test_without_a_load_nothing_pushes(bench, sound_run):
    bare = replace(
        sound_run, channels={n: c for n, c in sound_run.channels.items() if 'load' not in n}
    )
    segment = segment_of(bench, bare, bin_length([bare], bench))
    assert loaded(bench, bare, segment) is None
