"""The watch: quiet on what is known, and a grown gap is seen within seconds, at its place."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.topics import place_of
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.watch import Watch, WatchSettings
from tendon_ros.diagnose.watch_stream import StampError
from tendon_ros.estimate.observer import Measurement
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.recorded import channel_values
from tendon_ros.model.simulation import Simulation
from tendon_ros.model.trajectory_choice import chosen_trajectory

EPOCH = 1_700_000_000 * 10**9
FRICTION = EffectUse('tension_friction', 'pulley_3', {'coefficient': 0.12})


@pytest.fixture(scope='module')
def rig():
    """Return the bench as its file describes it."""
    return load_instrument('bench_rig')


@pytest.fixture(scope='module')
def real(rig):
    """Return the bench as it is: no number of the file is quite right."""
    off = {
        ('inertia', 'pulley_2'): 1.01,
        ('inertia', 'pulley_3'): 0.99,
        ('cable_stiffness', 'cable_L3'): 1.01,
        ('cable_stiffness', 'cable_m1'): 0.99,
        ('pretension', 'cable_12'): 1.01,
    }
    uses = tuple(EffectUse(e, p, {'scale': v}) for (e, p), v in off.items())
    return replace(rig, effects=uses)


def simulated(rig, seconds, changes=(), motion=None, seed=1):
    """Return a recording of the bench on which effects are changed while it runs."""
    simulation = Simulation(rig, seed=seed)
    period = rig.control_period
    if motion is None:
        settings = {'duration': f'{seconds} s', 'amplitude': '5 deg'}
        motion = chosen_trajectory('multisine', rig.motor_names, settings).sample(period)
    every = round(0.005 / period)
    changes = dict(changes)
    stamps, columns = [], {}
    for second in range(seconds):
        if second in changes:
            simulation.use_effects((*rig.effects, *changes[second]))
        wished = motion[round(second / period) :][: round(1.0 / period)]
        rows = simulation.run(wished, every)
        stamps.append(rows.time)
        for name, column in channel_values(rows, wished[::every]).items():
            columns.setdefault(name, []).append(column)
    time = np.concatenate(stamps)
    channels = {n: Channel(n, time, np.concatenate(c)) for n, c in columns.items()}
    return Recording('live', channels, epoch_ns=EPOCH)


def topics_of(recording):
    """Yield what each topic says of each instant, in the order of the stamps."""
    topics = {}
    for channel in recording.channels.values():
        topics.setdefault(place_of(channel.name)[0], []).append(channel)
    rows = []
    for own in topics.values():
        stamps = np.round(own[0].time * 1e9).astype(int) + recording.epoch_ns
        values = np.array([c.value for c in own]).T.tolist()
        names = [c.name for c in own]
        rows += [
            Measurement(s, dict(zip(names, row, strict=True)))
            for s, row in zip(stamps.tolist(), values, strict=True)
        ]
    return sorted(rows, key=lambda m: m.stamp_ns)


def reports_of(watch, recording, every=1):
    """Return the reports of a watch by the end of their windows [s]."""
    reports = {}
    for n, measurement in enumerate(topics_of(recording)):
        watch.update(measurement)
        if n % every == 0 and watch.due:
            report = watch.look()
            reports[round((report.end_ns - EPOCH) * 1e-9, 3)] = report
    return reports


def only(recording, *starts):
    kept = {n: c for n, c in recording.channels.items() if n.startswith(starts)}
    return replace(recording, channels=kept)


@pytest.fixture(scope='module')
def changing(real):
    """Return a recording: friction comes at 17 s and goes at 25 s."""
    return simulated(real, 36, {17: [FRICTION], 25: []})


def test_what_was_learnt_is_no_gap(rig, real):
    reports = reports_of(Watch(rig), simulated(real, 26))
    assert [t for t, r in reports.items() if r.grown] == []
    assert [t for t, r in reports.items() if r.faults] == []
    states = list(dict.fromkeys(r.state for r in reports.values()))
    assert states == ['waiting', 'learning', 'watching']
    [last] = [r for t, r in reports.items() if t == max(reports)]
    units = {gap.channel: gap.unit for gap in last.gaps}
    assert units['actuator/pulley_M/effort'] == 'N m'
    assert units['load_cell/force'] == 'N'
    assert 'actuator/pulley_M/position' not in units
    assert all(0.3 * gap.floor < gap.gap < gap.limit for gap in last.gaps)


def test_a_gap_grows_and_is_small_again_without_flicker(rig, changing):
    reports = reports_of(Watch(rig), changing)
    grown = [t for t, r in reports.items() if r.grown]
    assert 18.0 <= grown[0] <= 20.0
    assert 29.0 <= grown[-1] <= 34.0
    assert np.allclose(np.diff(grown), 1.0)


@pytest.mark.parametrize(
    ('effect', 'place', 'parameters'),
    [
        ('tension_friction', 'pulley_3', {'coefficient': 0.12}),
        ('pretension', 'cable_L3', {'scale': 0.8}),
        ('torque_gain', 'motor_M', {'gain': 1.1}),
        ('encoder_gain', 'encoder_2', {'gain': 1.03}),
    ],
)
def test_the_place_of_a_new_effect_is_named(rig, real, effect, place, parameters):
    watch = Watch(rig)
    change = {17: [EffectUse(effect, place, parameters)]}
    reports = reports_of(watch, simulated(real, 26, change))
    assert min(t for t, r in reports.items() if r.grown) <= 21.0
    report = watch.suspect()
    assert report.places[0] == place
    assert report is watch.report
    named = {(s.effect, s.place) for s in report.suspects}
    assert (effect, place) in named
    assert 0.2 < report.suspects[0].share <= 1.0
    assert place in str(report.suspects[0])


def test_motor_signals_alone_are_enough(rig, changing):
    watch = Watch(rig)
    motors = only(changing, 'actuator')
    reports = reports_of(watch, only_until(motors, 24.0))
    assert 18.0 <= min(t for t, r in reports.items() if r.grown) <= 21.0
    assert {gap.channel for gap in watch.report.gaps} == {
        'actuator/pulley_M/effort',
        'actuator/pulley_L/effort',
    }
    assert watch.suspect().places[0] == 'pulley_3'


def only_until(recording, end):
    kept = {
        n: Channel(n, c.time[c.time < end], c.value[c.time < end])
        for n, c in recording.channels.items()
    }
    return replace(recording, channels=kept)


def test_accepted_effects_are_no_gap_and_growth_beyond_them_is(rig):
    worn = replace(rig, effects=(FRICTION,))
    more = [EffectUse('tension_friction', 'pulley_3', {'coefficient': 0.1})]
    recording = simulated(worn, 22, {12: more})
    at_once = WatchSettings(learn=0.0, warn_ratio=4.0)
    unaware = reports_of(Watch(rig, at_once), only_until(recording, 12.0))
    assert unaware[max(unaware)].grown
    watch = Watch(worn, at_once)
    reports = reports_of(watch, recording)
    assert min(t for t, r in reports.items() if r.grown) > 12.0
    assert watch.suspect().places[0] == 'pulley_3'


def test_a_gap_that_is_given_is_not_learnt(rig, changing):
    start = only_until(changing, 10.0)
    channels = {gap.channel: 1e3 for gap in reports_of(Watch(rig), start)[9.0].gaps}
    reports = reports_of(Watch(rig, WatchSettings(explained=channels)), start)
    assert {r.state for r in reports.values()} == {'waiting', 'watching'}
    assert {gap.limit for gap in reports[9.0].gaps} == {2e3}


def test_a_bag_played_back_gives_the_same(rig, changing, tmp_path):
    some = only_until(changing, 21.0)
    live = reports_of(Watch(rig), some)
    write_recording(some, tmp_path / 'bag')
    played = reports_of(Watch(rig), read_recording(tmp_path / 'bag'), every=7)
    common = [t for t in played if t > 4.0]
    assert len(common) > 12
    assert any(report.grown for report in live.values())
    for t in common:
        assert [g.channel for g in played[t].grown] == [g.channel for g in live[t].grown], t
        for gap in played[t].gaps:
            [other] = [g for g in live[t].gaps if g.channel == gap.channel]
            assert gap.gap == pytest.approx(other.gap, rel=1e-6)


def test_motors_at_rest_are_not_judged(rig, real):
    period = rig.control_period
    motion = chosen_trajectory(
        'multisine', rig.motor_names, {'duration': '12 s', 'amplitude': '5 deg'}
    ).sample(period)
    still = np.repeat(motion[-1:], round(11.0 / period), axis=0)
    reports = reports_of(
        Watch(rig), simulated(real, 32, motion=np.concatenate([motion, still, motion]))
    )
    assert reports[22.0].state == 'resting'
    assert reports[22.0].gaps == reports[21.0].gaps
    assert reports[31.0].state == 'watching'
    assert [t for t, r in reports.items() if r.grown] == []


# -- bad input


def said(recording, rig, seconds=8.0):
    watch = Watch(rig)
    reports = reports_of(watch, only_until(recording, seconds))
    return watch, reports[max(reports)]


def test_positions_alone_leave_nothing_to_compare(rig, changing):
    positions = ('actuator/pulley_M/position', 'actuator/pulley_L/position')
    _, report = said(only(changing, *positions), rig)
    assert 'nothing to compare; publish' in report.faults['motors']


def test_degrees_are_found(rig, changing):
    turned = [
        Channel(c.name, c.time, np.rad2deg(c.value))
        for n, c in changing.channels.items()
        if n.startswith('actuator') and n.endswith('position')
    ]
    _, report = said(changing.with_channels(turned), rig)
    assert 'in degrees it would fit' in report.faults['motors']


def test_a_channel_that_stops_is_named_and_the_others_go_on(rig, changing):
    force = changing['load_cell/force']
    stops = force.time < 5.0
    cut = changing.with_channels([Channel(force.name, force.time[stops], force.value[stops])])
    _, report = said(cut, rig)
    assert 'load_cell/force: its stamps end 2.0 s before' in report.faults['load_cell/force']
    assert 'actuator/pulley_M/effort' in {gap.channel for gap in report.gaps}


@pytest.mark.parametrize(
    ('off', 'words'),
    [
        (20.0, 'its stamps are 20.0 s ahead of those of the motors; see that both have the same'),
        (-20.0, 'its stamps end 19.8 s before those of the motors'),
    ],
)
def test_a_channel_with_another_clock_is_named_in_either_direction(rig, changing, off, words):
    """As it arrives: what is stamped otherwise still comes beside the motors."""
    watch = Watch(rig)
    for measurement in topics_of(only_until(changing, 8.0)):
        away = round(off * 1e9) if 'load_cell/force' in measurement.values else 0
        watch.update(replace(measurement, stamp_ns=measurement.stamp_ns + away))
        if watch.due:
            report = watch.look()
    assert words in report.faults['load_cell/force']
    gaps = {gap.channel for gap in report.gaps}
    assert 'actuator/pulley_M/effort' in gaps
    assert 'load_cell/force' not in gaps


def test_after_a_hole_in_the_motion_a_window_fills_again(rig, changing):
    hole = {
        n: Channel(n, c.time[keep], c.value[keep])
        for n, c in changing.channels.items()
        for keep in [(c.time < 7.0) | (c.time > 8.5)]
    }
    reports = reports_of(Watch(rig), only_until(replace(changing, channels=hole), 16.0))
    assert reports[6.0].state == 'learning'
    assert {reports[t].state for t in (9.0, 10.0, 11.0)} == {'waiting'}
    assert reports[14.0].state == 'learning'
    largest = max(g.gap / g.floor for r in reports.values() for g in r.gaps)
    assert largest < 6.0


def test_a_motor_without_encoder_is_watched_by_its_torque_and_one_without_either_is_not(rig):
    blind = [s for s in rig.sensors if not (s.kind == 'angle' and s.of == 'M')]
    by_torque = Watch(replace(rig, sensors=tuple(blind)))
    assert by_torque.missing == ('actuator/pulley_M/effort', 'actuator/pulley_L/position')
    deaf = [s for s in blind if s.of != 'M']
    with pytest.raises(RecordingError, match='motor M has neither encoder nor torque_sensor'):
        Watch(replace(rig, sensors=tuple(deaf)))


def test_what_cannot_be_used_is_refused_and_the_rest_is_kept(rig):
    watch = Watch(rig)
    assert watch.missing == ('actuator/pulley_M/position', 'actuator/pulley_L/position')
    both = {'actuator/pulley_M/position': 0.1, 'actuator/pulley_L/position': 0.0}
    watch.update(Measurement(EPOCH, both))
    assert watch.missing == ()
    with pytest.raises(RecordingError, match='effort is nan; it is left out'):
        watch.update(Measurement(EPOCH + 1, {**both, 'actuator/pulley_M/effort': np.nan}))
    with pytest.raises(StampError, match=r'stamp \d+ ns lies 0.000000 s before the last one'):
        watch.update(Measurement(EPOCH + 1, both))
    with pytest.raises(RecordingError, match=r'pulley_X: bench_rig has .*rename them'):
        watch.update(Measurement(EPOCH + 2, {'actuator/pulley_X/position': 0.1}))
    watch.update(Measurement(EPOCH + 3, {**both, 'actuator/pulley_Y/position': 0.1}))
    assert watch.strangers == ('pulley_Y',)
    watch.reset()
    watch.update(Measurement(EPOCH - 10**9, both))
    assert watch.suspect().suspects == ()
