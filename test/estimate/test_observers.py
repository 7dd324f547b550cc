"""The three methods find the force and the inner pulleys, and say how well they know them."""

from contextlib import suppress
from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.bags.reader import read_recording
from tendon_ros.base.errors import InstrumentError, RecordingError, SimulationError, TendonError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.estimate import build_observer, estimate_recording, Measurement, METHODS
from tendon_ros.estimate.offline import measurements
from tendon_ros.estimate.score import scored
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

#: largest error of the force [N], and of an inner angle [rad], without noise: what is left is the
#: rounding of the encoders, and inertia where a method leaves it out
LIMITS = {'contact_angle': (0.25, 3e-4), 'static_balance': (0.35, 6e-4), 'dynamic': (0.35, 6e-4)}

STARTED = 0.3  # [s] until what begins at rest has moved


def taut():
    """Return a grasper whose cable is preloaded, so that it rubs and pulls either way."""
    grasper = load_instrument('davinci_grasper')
    [cable], [curve] = grasper.loops, grasper.curves
    softer = replace(curve, tension=(0.0, 210.0))
    return replace(grasper, loops=(replace(cable, pretension=50.0),), curves=(softer,))


@pytest.mark.parametrize('method', METHODS)
def test_force_and_inner_angles_of_a_simulated_press(method, bench, pressing, rms):
    """On the model's own data every method meets the truth within the encoders' rounding."""
    estimated = estimate_recording(pressing, build_observer(bench, method))
    force, angle = LIMITS[method]
    estimate = estimated['estimate/force']
    assert pressing['load_cell/force'].value.max() > 40.0
    assert rms(estimate.value - pressing['load_cell/force'].at(estimate.time)) < force
    for name in bench.inner:
        own = estimated[f'estimate/pulley_{name}/position']
        true = pressing[f'pulley/pulley_{name}/position'].at(own.time)
        assert rms(own.value - true) < angle, name


def test_no_force_is_found_where_nothing_is_touched(bench, free_recording, rms):
    """A free motion is not taken for a force; the static method owes what inertia does."""
    found = {
        method: rms(
            estimate_recording(free_recording, build_observer(bench, method))[
                'estimate/force'
            ].value
        )
        for method in ('static_balance', 'dynamic')
    }
    assert found['static_balance'] < 1.0
    assert found['dynamic'] < 0.2 * found['static_balance']


@pytest.mark.parametrize('method', ['static_balance', 'dynamic'])
def test_stated_uncertainty_covers_the_error(method, bench, noisy):
    """With noise, two standard deviations hold at least 90 % of the samples, and are no excuse."""
    recording = estimate_recording(noisy, build_observer(bench, method))
    score = scored(recording, bench)
    assert score is not None
    assert score.coverage > 0.9
    assert np.median(recording['estimate/force_std'].value) < 5.0 * score.rmse


@pytest.mark.parametrize('method', METHODS)
def test_one_at_a_time_is_the_same_as_a_recording(method, bench, pressing):
    """Live and offline are one path: bit for bit."""
    observer = build_observer(bench, method)
    some = list(measurements(pressing, observer.needs))[:300]
    live = [observer.update(m).values['estimate/force'] for m in some]
    channels = (pressing[name] for name in observer.needs)
    begin = [Channel(c.name, c.time[:300], c.value[:300]) for c in channels]
    offline = estimate_recording(pressing.with_channels(begin), build_observer(bench, method))
    assert np.array_equal(live, offline['estimate/force'].value)


@pytest.mark.parametrize('method', ['static_balance', 'dynamic'])
def test_a_load_that_is_a_torque_is_known_as_well_as_its_force(method, bench, pressing):
    [contact] = bench.contacts
    cells = [
        replace(s, kind='contact_torque', channel='load_cell/torque')
        if s.kind == 'contact_force'
        else s
        for s in bench.sensors
    ]
    turned = replace(bench, sensors=tuple(cells))
    by_force = estimate_recording(pressing, build_observer(bench, method))
    by_torque = estimate_recording(pressing, build_observer(turned, method))
    for name in ('', '_std'):
        force = by_force[f'estimate/force{name}'].value
        torque = by_torque[f'estimate/torque{name}'].value
        assert torque == pytest.approx(contact.arm * force, rel=1e-6)


def test_reset_forgets(bench, pressing):
    """After a reset the same measurements give the same estimates."""
    observer = build_observer(bench, 'dynamic')
    some = list(measurements(pressing, observer.needs))[:50]
    first = [observer.update(m).values for m in some]
    observer.reset()
    assert [observer.update(m).values for m in some] == first


@pytest.mark.parametrize('method', METHODS)
def test_bad_measurements_are_refused_and_do_no_harm(method, bench, pressing):
    """NaN, a missing channel and a stamp that steps back raise; the next good one goes on."""
    observer, untouched = build_observer(bench, method), build_observer(bench, method)
    some = list(measurements(pressing, observer.needs))[:4]
    for m in some[:3]:
        observer.update(m)
        untouched.update(m)
    name = observer.needs[0]
    bad = Measurement(some[3].stamp_ns, {**some[3].values, name: float('nan')})
    with pytest.raises(RecordingError, match='not a finite number'):
        observer.update(bad)
    lacking = {k: v for k, v in some[3].values.items() if k != name}
    with pytest.raises(RecordingError, match=name):
        observer.update(Measurement(some[3].stamp_ns, lacking))
    with pytest.raises(RecordingError, match='does not come after'):
        observer.update(some[1])
    assert observer.update(some[3]) == untouched.update(some[3])


def unbounded(rig):
    """Return a rig whose file says nothing of where its motors can be and what they give."""
    open_end = (-math.inf, math.inf)
    motors = [
        replace(m, position_limit=open_end, torque_limit=math.inf, controller=None)
        for m in rig.motors
    ]
    return replace(rig, motors=tuple(motors))


def with_one(measurement, channel, value):
    return replace(measurement, values={**measurement.values, channel: value})


WILD = {
    'actuator/pulley_L/position': (100.0, r'100 rad is far beyond .* motor L in bench_rig'),
    'actuator/pulley_M/effort': (1e6, r'1e\+06 N m is far beyond .* motor M of bench_rig'),
}


@pytest.mark.parametrize('method', METHODS)
def test_what_no_motor_can_do_is_refused_and_does_no_harm(method, bench, pressing):
    observer, untouched = build_observer(bench, method), build_observer(bench, method)
    for m in list(measurements(pressing, observer.needs))[:20]:
        for channel in WILD.keys() & set(observer.needs):
            value, words = WILD[channel]
            with pytest.raises(RecordingError, match=words):
                observer.update(with_one(m, channel, value))
        assert observer.update(m) == untouched.update(m)


def test_what_does_not_balance_leads_nowhere(bench, pressing):
    """One wild angle spoils its own estimate, and no other."""
    rig = unbounded(bench)
    rubbing = replace(
        rig, effects=(EffectUse('tension_friction', 'pulley_3', {'coefficient': 0.1}),)
    )
    observer, untouched = (build_observer(rubbing, 'static_balance') for _ in range(2))
    some = list(measurements(pressing, observer.needs))[:150]
    for m in some[:100]:
        assert observer.update(m) == untouched.update(m)
    wild = observer.update(with_one(some[100], 'actuator/pulley_M/position', 1000.0))
    assert wild.values['estimate/force_std'] > 1e3
    for m in some[101:]:
        assert observer.update(m) == untouched.update(m)


@pytest.mark.parametrize('method', METHODS)
def test_an_observer_that_began_wildly_begins_anew(method, bench, pressing):
    """Where the file bounds no angle the first may be any; what follows soon tells better."""
    observer = build_observer(unbounded(bench), method)
    some = list(measurements(pressing, observer.needs))[:100]
    some[0] = with_one(some[0], 'actuator/pulley_M/position', 1e12)
    for m in some:
        with suppress(TendonError):
            estimate = observer.update(m)
    assert estimate.stamp_ns == some[-1].stamp_ns
    assert abs(estimate.values['estimate/force']) < 3.0


def test_a_torque_that_the_model_cannot_follow_does_no_harm(bench, pressing):
    """What friction remembers is as it was before the model diverged."""
    use = EffectUse('presliding_friction', 'pulley_3', {'torque': 0.05, 'angle': 0.1})
    rubbing = replace(unbounded(bench), effects=(use,))
    observer, untouched = build_observer(rubbing, 'dynamic'), build_observer(rubbing, 'dynamic')
    some = list(measurements(pressing, observer.needs))[:60]
    for m in some[:30]:
        assert observer.update(m) == untouched.update(m)
    with pytest.raises(SimulationError, match='diverged'):
        observer.update(with_one(some[30], 'actuator/pulley_M/effort', 1e20))
    for m in some[31:]:
        assert observer.update(m) == untouched.update(m)


def test_estimates_are_at_the_very_times_of_what_was_measured(bench, pressing):
    """To the last bit, as a bag gives them back, at stamps of which 1e-9 makes others."""
    time = np.arange(1, 400) * 100_000 / 1e9
    assert (np.arange(1, 400) * 100_000 * 1e-9 != time).any()
    measured = (pressing[f'actuator/pulley_{name}/position'] for name in bench.driven)
    fast = Recording('fast', {c.name: Channel(c.name, time, c.at(time)) for c in measured})
    estimated = estimate_recording(fast, build_observer(bench, 'contact_angle'))
    assert np.array_equal(estimated['estimate/force'].time, time)


def test_a_sample_that_is_refused_is_left_out_as_live_and_told(bench, pressing):
    motor = pressing['actuator/pulley_M/position']
    value = motor.value.copy()
    value[7] = 100.0
    wild = pressing.with_channels([Channel(motor.name, motor.time, value)])
    estimated = estimate_recording(wild, build_observer(bench, 'dynamic'))
    kept = np.delete(motor.time, 7)
    np.testing.assert_allclose(estimated['estimate/force'].time, kept, atol=1e-9)
    words = f'1 of {len(value)} measurements left out, the first at {motor.time[7]:.6f} s: '
    [warning] = estimated.warnings
    assert warning.startswith(f'{wild.name}: {words}actuator/pulley_M/position: 100 rad')
    gone = pressing.with_channels([Channel(motor.name, motor.time, 0.0 * value + 100.0)])
    with pytest.raises(RecordingError, match=rf'{gone.name}: no measurement could be used; at '):
        estimate_recording(gone, build_observer(bench, 'dynamic'))


def test_channels_that_cannot_tell_the_force_are_refused(bench):
    """Too few torques, unknown channels and unknown methods name the mend."""
    with pytest.raises(InstrumentError, match='at least one angle and one torque'):
        build_observer(bench, 'static_balance', channels=['actuator/pulley_M/position'])
    with pytest.raises(InstrumentError, match="no sensor gives 'actuator/pulley_M/speed'"):
        build_observer(bench, 'static_balance', channels=['actuator/pulley_M/speed'])
    with pytest.raises(InstrumentError, match='contact_angle'):
        build_observer(bench, 'kalman')
    with pytest.raises(InstrumentError, match='no operating force'):
        build_observer(load_instrument('single_body'), 'static_balance')


def test_what_is_known_of_a_force_makes_it_known_better(rms):
    """A force that is said to change slowly is told from many measurements, however many."""
    grasper = taut()
    loud = replace(
        grasper,
        sensors=tuple(
            replace(s, noise=8e-3) if s.kind == 'loop_torque' else s for s in grasper.sensors
        ),
    )
    motion = {'amplitude': '70 deg', 'duration': '6 s', 'frequency': '0.17 Hz'}
    profile = chosen_trajectory('sine', loud.motor_names, motion)
    channels = ['pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort']
    off = {}
    for rate in (50.0, 250.0):
        recording = simulate(loud, profile, rate=rate, seed=4)
        for wander in (None, 0.03):
            observer = build_observer(loud, 'static_balance', channels=channels, wander=wander)
            estimated = estimate_recording(recording, observer)
            estimate = estimated['estimate/torque']
            error = estimate.value - recording['load_cell/torque'].at(estimate.time)
            off[rate, wander] = rms(error)
            assert np.mean(np.abs(error) < 2.0 * estimated['estimate/torque_std'].value) > 0.9
        assert off[rate, 0.03] < 0.75 * off[rate, None]


def test_how_far_a_force_wanders_is_checked(bench):
    """What it says nothing to, and what it cannot be."""
    with pytest.raises(InstrumentError, match='static_balance or dynamic'):
        build_observer(bench, 'contact_angle', wander=1.0)
    for wander in (0.0, -1.0, float('nan')):
        with pytest.raises(InstrumentError, match='must be positive'):
            build_observer(bench, 'dynamic', wander=wander)


def test_a_missing_channel_of_a_recording_is_named(bench, pressing):
    """The error lists what the recording has."""
    kept = {k: c for k, c in pressing.channels.items() if k != 'actuator/pulley_L/effort'}
    with pytest.raises(RecordingError, match='actuator/pulley_L/effort'):
        estimate_recording(Recording('cut', kept), build_observer(bench, 'static_balance'))


@pytest.mark.parametrize('bias', [0.0, 0.03])
def test_shaft_torque_gives_the_jaw_torque(rms, bias):
    """Spindle torque and angle alone give the torque at the jaw, whatever their sensor's zero."""
    zero = EffectUse('load_cell_bias', 'shaft_spindle', {'force': bias})
    grasper = replace(taut(), effects=(zero,))
    profile = chosen_trajectory(
        'ramp', grasper.motor_names, {'amplitude': '45 deg', 'duration': '4 s'}
    )
    recording = simulate(grasper, profile, rate=100.0)
    channels = ['pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort']
    estimated = estimate_recording(
        recording, build_observer(grasper, 'static_balance', channels=channels)
    )['estimate/torque']
    truth = recording['load_cell/torque']
    assert truth.value.max() > 0.02
    assert rms(estimated.value - truth.at(estimated.time)) < 0.05 * truth.value.max()


def test_a_bench_of_another_make(bench, practice, rms):
    """On a rig that is not this model, without effects, the force is found to 0.3 N of 44 N."""
    whole = read_recording(practice / 'case_00' / 'contact')
    # pressed, and pressed harder
    recording = whole.with_channels(
        [
            Channel(c.name, c.time[early], c.value[early])
            for c in whole.channels.values()
            for early in [c.time < 8.0]
        ]
    )
    measured = recording['load_cell/force']
    assert measured.value.max() > 40.0
    for method in METHODS:
        estimated = estimate_recording(recording, build_observer(bench, method), rate=100.0)
        estimate = estimated['estimate/force']
        assert rms(estimate.value - measured.at(estimate.time)) < 0.3, method


def test_a_reversal_is_not_taken_for_force(rms):
    """Where strong friction, known to a tenth, turns round, the estimate stays and says so."""
    grasper = taut()
    rubbing, known = (
        replace(
            grasper,
            effects=(
                EffectUse('tension_friction', 'pulley_spindle', {'coefficient': coefficient}),
                EffectUse('presliding_friction', 'pulley_spindle', {'angle': 3e-3, 'torque': 0.0}),
            ),
        )
        for coefficient in (0.2, 0.18)
    )
    profile = chosen_trajectory(
        'multisine', grasper.motor_names, {'amplitude': '50 deg', 'duration': '8 s'}
    )
    recording = simulate(rubbing, profile, rate=100.0, seed=3)
    channels = ['pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort']
    misfits = dict(zip(channels, (2e-3, 8e-3), strict=True))  # as a diagnosis would leave them
    doubting = replace(
        known,
        sensors=tuple(replace(s, misfit=misfits.get(s.channel, 0.0)) for s in known.sensors),
    )
    estimated = estimate_recording(
        recording, build_observer(doubting, 'static_balance', channels=channels)
    )
    estimate = estimated['estimate/torque']
    truth = recording['load_cell/torque'].at(estimate.time)
    off = np.abs(estimate.value - truth)
    assert np.mean(off < 2.0 * estimated['estimate/torque_std'].value) > 0.9
    # before it has moved nobody knows which way it rubs
    off = off[estimate.time > recording.start + STARTED]
    assert off.max() < 0.35 * np.abs(truth).max()
    assert rms(off) < 0.16 * np.abs(truth).max()


@pytest.mark.parametrize(('true', 'known'), [(3e-3, 6e-3), (6e-3, 3e-3)])
def test_friction_at_rest_is_not_taken_for_force(true, known, rms):
    """While a pulley rests its friction may go either way within what its angle is unsure by."""
    grasper = taut()

    def rubbing(angle):
        uses = (
            EffectUse('tension_friction', 'pulley_spindle', {'coefficient': 0.5}),
            EffectUse('presliding_friction', 'pulley_spindle', {'angle': angle, 'torque': 0.0}),
        )
        return replace(grasper, effects=uses)

    motion = {'amplitude': '55 deg', 'duration': '10 s', 'frequency': '0.3 Hz'}
    recording = simulate(
        rubbing(true), chosen_trajectory('sine', grasper.motor_names, motion), rate=100.0, seed=3
    )
    channels = ['pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort']
    doubting = replace(
        rubbing(known),
        sensors=tuple(
            replace(s, misfit=3e-3) if s.channel in channels else s for s in grasper.sensors
        ),
    )
    estimated = estimate_recording(
        recording, build_observer(doubting, 'static_balance', channels=channels)
    )
    estimate = estimated['estimate/torque']
    truth = recording['load_cell/torque'].at(estimate.time)
    off = np.abs(estimate.value - truth)
    stated = estimated['estimate/torque_std'].value
    assert np.mean(off < 2.0 * stated) > 0.95
    # before it has moved nobody knows which way it rubs, and the estimate says so
    late = estimate.time > recording.start + STARTED
    assert np.all(off[~late] < 2.5 * stated[~late])
    assert off[late].max() < 0.3 * truth.max()
    assert rms(off[late]) < 0.06 * truth.max()


def test_friction_stiffer_than_cables_does_not_upset_the_balance(rms):
    """After a reversal friction builds up over an angle in which a cable hardly stretches."""
    bench = load_instrument('bench_rig')
    effects = [
        EffectUse(effect, f'pulley_{name}', parameters)
        for name in '123'
        for effect, parameters in (
            ('tension_friction', {'coefficient': 0.1}),
            ('presliding_friction', {'angle': 2e-3, 'torque': 0.0}),
        )
    ]
    rubbing = replace(bench, effects=tuple(effects))
    press = chosen_trajectory('paper_fig12', bench.motor_names, {})
    whole = simulate(rubbing, press, rate=200.0, seed=3)
    until = {name: c.time < 12.0 for name, c in whole.channels.items()}  # one reversal is enough
    recording = whole.with_channels(
        Channel(name, c.time[until[name]], c.value[until[name]])
        for name, c in whole.channels.items()
    )
    observer = build_observer(rubbing, 'static_balance')
    estimated = estimate_recording(recording, observer, rate=50.0)
    estimate = estimated['estimate/force']
    truth = recording['load_cell/force'].at(estimate.time)
    assert truth.max() > 40.0
    # 0.86 where the balance takes friction for what it was a measurement before
    assert rms(estimate.value - truth) < 0.75


def test_a_small_torque_is_met_at_the_edge_of_a_play():
    """A torque that may as well be none by its doubt is no reason to stay within the play."""
    tool = taut()
    rig = replace(
        tool,
        effects=(EffectUse('backlash', 'coupling_coupling', {'angle': 0.02, 'held': 0.0}),),
        sensors=tuple(replace(s, misfit=8e-3 * (s.kind == 'loop_torque')) for s in tool.sensors),
    )
    motion = {'duration': '6 s', 'amplitude': '40 deg'}
    run = simulate(rig, chosen_trajectory('sine', rig.motor_names, motion), rate=100.0)
    channels = ('pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort')
    assert 0.01 < run['load_cell/torque'].value.max() < 0.02
    found = estimate_recording(run, build_observer(rig, 'static_balance', channels=channels))
    estimate = found['estimate/torque']
    off = estimate.value - run['load_cell/torque'].at(estimate.time)
    assert np.abs(off).mean() < 0.001


def test_play_of_a_coupling_is_crossed(rms, monkeypatch):
    """Inside the play the torque says nothing of the motor's angle, or of its side."""
    tool = taut()
    rig = replace(
        tool, effects=(EffectUse('backlash', 'coupling_coupling', {'angle': 0.02, 'held': 0.0}),)
    )
    motion = {'duration': '6 s', 'amplitude': '70 deg'}
    run = simulate(rig, chosen_trajectory('sine', rig.motor_names, motion), rate=100.0)
    channels = ('pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort')
    assert run['load_cell/torque'].value.max() > 0.05

    def off():
        found = estimate_recording(run, build_observer(rig, 'static_balance', channels=channels))
        estimate = found['estimate/torque']
        return rms(estimate.value - run['load_cell/torque'].at(estimate.time))

    assert off() < 0.005
    monkeypatch.setattr('tendon_ros.estimate.play.Play.sides', lambda *_: [])
    assert off() > 0.02


def test_a_force_that_changes_sides_is_followed_through_slack():
    """With hardly any preload one cable after the other goes slack, and the force goes through."""
    tool = load_instrument('davinci_grasper')
    channels = ('pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort')
    time = 0.018 * np.arange(120)
    low, high = -0.02, 0.05
    torque = np.where(np.sin(6.0 * time) > 0.0, high, low)
    angle = 0.3 * np.abs(np.sin(3.0 * time)) - 0.5
    values = zip(channels, (angle, torque), strict=True)
    run = Recording('swinging', {name: Channel(name, time, value) for name, value in values})
    found = estimate_recording(run, build_observer(tool, 'static_balance', channels=channels))
    # only the jaw's damping keeps it back for a moment
    off = found['estimate/torque'].value - torque / 0.9
    assert np.abs(off).max() < 0.6 * (high - low)
    assert np.median(np.abs(off)) < 2e-3


def test_a_torque_that_reverses_crosses_several_plays_at_once(monkeypatch):
    """With one of two plays on the wrong side no angles balance the torques."""
    plays = {'coupling_coupling': 0.013, 'coupling_hinge': 0.07}
    tool = replace(
        load_instrument('davinci_grasper'),
        effects=tuple(
            EffectUse('backlash', place, {'angle': angle, 'held': 0.0})
            for place, angle in plays.items()
        ),
    )
    channels = ('actuator/pulley_motor/position', 'actuator/pulley_motor/effort')
    time = 0.018 * np.arange(160)
    torque = np.where(np.sin(6.0 * time) > 0.0, 0.05, -0.02)
    angle = 0.3 * np.abs(np.sin(3.0 * time)) - 0.5
    values = zip(channels, (angle, torque), strict=True)
    run = Recording('swinging', {name: Channel(name, time, value) for name, value in values})

    def astray():
        found = estimate_recording(run, build_observer(tool, 'static_balance', channels=channels))
        return np.mean(np.abs(found['estimate/torque'].value - torque / 0.9) > 5e-3)

    assert astray() < 0.1
    monkeypatch.setattr('tendon_ros.estimate.play.Play.corners', lambda *_: ())
    assert astray() > 0.4


def test_a_creeping_torque_at_rest_is_no_force(rms):
    """A torque that eases while all rests is taken up by friction as well as by the force."""
    grasper = taut()
    uses = (
        EffectUse('tension_friction', 'pulley_spindle', {'coefficient': 0.5}),
        EffectUse('presliding_friction', 'pulley_spindle', {'angle': 3e-3, 'torque': 0.0}),
    )
    channels = ['pulley/pulley_spindle/position', 'pulley/pulley_spindle/effort']
    rig = replace(
        grasper,
        effects=uses,
        sensors=tuple(
            replace(s, misfit=3e-3) if s.channel in channels else s for s in grasper.sensors
        ),
    )
    observer = build_observer(rig, 'static_balance', channels=channels, wander=0.01)
    time = 0.01 * np.arange(600)
    # two seconds of closing against a load, then a hold while the drive lets go of a third
    angle = np.minimum(0.2 * time, 0.4)
    torque = np.where(time < 2.0, 0.12, 0.12 - 0.01 * (time - 2.0))
    found = [
        observer.update(Measurement(int(1e9 * t), dict(zip(channels, (a, m), strict=True))))
        for t, a, m in zip(time, angle, torque, strict=True)
    ]
    force = np.array([one.values['estimate/torque'] for one in found])
    unsure = np.array([one.values['estimate/torque_std'] for one in found])
    assert abs(force[-1] - force[190]) < 0.01
    assert unsure[-1] > 2.0 * unsure[190]
