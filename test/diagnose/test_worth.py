"""What counts in a cause's favour: not what friction merely holds; all where others do not act."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose import worth
from tendon_ros.diagnose.beyond import beyond_laws, hopeless
from tendon_ros.diagnose.form import form_power, form_profile, tie
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.worth import gains, moving, open_question, stands_out, worthwhile
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.sticking import sticking
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument

RUBS = Candidate('coulomb_friction', 'pulley_body')
BIAS = Candidate('torque_bias', 'motor_body')
WIDE = (('duration', '6 s'), ('amplitude', '40 deg'))


@pytest.fixture(scope='module')
def body():
    """Return one body on a motor."""
    return load_instrument('single_body')


@pytest.fixture(scope='module')
def rubbing(body, measured_on):
    """Return the problem of a body that rubs."""
    run = measured_on(body, ('coulomb_friction', 'pulley_body', {'torque': 0.2}), settings=WIDE)
    return prepared([run], body).problem


def test_friction_that_holds_is_not_looked_for(rubbing):
    before = rubbing.fitted(rubbing.empty)
    after = rubbing.fitted(rubbing.empty.joined(RUBS, {'torque': 0.1}))
    [segment] = rubbing.rollouts.segments
    still = rubbing.sampled([segment.still[0]])
    gain, _ = gains(rubbing, before, moving(rubbing, before, after))
    slid = np.sum(before.left[~still] ** 2) - np.sum(after.left[~still] ** 2)
    assert 0.1 < np.mean(still) < 0.5
    assert gain == pytest.approx(slid / len(still), rel=0.05)
    # of another cause all counts
    pushed = rubbing.fitted(rubbing.empty.joined(BIAS, {'torque': 0.01}))
    assert moving(rubbing, before, pushed) is pushed


@pytest.mark.parametrize(('slides', 'told'), [(1.0, True), (2.9, False)])
def test_what_friction_holds_is_no_part_that_it_would_have_to_explain(rubbing, slides, told):
    def leaving(fit, held, else_):
        left = np.where(still, held, else_)
        return replace(fit, left=left, cost=float(left @ left))

    [segment] = rubbing.rollouts.segments
    still = rubbing.sampled([segment.still[0]])
    bare = rubbing.fitted(rubbing.empty, rounds=0)
    rubs = rubbing.fitted(rubbing.empty.joined(RUBS, {'torque': 0.1}), rounds=0)
    start = leaving(bare, 30.0, 30.0)
    # most of what is left is torque of a motor at rest, which any friction could hold
    before, after = leaving(bare, 10.0, 3.0), leaving(rubs, 0.0, slides)
    assert stands_out(rubbing, start, before, after) is told


CUT = Candidate('torque_saturation', 'motor_body')


@pytest.fixture(scope='module')
def limited(body, measured_on):
    """Return the problem of a body whose motor is cut off, without and with that limit."""
    run = measured_on(body, (CUT.effect, CUT.place, {'limit': 0.06}), settings=WIDE)
    problem = prepared([run], body).problem
    start = problem.fitted(problem.empty)
    return problem, start, problem.fitted(problem.empty.joined(CUT, {'limit': 0.06, 'knee': 0.01}))


def test_laws_may_be_wrong_where_they_act_and_not_elsewhere(limited):
    problem, start, state = limited
    profile = form_profile(problem, start, state)
    assert profile.shape == state.left.shape
    assert form_power(problem, start, state) == pytest.approx(float(np.mean(profile)))
    assert np.quantile(profile, 0.3) < 0.01 * profile.max()


@pytest.mark.parametrize(
    ('silent', 'undone', 'worth_it'), [(True, 0, True), (False, 0, False), (True, 2, False)]
)
def test_a_weak_cause_counts_where_the_strong_one_is_silent(
    limited, monkeypatch, silent, undone, worth_it
):
    problem, start, state = limited
    # what it would explain of the form of the strong one by taking it back is that form
    monkeypatch.setattr(worth, 'undoing', lambda *_: frozenset(range(undone)))
    quiet = np.arange(len(state.left)) % 100 < 60
    profile = np.where(quiet, 0.0, 1e4)  # so strong that its form hides everything, on average
    monkeypatch.setattr(worth, 'form_parts', lambda *_: [profile])
    left = np.where(quiet, 0.0, 5.0)
    off = left + np.where(quiet == silent, 2.0, 0.0)
    before = replace(state, left=off, cost=float(off @ off))
    model = state.model.joined(BIAS, {'torque': 0.01})
    after = replace(state, left=left, cost=float(left @ left), model=model)
    assert worthwhile(problem, start, before, after) is worth_it


@pytest.mark.parametrize(('gone', 'worth_it'), [('weight', True), ('wave', False)])
def test_a_cause_beside_a_ripple_is_asked_for_what_its_waves_may_get_wrong(
    body, measured_on, monkeypatch, gone, worth_it
):
    ripple = Candidate('torque_ripple', 'motor_body')
    values = {'amplitude': 0.3, 'cycles': 12.0, 'phase': 0.2}
    weight = Candidate('gravity', 'pulley_body')
    run = measured_on(body, (ripple.effect, ripple.place, values), settings=WIDE)
    problem = prepared([run], body).problem
    state = problem.fitted(problem.empty.joined(ripple, values), rounds=2)
    model = state.model.joined(weight, {'torque': 0.001, 'phase': 0.0})
    does = {
        'weight': problem.left(state.model.joined(weight, {'torque': 0.1, 'phase': 0.0})),
        'wave': problem.left(state.model.without(0).joined(ripple, {**values, 'cycles': 24.0})),
    }[gone] - problem.left(state.model if gone == 'weight' else state.model.without(0))
    does /= np.sqrt(np.mean(does**2))
    # a form larger than what it explains of much more that is left
    monkeypatch.setattr(worth, 'form_parts', lambda *_: [np.full(len(does), 3.0)])
    stays = 4.0 * np.sin(0.03 * np.arange(len(does)))
    stays -= does * (does @ stays) / (does @ does)
    before, after = (
        replace(state, left=left, cost=float(left @ left), model=causes)
        for left, causes in ((stays + does, state.model), (stays, model))
    )
    assert worthwhile(problem, state, before, after) is worth_it


@pytest.mark.parametrize(
    ('more', 'worth_it'),
    [
        (Candidate('cable_creep', 'cable_m1'), False),
        (Candidate('pretension', 'cable_m1'), True),
    ],
)
def test_creep_gives_no_other_creep_the_form_that_its_law_has_not(
    bench, measured_on, monkeypatch, more, worth_it
):
    creep = Candidate('cable_creep', 'cable_12')
    values = {'fraction': 0.3, 'time': 2.0, 'share': 1.0}
    run = measured_on(bench, (creep.effect, creep.place, values), touching=True)
    problem = prepared([run], bench).problem
    state = problem.fitted(problem.empty.joined(creep, values), rounds=2)
    model = state.model.joined(more, {p.name: p.typical for p in more.parameters})
    noise = np.random.default_rng(0).standard_normal(len(state.left))

    def leaving(off, causes):
        return replace(
            state, left=noise + off, cost=float(np.sum((noise + off) ** 2)), model=causes
        )

    start, before, after = (
        leaving(3.0, problem.empty), leaving(0.6, state.model), leaving(0.0, model)
    )  # fmt: skip
    # more than any other cause explains, and less than the form of what is there may be
    monkeypatch.setattr(worth, 'form_parts', lambda *_: [np.full(len(noise), 5.0)])
    assert worthwhile(problem, start, before, after) is worth_it


def test_the_effects_of_a_file_have_a_form_too(body, rubbing, measured_on):
    friction = EffectUse('coulomb_friction', 'pulley_body', {'torque': 0.2})
    run = measured_on(body, ('coulomb_friction', 'pulley_body', {'torque': 0.2}), settings=WIDE)
    problem = prepared([run], replace(body, effects=(friction,))).problem
    fit = problem.fitted(problem.empty)
    assert form_power(problem, fit, fit) > 1.0
    plain = rubbing.fitted(rubbing.empty)
    assert form_power(rubbing, plain, plain) == 0.0  # no cause, no law to blame


def test_what_a_sound_rig_leaves_ties_little(body, measured_on):
    # one whose loop hardly shakes by counts
    [motor] = body.motors
    body = replace(body, motors=(replace(motor, controller=replace(motor.controller, kd=0.005)),))
    problem = prepared([measured_on(body, settings=WIDE)], body).problem
    assert tie(problem, problem.fitted(problem.empty, rounds=2)) < 0.05


def test_inner_friction_sticks_where_the_rig_rests(measured_on):
    bench = load_instrument('bench_rig')
    rubs = ('coulomb_friction', 'pulley_3', {'torque': 0.1})
    resting = measured_on(bench, rubs, touching=True, trajectory='paper_fig12', settings=())
    moving = replace(measured_on(bench, rubs), name='moving')
    problem = prepared([resting, moving], bench).problem
    inner = Candidate('coulomb_friction', 'pulley_3')
    driven = Candidate('coulomb_friction', 'pulley_M')
    model = problem.empty.joined(inner, {'torque': 0.1}).joined(driven, {'torque': 0.01})
    sticks, free = sticking(problem, problem.fitted(model, rounds=1))
    assert free is None
    segment = np.concatenate(
        [np.full(span.stop - span.start, n) for n, _, span in problem.spans()]
    )
    assert np.mean(sticks[segment == 0]) > 0.2
    assert np.mean(sticks[segment == 1]) < 0.1


@pytest.mark.parametrize(
    ('recordings', 'only', 'worth_it'),
    [
        (('free', 'again'), 'again', True),
        # of four pushes it explains one, and where it is said to act in all runs a quarter
        (('free', 'again', 'third', 'last'), '', False),
        (('free', 'again', 'third', 'last'), 'again', True),
    ],
)
def test_an_event_explains_half_of_what_is_left_where_it_happens(
    body, measured_on, recordings, only, worth_it
):
    push = {'torque': 0.3, 'start': 2.0, 'duration': 0.5}
    runs = [
        measured_on(body, ('disturbance', 'pulley_body', {**push, 'start': at}), name=name)
        for at, name in zip((4.0, 2.0, 1.0, 3.0), recordings, strict=False)
    ]
    problem = prepared(runs, body).problem
    before = problem.fitted(problem.empty)
    event = Candidate('disturbance', 'pulley_body', only=only)
    after = problem.fitted(problem.empty.joined(event, push), rounds=4)
    assert worthwhile(problem, before, before, after) == worth_it


def test_what_is_left_all_the_time_is_not_explained_by_an_event(body, measured_on):
    run = measured_on(body, ('joint_spring', 'pulley_body', {'stiffness': 0.5, 'rest': 0.0}))
    problem = prepared([run], body).problem
    before = problem.fitted(problem.empty)
    event = Candidate('disturbance', 'pulley_body')
    fits = [
        problem.fitted(
            problem.empty.joined(event, {'torque': 0.05, 'start': at, 'duration': 0.4}), rounds=8
        )
        for at in (1.0, 2.0, 3.0, 4.0)
    ]
    best = min(fits, key=lambda fit: fit.cost)
    gain, _ = gains(problem, before, best)
    assert gain > 1.0
    assert not worthwhile(problem, before, before, best)


@pytest.mark.parametrize(
    ('left', 'beyond', 'lost'), [(0.3, False, False), (5.0, True, False), (60.0, True, True)]
)
def test_a_machine_leaves_more_than_laws_can_be_wrong_by(rubbing, left, beyond, lost):
    def leaving(fit, shape):
        return replace(fit, left=shape, cost=float(shape @ shape))

    wave = np.sin(np.linspace(0.0, 40.0, len(rubbing.fitted(rubbing.empty, rounds=0).left)))
    start = leaving(rubbing.fitted(rubbing.empty, rounds=0), 100.0 * wave)
    rubs = rubbing.fitted(rubbing.empty.joined(RUBS, {'torque': 1e-3}), rounds=0)
    state = leaving(rubs, left * wave)
    assert beyond_laws(rubbing, start, state) is beyond
    # of what was there little may be left for all that
    assert hopeless(rubbing, start, state) is lost


@pytest.mark.parametrize(('loud', 'told'), [(0.9, False), (2.0, True)])
def test_what_neighbours_do_not_share_is_a_question_where_it_is_no_noise(rubbing, loud, told):
    state = rubbing.fitted(rubbing.empty, rounds=0)
    # so many bins apart that noise is a difference the sign is another
    left = loud * (-1.0) ** np.arange(len(state.left))
    assert open_question(rubbing, replace(state, left=left)) is told


@pytest.mark.parametrize(('together', 'told'), [(1, False), (40, True)])
def test_an_event_does_not_live_on_what_single_bins_have(rubbing, together, told):
    start = rubbing.fitted(rubbing.empty)
    event = Candidate('disturbance', 'pulley_body')
    push = {'torque': 0.05, 'start': 2.0, 'duration': 0.4}
    quiet = np.random.default_rng(5).normal(size=len(start.left))
    # as friction lets go here and there, or as somebody pushes; and a misfit all along beside it
    all_along = quiet + 0.5 * np.sin(np.arange(len(quiet)) / 20.0)
    left = all_along.copy()
    anywhere = np.random.default_rng(7).choice(np.arange(100, 400), 25, replace=False)
    for begin in [100] if together > 1 else anywhere:
        left[begin : begin + together] += 8.0
    before = replace(start, left=left, cost=float(left @ left))
    model = start.model.joined(event, push)
    after = replace(start, model=model, left=all_along, cost=float(all_along @ all_along))
    assert worthwhile(rubbing, before, before, after) is told
