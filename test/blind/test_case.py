"""Cases: drawn from seed and index alone, written as bags, labels apart."""

import json

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.blind import columns as k
from tendon_ros.blind.bench import nominal, nominal_rig
from tendon_ros.blind.case import _misjudge, disturbed, made, PATTERN, PLAIN, Settings, WEAK
from tendon_ros.blind.faults import chosen
from tendon_ros.blind.laws import MERGING
from tendon_ros.blind.setup import Setup
from tendon_ros.blind.store import make, read_case, read_json, seed_kind
from tendon_ros.model.instrument_file import load_instrument

#: an index of each stratum
INDEX = {stratum: PATTERN.index(stratum) for stratum in PATTERN}


def test_a_case_depends_on_seed_and_index_alone(case):
    one, again, other = case(7, 3), made(7, 3), made(8, 3)
    assert one.label == again.label
    for kind, recording in one.recordings.items():
        for name, channel in recording.channels.items():
            np.testing.assert_array_equal(channel.value, again.recordings[kind][name].value)
    assert other.label != one.label


@pytest.mark.parametrize('stratum', INDEX)
def test_a_stratum_is_what_it_says(stratum, case):
    one = case(7, INDEX[stratum])
    effects = one.label['effects']
    count = {'none': (0,), 'two_three': (2, 3)}.get(stratum, (1,))
    assert len(effects) in count
    low, high = WEAK if stratum == 'weak' else PLAIN
    assert all(low <= e['gap_over_floor'] <= high for e in effects)
    unknown = [e['effect'].startswith('unknown_') for e in effects]
    assert all(unknown) if stratum == 'unknown' else not any(unknown)
    assert bool(one.withhold) == (stratum == 'withheld')
    if one.withhold:
        assert effects[0]['effect'] in one.withhold


@pytest.mark.parametrize('channels', ['motor', 'force', 'joint'])
def test_channels_that_are_not_there_are_absent(channels, case):
    one = case(7, 0, strata=('none',), channels=(channels,))
    names = {name for r in one.recordings.values() for name in r.channels}
    assert ('load_cell/force' in names) == (channels != 'motor')
    assert ('pulley/pulley_1/position' in names) == (channels == 'joint')
    assert 'actuator/pulley_M/effort' in names
    assert 'load_cell/force' not in one.recordings['free']


def test_an_axis_has_motor_signals_alone():
    one = made(7, 1, Settings(bench='axis'))
    assert one.label['stratum'] == 'none'
    assert list(one.recordings) == ['fast', 'slow', 'steps']
    for recording in one.recordings.values():
        assert {name.split('/')[0] for name in recording.channels} == {'actuator', 'setpoint'}
        assert {name.split('/')[1] for name in recording.channels} == {'pulley_M'}


def test_an_arm_is_seen_as_a_bus_leaves_it():
    one = made(7, 1, Settings(bench='arm'))
    assert [use.effect for use in one.instrument.effects] == ['gravity']
    for recording in one.recordings.values():
        angle = recording['actuator/pulley_M/position']
        steps = np.diff(angle.time)
        assert np.median(steps) == pytest.approx(0.01)
        assert np.std(steps) > 0.0
        assert steps.max() > 0.015  # a row is lost now and then
        counts = angle.value / (np.pi / 2048)
        np.testing.assert_allclose(counts, np.round(counts), atol=1e-9)


def test_what_a_file_knows_well_is_as_far_off_as_it_says():
    instrument, rng = nominal('arm'), np.random.default_rng(0)
    rigs = [nominal_rig('arm') for _ in range(400)]
    for rig in rigs:
        _misjudge(rig, instrument, rng)
    weight = np.log([rig.pulleys[0, k.WEIGHT] for rig in rigs])
    assert weight.std() == pytest.approx(0.05, rel=0.15)
    assert np.std([rig.pulleys[0, k.WEIGHT_PHASE] for rig in rigs]) == pytest.approx(
        np.deg2rad(1.0), rel=0.15
    )
    gain = np.array([rig.motors[0, k.GAIN] for rig in rigs])
    assert gain.min() < 0.55
    assert gain.max() > 1.8
    assert {rig.motors[1, k.GAIN] for rig in rigs} == {1.0}


def test_the_body_of_an_axis_is_not_as_guessed(monkeypatch):
    def torque():
        one = made(7, 1, Settings(bench='axis'))
        return one.recordings['fast']['actuator/pulley_M/effort'].value

    other = torque()
    monkeypatch.setattr('tendon_ros.blind.case._GUESS', 1.0)
    guessed = torque()
    assert np.std(other - guessed) > 0.1 * np.std(guessed)


def test_what_is_one_on_one_body_is_not_drawn_together():
    setup, rng = Setup('axis', 'motor'), np.random.default_rng(0)
    drawn = [{f.effect for f in chosen('two_three', setup, rng)} for _ in range(300)]
    assert any('torque_bias' in effects for effects in drawn)
    assert not any(pair <= effects for effects in drawn for pair in MERGING)


def test_channel_sets_and_strata_meet():
    places = len(PATTERN)
    settings = Settings()
    seen = set()
    for index in range(3 * places):
        turn = index % places + index // places
        seen.add((PATTERN[index % places], settings.channels[turn % 3]))
    assert len(seen) == 3 * len(set(PATTERN))


def test_nuisance_is_as_large_as_it_says():
    base, rng = nominal_rig('bench'), np.random.default_rng(0)
    rigs = [disturbed(base, 0.01, rng) for _ in range(400)]
    stiffness = np.array([rig.loops[:, k.STIFFNESS] for rig in rigs])
    damping = np.array([rig.pulleys[:, k.DAMPING] / base.pulleys[:, k.DAMPING] for rig in rigs])
    assert stiffness.std() == pytest.approx(0.01, rel=0.1)
    assert damping.std() == pytest.approx(0.03, rel=0.1)
    assert base.loops[0, k.STIFFNESS] == 1.0


def test_the_noise_is_the_instruments(case):
    one = case(7, 0, strata=('none',), channels=('force',), nuisance=0.0)
    force = one.recordings['contact']['load_cell/force'].value[:400]
    assert force.std() == pytest.approx(0.05, rel=0.15)
    torque = one.recordings['contact']['actuator/pulley_L/effort'].value[:400]
    assert torque.std() == pytest.approx(0.01 * np.hypot(1.0, 0.5), rel=0.2)


def test_a_bag_holds_what_the_case_holds_and_no_label(case, tmp_path):
    make(tmp_path, 7, 2, Settings(bench='other'))
    one = case(7, 0, bench='other')
    for recording in read_case(tmp_path, 'case_0000'):
        truth = one.recordings[recording.name]
        assert set(recording.channels) == set(truth.channels)
        assert recording.epoch_ns == truth.epoch_ns
        assert not recording.warnings
        for name, channel in recording.channels.items():
            np.testing.assert_array_equal(channel.time, truth[name].time)
            np.testing.assert_array_equal(channel.value, truth[name].value)
    assert read_json(tmp_path / 'labels' / 'case_0000.json')['effects'] == json.loads(
        json.dumps(one.label['effects'])
    )
    effect = one.label['effects'][0]['effect'].encode()
    for path in (tmp_path / 'cases').rglob('*'):
        if path.is_file():
            assert effect not in path.read_bytes()
    assert load_instrument(tmp_path / 'instrument.yaml') == one.instrument


def test_an_interrupted_make_goes_on_and_does_not_mix(tmp_path):
    settings = Settings(strata=('none',))
    make(tmp_path, 7, 1, settings)
    before = (tmp_path / 'labels' / 'case_0000.json').stat().st_mtime_ns
    done = []
    make(tmp_path, 7, 2, settings, progress=done.append)
    assert (tmp_path / 'labels' / 'case_0000.json').stat().st_mtime_ns == before
    assert done == [1.0]
    with pytest.raises(RecordingError, match='another seed'):
        make(tmp_path, 8, 1, settings)


def test_seeds_for_publishing_begin_at_a_thousand():
    assert [seed_kind(seed) for seed in (0, 999, 1000)] == ['development'] * 2 + ['published']
