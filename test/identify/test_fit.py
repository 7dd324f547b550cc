"""Fits: what was put in comes out, whichever effect, controller or sampling."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose.patch import patched
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate, starts
from tendon_ros.identify.tolerance import tolerances
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument

#: effect, place, parameters, and the relative error that noise and smoothing may leave
INJECTED = [
    ('coulomb_friction', 'pulley_3', {'torque': 0.1}, 0.03),
    ('tension_friction', 'pulley_2', {'coefficient': 0.1}, 0.05),
    ('pretension', 'cable_L3', {'scale': 0.5}, 0.05),
    ('cable_stiffness', 'cable_12', {'scale': 1.3}, 0.05),
    ('torque_gain', 'motor_L', {'gain': 0.9}, 0.01),
    ('torque_bias', 'motor_M', {'torque': 0.05}, 0.03),
    ('encoder_gain', 'encoder_1', {'gain': 1.02}, 0.005),
    ('sensor_delay', 'torque_L', {'time': 0.02}, 0.08),
]


def fitted(bench, run, effect, place):
    problem = prepared([run], bench).problem
    cause = Candidate(effect, place)
    fits = [
        problem.fitted(problem.empty.joined(cause, values), rounds=12) for values in starts(cause)
    ]
    return problem, min(fits, key=lambda fit: fit.cost)


@pytest.mark.parametrize(('effect', 'place', 'truth', 'within'), INJECTED)
def test_recovers_what_was_put_in(bench, measured_on, effect, place, truth, within):
    # a free tip hardly stretches a cable
    press = {'trajectory': 'paper_fig12', 'settings': (), 'touching': True}
    run = measured_on(bench, (effect, place, truth), **(press if 'cable' in place else {}))
    problem, fit = fitted(bench, run, effect, place)
    for name, value in truth.items():
        assert fit.model.values(0)[name] == pytest.approx(value, rel=within)
    assert fit.cost < 1.3 * len(fit.left)
    assert fit.cost < 0.8 * problem.fitted(problem.empty).cost


@pytest.mark.parametrize(('part', 'rate'), [(0.6, 1000.0), (1.3, 125.0)])
def test_with_another_controller_and_sampling(bench, measured_on, part, rate):
    soft = replace(
        bench,
        motors=tuple(
            replace(m, controller=replace(m.controller, kp=part * m.controller.kp, ki=30.0))
            for m in bench.motors
        ),
    )
    run = measured_on(soft, ('torque_gain', 'motor_M', {'gain': 1.15}), rate=rate)
    _, fit = fitted(bench, run, 'torque_gain', 'motor_M')
    # at 125 Hz smoothing takes some of the acceleration, which looks like gain
    assert fit.model.values(0)['gain'] == pytest.approx(1.15, rel=0.03)


def test_derivatives_tell_of_each_cause_alone(bench, measured_on):
    # both begin far off, the way is bent, and every step moves both
    run = measured_on(
        bench,
        ('contact_stiffness', 'contact', {'scale': 2.5}),
        ('load_cell_bias', 'load_cell', {'force': 2.0}),
        trajectory='paper_fig12',
        settings=(),
        touching=True,
    )
    problem = prepared([run], bench).problem
    model = problem.empty
    for cause in (
        Candidate('contact_stiffness', 'contact'),
        Candidate('load_cell_bias', 'load_cell'),
    ):
        model = model.joined(cause, {p.name: p.neutral for p in cause.parameters})
    fit = problem.fitted(model)
    [bias] = [j for j, name in enumerate(problem.labels(fit.model)) if 'load_cell_bias' in name]
    for channel, samples in problem.channels().items():
        seen = float(np.sum(fit.slope[samples, bias] ** 2))
        assert (seen > 0.0) == (channel == 'load_cell/force'), channel


def test_a_phase_is_found_from_any_start(measured_on):
    body = load_instrument('single_body')
    truth = {'torque': 0.2, 'phase': -1.2}
    run = measured_on(
        body,
        ('gravity', 'pulley_body', truth),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )
    _, fit = fitted(body, run, 'gravity', 'pulley_body')
    values = fit.model.values(0)
    # half a turn away and pulling the other way is the same
    wanted = 0.2 * np.exp(1j * truth['phase'])
    assert values['torque'] * np.exp(1j * values['phase']) == pytest.approx(wanted, abs=0.01)


def test_an_eccentric_drum_comes_back_from_the_end_of_its_amplitude(bench, measured_on):
    truth = {'amplitude': -0.086, 'phase': -0.25}
    run = measured_on(bench, ('eccentricity', 'pulley_M', truth))
    problem = prepared([run], bench).problem
    drum = Candidate('eccentricity', 'pulley_M')
    model = problem.empty.joined(drum, truth)
    beyond = replace(model, z=((-5.0, 9.1),))  # an amplitude of 0.208, beyond 0.2
    fit = problem.fitted(beyond, rounds=12)
    assert fit.cost == pytest.approx(problem.fitted(model, rounds=12).cost, rel=0.02)
    found = fit.model.values(0)
    along = found['amplitude'] * math.cos(found['phase'])
    assert along == pytest.approx(truth['amplitude'] * math.cos(truth['phase']), rel=0.01)


def test_sound_data_leave_noise_and_the_numbers_where_they_are(sound_problem):
    fit = sound_problem.fitted(sound_problem.empty)
    assert 0.4 * len(fit.left) < fit.cost < 1.2 * len(fit.left)
    assert np.abs(fit.model.moved).max() < 2.0
    assert sound_problem.structured(fit.left) < 0.1


def test_errors_of_a_percent_are_taken_by_the_tolerances(bench, measured_on):
    off = [
        ('inertia', 'pulley_3', {'scale': 1.02}),
        ('cable_stiffness', 'cable_L3', {'scale': 0.98}),
        ('viscous_friction', 'pulley_3', {'damping': 0.05}),
    ]
    problem = prepared([measured_on(bench, *off)], bench).problem
    before = float(np.sum(problem.left(problem.empty) ** 2))
    fit = problem.fitted(problem.empty)
    assert before > 2.0 * len(fit.left)
    assert fit.cost < 1.3 * len(fit.left)


def test_a_number_moves_no_farther_than_three_deviations(bench, measured_on):
    run = measured_on(bench, ('pretension', 'cable_L3', {'scale': 0.4}))
    fit = prepared([run], bench).problem
    done = fit.fitted(fit.empty)
    assert np.abs(done.model.moved).max() <= 3.0 + 1e-9
    assert done.cost > 1.5 * len(done.left)


def test_unknowns_survive_packing(sound_problem):
    model = sound_problem.empty.joined(
        Candidate('coulomb_friction', 'pulley_3'), {'torque': 0.07}
    ).joined(Candidate('gravity', 'pulley_2'), {'torque': 0.1, 'phase': 0.4})
    again = sound_problem.unpack(model, sound_problem.pack(model))
    assert again.values(0) == pytest.approx({'torque': 0.07})
    assert again.values(1) == pytest.approx({'torque': 0.1, 'phase': 0.4})
    smaller = again.without(0)
    assert smaller.values(0) == again.values(1)
    # without dry friction there is nothing to build up over an angle
    assert not smaller.bristle


def test_a_guessed_shape_of_the_curve_is_found(bench, measured_on):
    guessed = {'cable_L3.hardening': math.inf}
    run = measured_on(bench, ('cable_stiffness', 'cable_L3', {'scale': 1.0, 'hardening': 1.4}))
    problem = prepared([run], replace(bench, tolerances=guessed)).problem
    before = float(np.mean(problem.left(problem.empty) ** 2))
    fit = problem.fitted(problem.empty, rounds=20)
    found = {(t.place, t.quantity): t.axis.value(z) for t, z in problem.moved(fit.model)}
    assert found['cable_L3', 'hardening'] == pytest.approx(1.4, abs=0.05)
    assert fit.cost / len(fit.left) < 1.3 < before


def test_a_guessed_damping_of_a_cable_is_found_and_written(bench, measured_on):
    """Of a loop and of a coupling; whoever says that it is known keeps it."""
    loops = tuple(replace(x, damping=300.0) if x.name == 'L3' else x for x in bench.loops)
    run = measured_on(replace(bench, loops=loops))
    known = prepared([run], bench).problem
    assert ('cable_L3', 'damping') not in {(t.place, t.quantity) for t in known.tolerances}
    guessed = replace(bench, tolerances={'cable_L3.damping': math.inf})
    problem = prepared([run], guessed).problem
    fit = problem.fitted(problem.empty, rounds=20)
    [own] = [x for x in patched(problem, fit.model, guessed).loops if x.name == 'L3']
    assert own.damping == pytest.approx(300.0, rel=0.1)
    free = known.fitted(known.empty, rounds=20)
    assert fit.cost < 0.98 * free.cost
    tool = load_instrument('davinci_grasper')
    tool = replace(tool, tolerances={f'coupling_{tool.couplings[0].name}.damping': math.inf})
    [twist] = [t for t in tolerances(tool) if t.quantity == 'damping' and t.guessed]
    assert twist.axis.unit == 'N m s/rad'


def test_a_fit_that_cannot_be_computed_where_it_begins_goes_back_towards_the_file(
    bench, measured_on, monkeypatch
):
    guessed = {'cable_L3.stiffness': math.inf}
    problem = prepared([measured_on(bench)], replace(bench, tolerances=guessed)).problem
    [at] = [n for n, t in enumerate(problem.tolerances) if t.guessed]
    computed = problem.left

    def diverging(model):
        left = computed(model)
        return left if abs(model.moved[at]) < 0.6 else np.full_like(left, np.inf)

    monkeypatch.setattr(problem, 'left', diverging)
    far = np.zeros(len(problem.tolerances))
    far[at] = 2.0
    fit = problem.fitted(replace(problem.empty, moved=far))
    assert np.isfinite(fit.cost)
    assert fit.cost < 1.2 * len(fit.left)
    monkeypatch.setattr(problem, 'left', lambda model: np.full_like(computed(model), np.inf))
    assert problem.fitted(replace(problem.empty, moved=far)).cost == math.inf


def test_friction_that_the_file_lists_builds_up_over_an_angle(measured_on):
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.1})
    bent = ('presliding_friction', 'pulley_body', {'torque': 0.0, 'angle': 2e-3})
    settings = (('duration', '6 s'), ('amplitude', '3 deg'))
    run = measured_on(body, friction, bent, settings=settings)
    listed = replace(body, effects=(EffectUse(*friction),))
    problem = prepared([run], listed).problem
    rigid = float(np.mean(problem.left(problem.written) ** 2))
    fit = problem.fitted(problem.empty)
    assert rigid > 1.5
    assert fit.cost / len(fit.left) < 1.2
    assert fit.model.beside('pulley_body', 'angle') == pytest.approx(2e-3, rel=0.3)
    # beside another friction of the same pulley, and without it again
    joined = fit.model.joined(Candidate('tension_friction', 'pulley_body'), {'coefficient': 0.1})
    assert set(joined.without(0).bristle) == set(fit.model.bristle)
    # what the file's friction has bent to says nothing of how another's builds up
    assert not any(joined.bristle.values())
    known = prepared(
        [run], replace(body, effects=(EffectUse(*friction), EffectUse(*bent)))
    ).problem
    assert known.empty.bristle == {}
    assert np.mean(known.left(known.empty) ** 2) < 0.9 * rigid
