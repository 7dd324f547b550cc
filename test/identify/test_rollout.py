"""Rollouts: measured motion drives the model, whoever commanded that motion."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.effects.sensor_delay import LONGEST
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.loosest import loosest
from tendon_ros.identify.residuals import FEW
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import segment_of
from tendon_ros.identify.step_size import STEPS
from tendon_ros.identify.true_motion import true_motion
from tendon_ros.identify.untold import usual_part
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.laws import modified
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import follow

INJECTED = {
    'friction': ('coulomb_friction', 'pulley_3', {'torque': 0.1}),
    'gain': ('torque_gain', 'motor_L', {'gain': 0.85}),
    'offset': ('encoder_offset', 'encoder_M', {'angle': 0.01}),
    'scale': ('encoder_gain', 'encoder_L', {'gain': 1.05}),
}


def misfit(problem, *effects):
    """Return the power of what is left, in noise deviations, with effects in force."""
    uses = [[EffectUse(*effect) for effect in effects] for _ in problem.rollouts.segments]
    rows = problem.rollouts.predicted(uses)
    left = problem.flat([m - p for m, p in zip(problem.rollouts.measured, rows, strict=True)])
    return float(np.mean(left**2))


@pytest.mark.parametrize('effect', INJECTED.values(), ids=INJECTED)
def test_the_true_effect_explains_and_its_absence_does_not(bench, measured_on, effect):
    problem = prepared([measured_on(bench, effect)], bench).problem
    assert misfit(problem, effect) < 1.2
    assert misfit(problem) > 2.0 * misfit(problem, effect)


@pytest.mark.parametrize(('part', 'rate'), [(0.5, 1000.0), (1.0, 250.0), (1.4, 100.0)])
def test_controller_and_sampling_do_not_matter(bench, measured_on, part, rate):
    other = replace(
        bench,
        motors=tuple(
            replace(m, controller=replace(m.controller, kp=part * m.controller.kp))
            for m in bench.motors
        ),
    )
    run = measured_on(other, rate=rate)
    assert misfit(prepared([run], bench).problem) < 1.5


def test_what_was_predicted_a_moment_ago_is_not_computed_again(bench, measured_on, monkeypatch):
    runs = [measured_on(bench), measured_on(bench, seed=2, name='again')]
    rollouts = prepared(runs, bench).whole.rollouts
    computed = []

    def counted(instrument, *args, **more):
        computed.append(args)
        return follow(instrument, *args, **more)

    monkeypatch.setattr('tendon_ros.identify.rollout.follow', counted)
    weak = EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.05})
    strong = EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.06})
    before = rollouts.predicted([[weak], [weak]])
    assert len(computed) == 2
    after = rollouts.predicted([[weak], [strong]])
    assert len(computed) == 3
    assert after[0] is before[0]
    assert not np.array_equal(after[1], before[1])
    with pytest.raises(ValueError, match='read-only'):
        before[0][0] = 0.0


def test_only_what_is_asked_for_is_rolled_out(bench, measured_on):
    runs = [measured_on(bench), measured_on(bench, seed=2, name='again')]
    whole = prepared(runs, bench).whole
    uses = whole.uses(whole.empty)
    first, second = whole.rollouts.predicted(uses)
    only, left_out = whole.rollouts.predicted(uses, [True, False])
    assert np.array_equal(only, first)
    assert second.any()
    assert not left_out.any()
    used = [whole.masks[0].any(axis=0), np.zeros(second.shape[1], dtype=np.bool_)]
    left = Problem(whole.rollouts, whole.tolerances, used).left(whole.empty)
    assert np.array_equal(left, whole.left(whole.empty)[: len(left)])


def test_what_is_impossible_is_infinitely_bad_and_no_crash(sound_problem):
    far = EffectUse('cable_stiffness', 'cable_12', {'scale': 1e-9})
    mad = EffectUse('inertia', 'pulley_1', {'scale': 1e-30})
    [row] = sound_problem.rollouts.predicted([[far, mad]])
    assert row.shape == sound_problem.rollouts.measured[0].shape
    assert not np.isnan(row).any()


def test_a_sensor_without_a_zero_tells_no_offset(bench, measured_on):
    run = measured_on(bench, ('encoder_offset', 'encoder_3', {'angle': 0.02}))
    sensors = tuple(replace(s, zeroed=s.name != 'encoder_3') for s in bench.sensors)
    assert misfit(prepared([run], bench).problem) > 10.0
    assert misfit(prepared([run], replace(bench, sensors=sensors)).problem) < 1.2


@pytest.fixture(scope='module')
def stopping():
    """Return a body on a motor that rubs with 0.2 N m, as a problem, and where it rests."""
    body = load_instrument('single_body')

    def problem_of(run):
        problem = prepared([run], body).problem
        [segment] = problem.rollouts.segments
        return problem, segment.still[0]

    return body, problem_of


@pytest.mark.parametrize(('limit', 'held'), [(0.2, True), (0.3, True), (0.1, False)])
def test_a_motor_at_rest_holds_what_friction_can(stopping, measured_on, limit, held):
    body, problem_of = stopping
    rubs = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    wide = (('duration', '8 s'), ('amplitude', '40 deg'))
    problem, still = problem_of(measured_on(body, rubs, settings=wide))
    use = EffectUse('coulomb_friction', 'pulley_body', {'torque': limit})
    [[row]] = problem.rollouts.predicted([[use]])
    [segment] = problem.rollouts.segments
    off = np.abs(segment.measured[0].value - row)[still]
    noise = segment.measured[0].noise[still]
    assert 0.1 < np.mean(still) < 0.5
    assert (np.mean(off < 1.01 * noise) > 0.95) == held


@pytest.mark.parametrize(('limit', 'held'), [(0.2, True), (0.1, False)])
def test_what_friction_holds_may_have_lost_its_sign(stopping, measured_on, limit, held):
    body, problem_of = stopping
    rubs = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    lost = ('sensor_rectified', 'torque_body', {'rectified': 1.0})
    wide = (('duration', '8 s'), ('amplitude', '40 deg'))
    problem, still = problem_of(measured_on(body, rubs, lost, settings=wide))
    use = EffectUse('coulomb_friction', 'pulley_body', {'torque': limit})
    [[row]] = problem.rollouts.predicted([[use, EffectUse(*lost)]])
    [segment] = problem.rollouts.segments
    off = np.abs(segment.measured[0].value - row)[still]
    assert (np.mean(off < 1.01 * segment.measured[0].noise[still]) > 0.95) == held


def test_what_is_held_is_no_better_known_than_noise_allows(stopping, measured_on):
    body, problem_of = stopping
    # nothing rubs: whoever says that something does may not take the noise away
    wide = (('duration', '8 s'), ('amplitude', '40 deg'))
    problem, still = problem_of(measured_on(body, settings=wide))
    use = EffectUse('presliding_friction', 'pulley_body', {'torque': 1e-3, 'angle': 0.1})
    [[plain]] = problem.rollouts.predicted([[]])
    [[holding]] = problem.rollouts.predicted([[use]])
    [segment] = problem.rollouts.segments
    value = segment.measured[0].value
    assert still.any()
    assert np.std((value - holding)[still]) > 0.9 * np.std((value - plain)[still])


def test_a_limit_that_nearly_all_torques_pass_excuses_nothing(stopping, measured_on):
    body, problem_of = stopping
    spring = ('joint_spring', 'pulley_body', {'stiffness': 0.5})
    problem, _ = problem_of(measured_on(body, spring))
    uses = [
        EffectUse('torque_gain', 'motor_body', {'gain': 3.0}),
        EffectUse('torque_saturation', 'motor_body', {'limit': 0.05}),
    ]
    [segment] = problem.rollouts.segments
    value = segment.measured[0].value
    without, excused = (
        np.mean((value - problem.rollouts.predicted([own])[0][0]) ** 2) for own in ([], uses)
    )
    assert excused > 0.3 * without


def test_a_limit_excuses_no_more_than_half_where_the_torque_constant_is_a_guess():
    """A limit sinks with a guessed constant until it means nothing."""
    known, guessed = load_instrument('single_body'), load_instrument('pendulum_arm')
    assert usual_part(known, 'body') == 0.2
    assert usual_part(guessed, 'arm') == 0.5


def test_a_limit_that_sets_in_over_a_knee_is_none_that_sets_in_at_once(bench, measured_on):
    soft = ('torque_saturation', 'motor_L', {'limit': 0.5, 'knee': 0.5})
    hard = ('torque_saturation', 'motor_L', {'limit': 0.5})
    problem = prepared([measured_on(bench, soft)], bench).problem
    assert misfit(problem, soft) < 1.2
    assert misfit(problem) > misfit(problem, hard) > 2.0 * misfit(problem, soft)


def noisy_motion(segment, size):
    """Return a segment whose motion has errors that share nothing from bin to bin."""
    motion = segment.motion
    noise = np.random.default_rng(3).normal(0.0, size, motion.value.shape)
    return replace(segment, motion=Signals.smooth(motion.start, motion.step, motion.value + noise))


@pytest.mark.parametrize('late', [0.5, 1.0, 2.3])
def test_a_delay_takes_no_noise_away(stopping, measured_on, late):
    body, problem_of = stopping
    problem, _ = problem_of(measured_on(body))
    [segment] = problem.rollouts.segments
    noisy = noisy_motion(segment, 1e-3)
    use = EffectUse('sensor_delay', 'encoder_body', {'time': late * segment.period})
    rig = replace(body, effects=(use,))
    moved, plain = (
        true_motion(rig, modified(rig, rig.effects), s).value[0] for s in (noisy, segment)
    )
    middle = slice(50, -50)
    assert np.std((moved - plain)[middle]) == pytest.approx(1e-3, rel=0.1)
    grid = segment.period * np.arange(len(plain))
    expected = np.interp(grid + late * segment.period, grid, segment.motion.value[0])
    assert plain[middle] == pytest.approx(expected[middle], abs=1e-3)


def test_the_longest_delay_can_be_told_with_any_bins(stopping, measured_on):
    """Where the nearest bin is beyond it, what stays of it would be no delay that there is."""
    body, _ = stopping
    segment = segment_of(body, measured_on(body), 0.28 * LONGEST)
    use = EffectUse('sensor_delay', 'torque_body', {'time': LONGEST})
    [[row]] = Rollouts(body, [segment]).predicted([[use]])
    assert np.isfinite(row).all()


@pytest.mark.parametrize('late', [0.5, 1.0, 2.3])
def test_a_late_torque_sensor_takes_no_noise_away_either(stopping, measured_on, late):
    body, problem_of = stopping
    problem, _ = problem_of(measured_on(body))
    [segment] = problem.rollouts.segments
    noisy = noisy_motion(segment, 1e-5)
    use = EffectUse('sensor_delay', 'torque_body', {'time': late * segment.period})
    rows = [
        problem.rollouts.like([which]).predicted([uses])[0][0]
        for which in (segment, noisy)
        for uses in ([], [use])
    ]
    middle = slice(50, -50)
    now, delayed = (np.std((rows[k + 2] - rows[k])[middle]) for k in (0, 1))
    assert delayed == pytest.approx(now, rel=0.05)
    grid = segment.period * np.arange(len(rows[0]))
    expected = np.interp(grid - late * segment.period, grid, rows[0])
    # over some bins the same as what lies between two of them, which is smoother
    of_many = np.ones(9) / 9.0
    off, moved = (
        np.std(np.convolve(rows[1] - other, of_many, mode='same')[middle])
        for other in (expected, rows[0])
    )
    assert off < 0.3 * moved


def test_threads_change_no_derivative(bench, measured_on):
    run = measured_on(bench, INJECTED['friction'])
    alone, together = (prepared([run], bench, jobs).problem for jobs in (1, 3))
    fits = [problem.fitted(problem.empty, rounds=2) for problem in (alone, together)]
    assert np.array_equal(fits[0].slope, fits[1].slope)
    assert fits[0].cost == fits[1].cost


def test_rollouts_are_rougher_where_laws_leave_more_than_noise(bench, sound_run):
    fine = prepared([sound_run], bench)
    assert fine.problem.rollouts.tolerance < STEPS[0]
    # where models leave far more than the noise, rollouts are good enough that were not before
    doubted = [
        replace(s, measured=tuple(replace(m, misfit=1e3 * np.median(m.noise)) for m in s.measured))
        for s in fine.whole.rollouts.segments
    ]
    assert loosest(bench, doubted) == STEPS[0]
    assert fine.problem.rougher().rollouts.tolerance > 10.0 * fine.problem.rollouts.tolerance
    left, rough = fine.problem.left(fine.problem.empty), fine.problem.rougher()
    for mask, same in zip(rough.masks, fine.problem.masks, strict=True):
        np.testing.assert_array_equal(mask, same)
    assert 0.0 < np.sqrt(np.mean((rough.left(rough.empty) - left) ** 2)) < 0.5


@pytest.mark.parametrize(
    ('shakes', 'smooth', 'taken'),
    [
        (False, 1.0, 1),
        # what holds otherwise with each step tells of chance: what is smooth decides
        (True, 1.0, 2),
        (True, 0.01, 4),
        (False, 0.01, 4),
    ],
)
def test_what_holds_otherwise_with_each_step_asks_for_no_finer_ones(
    bench, sound_run, monkeypatch, shakes, smooth, taken
):
    """With steps of 4 urad what is smooth is off by a tenth of what shows, or by ten times."""
    segments = prepared([sound_run], bench).whole.rollouts.segments

    class Stepped:
        def __init__(self, _instrument, segments, tolerance):
            self._segments, self._tolerance = segments, tolerance

        def predicted(self, uses):
            seed = int(1e9 * self._tolerance)
            chance = 0.3 * np.random.default_rng(seed).normal(size=len(segments[0].time))
            off = 0.005 * self._tolerance / STEPS[2] / smooth
            if any(uses) and shakes:
                off = off + chance
            return [np.array([m.doubt * off for m in s.measured]) for s in self._segments]

    monkeypatch.setattr('tendon_ros.identify.loosest.Rollouts', Stepped)
    found = loosest(bench, segments)
    assert found == pytest.approx(STEPS[taken])


def test_a_first_look_takes_a_few_of_many_recordings(bench, sound_run):
    runs = [replace(sound_run, name=f'run{n}') for n in range(FEW + 3)]
    problem = prepared(runs, bench).problem
    few = problem.rougher()
    names = [s.name for s in few.rollouts.segments]
    assert len(names) == FEW
    assert {'run0', f'run{FEW + 2}'} <= set(names)
    assert len(few.left(few.empty)) < 0.7 * len(problem.left(problem.empty))


@pytest.mark.parametrize(
    'late', [{'time': 0.02, 'filtered': 1.0}, {'time': 0.02, 'filtered': 0.4}]
)
def test_a_filtered_speed_is_told_from_a_late_one(tmp_path, measured_on, late):
    (tmp_path / 'rig.yaml').write_text(
        'base: single_body\nspeed_sensors: {body: {noise: 0.01 rad/s}}\n'
    )
    rig = load_instrument(tmp_path / 'rig.yaml')
    lost = ('sensor_rectified', 'speed_body', {'rectified': 1.0})
    far = (('duration', '6 s'), ('amplitude', '60 deg'))
    run = measured_on(rig, lost, ('sensor_delay', 'speed_body', late), settings=far)
    problem = prepared([run], rig).problem
    asked = {c.effect: c for c in everyone(rig, list(run.channels)) if c.place == 'speed_body'}
    model = problem.empty.joined(asked['sensor_rectified'], {'rectified': 1.0})
    model = model.joined(asked['sensor_delay'], {'time': 0.005, 'filtered': 0.5})
    found = problem.fitted(model)
    assert found.model.values(1) == {
        'time': pytest.approx(late['time'], rel=0.1),
        'filtered': pytest.approx(late['filtered'], abs=0.1),
    }
    assert problem.structured(found.left) < 0.1
