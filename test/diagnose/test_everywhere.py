"""Where numbers are guesses a search begins with all that usually is there, and keeps little."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose import everywhere as thinning
from tendon_ros.diagnose import first, search
from tendon_ros.diagnose.cancelling import undoing
from tendon_ros.diagnose.everywhere import (
    _unopposed,
    everywhere,
    LINEAR,
    thinned_out,
    USUAL,
    without_idle,
)
from tendon_ros.diagnose.guesses import far_off
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.residuals import FEW
from tendon_ros.model.instrument_file import load_instrument


@pytest.mark.parametrize('part', [1.0, 0.3])
def test_all_that_transmissions_usually_have(part):
    grasper = load_instrument('davinci_grasper')
    candidates = everyone(grasper, [s.channel for s in grasper.sensors])
    model = everywhere(candidates, Model((), (), {}, np.zeros(0)), part)
    places = {(c.effect, c.place) for c in model.causes}
    usual = {(c.effect, c.place) for c in candidates if c.effect in USUAL}
    assert usual - places == {('load_cell_bias', 'load_cell')}
    assert ('load_cell_bias', 'shaft_spindle') in places
    assert {effect for effect, _ in places} == set(USUAL)
    for k, cause in enumerate(model.causes):
        [size] = [p for p in cause.parameters if not p.is_shape and p.search != 'share']
        first = 0.0 if cause.effect in LINEAR else part * size.typical
        assert model.values(k)[size.name] == pytest.approx(first)


def test_only_what_is_needed_stays(measured_on):
    axis = load_instrument('driven_axis')
    pulleys = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    friction = ('coulomb_friction', 'pulley_axis', {'torque': 0.05})
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    run = measured_on(replace(axis, pulleys=pulleys), friction, settings=settings)
    problem = prepared([run], axis).problem
    candidates = everyone(axis, sorted(run.channels))
    assert sum(c.effect in USUAL for c in candidates) > 2
    steps = Steps(problem, candidates, 1, lambda *_: None)
    fit = thinned_out(steps, problem.fitted(problem.empty), 8)
    assert [(c.effect, c.place) for c in fit.model.causes] == [friction[:2]]
    assert problem.structured(fit.left) < 0.1


def test_of_many_recordings_a_few_tell_what_goes(measured_on, monkeypatch):
    axis = load_instrument('driven_axis')
    pulleys = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    friction = ('coulomb_friction', 'pulley_axis', {'torque': 0.05})
    settings = (('duration', '3 s'), ('amplitude', '40 deg'))
    heavy = replace(axis, pulleys=pulleys)
    runs = [
        measured_on(heavy, friction, settings=settings, seed=seed, name=f'run{seed}')
        for seed in range(FEW + 2)
    ]
    problem = prepared(runs, axis).problem
    steps = Steps(problem, everyone(axis, sorted(runs[0].channels)), 1, lambda *_: None)
    looked = []
    glanced = thinning._glanced

    def noted(asked, *args):
        looked.append(len(asked.rollouts.segments))
        return glanced(asked, *args)

    monkeypatch.setattr(thinning, '_glanced', noted)
    fit = thinned_out(steps, problem.fitted(problem.empty), 8)
    assert set(looked) == {FEW}
    assert [(c.effect, c.place) for c in fit.model.causes] == [friction[:2]]
    assert len(fit.left) == len(problem.left(fit.model))


def test_what_is_worth_nothing_by_other_weights_goes(measured_on):
    """A spring that is relaxed turns away, and a bias: no torque together, a large one each."""
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    run = measured_on(body, friction)
    problem = prepared([run], body).problem
    model = problem.empty.joined(Candidate(*friction[:2]), {'torque': 0.2})
    model = model.joined(Candidate('torque_bias', 'motor_body'), {'torque': 0.02})
    model = model.joined(
        Candidate('joint_spring', 'pulley_body'), {'stiffness': 2e-4, 'rest': -94.0}
    )
    state = problem.fitted(model, rounds=3)
    steps = Steps(problem, [], 1, lambda *_: None)
    left = without_idle(steps, state)
    assert left.model.causes == (Candidate(*friction[:2]),)
    assert without_idle(steps, left) is left


def test_guesses_that_explain_all_but_noise_ask_for_no_many(measured_on, monkeypatch):
    axis = load_instrument('driven_axis')
    pulleys = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    asked = []
    monkeypatch.setattr(first, 'thinned_out', lambda *_: asked.append(1))

    def searched(*effects):
        settings = (('duration', '6 s'), ('amplitude', '40 deg'))
        run = measured_on(replace(axis, pulleys=pulleys), *effects, settings=settings)
        problem = prepared([run], axis).problem
        asked.clear()
        found = search.Search(problem, everyone(axis, sorted(run.channels)), 1).run()
        return far_off(problem, found.start), len(asked)

    # the inertia has gone as far both times
    assert searched() == (True, 0)
    assert searched(('coulomb_friction', 'pulley_axis', {'torque': 0.1})) == (True, 1)


def test_of_causes_that_undo_each_other_one_goes_first(measured_on):
    """A spring that is relaxed turns away, and a bias that takes its torque back."""
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    run = measured_on(body, friction)
    problem = prepared([run], body).problem
    steps = Steps(problem, [], 1, lambda *_: None)
    model = problem.empty.joined(Candidate(*friction[:2]), {'torque': 0.2})
    alone = problem.fitted(model)
    assert _unopposed(steps, problem, alone) is None
    model = model.joined(Candidate('torque_bias', 'motor_body'), {'torque': 0.2})
    model = model.joined(
        Candidate('joint_spring', 'pulley_body'), {'stiffness': 2e-3, 'rest': -94.0}
    )
    opposed = problem.fitted(model, rounds=1)
    assert undoing(problem, opposed) == {1, 2}
    kept = _unopposed(steps, problem, opposed)
    assert kept is not None
    assert Candidate(*friction[:2]) in kept.model.causes
    assert len(kept.model.causes) == 2


def test_what_torque_drives_is_begun_from_afar(far_off_whole_belt):
    """The file has the belt ten times too soft and motors that are three times too heavy."""
    problem = far_off_whole_belt
    belt = problem.rollouts.instrument
    candidates = everyone(belt, [s.channel for s in belt.sensors])
    sign = Candidate('sensor_rectified', 'speed_roller')
    without_sign = problem.empty.joined(sign, {'rectified': 1.0})
    steps = Steps(problem, candidates, 1, lambda *_: None)
    fit = thinned_out(steps, problem.fitted(problem.empty), 6, without_sign)
    found = {
        (t.place, t.quantity): t.axis.value(float(z))
        for t, z in zip(problem.tolerances, fit.model.moved, strict=True)
    }
    # in proportion to the torque, of which the unit is guessed as well
    spans = found['cable_upper', 'stiffness'] * found['cable_lower', 'stiffness']
    # the file holds them back where guesses do not lean elsewhere
    assert 3.0 < np.sqrt(spans) / found['motor_left', 'torque_gain'] < 20.0
    for motor in ('left', 'right'):
        heavy = found[f'pulley_{motor}', 'inertia'] / found[f'motor_{motor}', 'torque_gain']
        assert 0.2 < heavy < 0.45
    assert fit.cost < 0.2 * problem.fitted(without_sign, rounds=20).cost
