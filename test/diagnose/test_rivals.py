"""Rivals that come near, and what held one of them back."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.rivals import (
    alike,
    bared,
    close_ones,
    contested,
    halfway,
    relieved,
    sharpened,
)
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.warm_start import Begun
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.screening import Screen

COULOMB = Candidate('coulomb_friction', 'pulley_3')
DAMPED = Candidate('viscous_friction', 'pulley_L')
WEIGHT = Candidate('gravity', 'pulley_3')
SPRING = Candidate('joint_spring', 'pulley_3')
FAR = Candidate('torque_bias', 'motor_M')


def test_what_is_worth_least_beside_a_rival_is_left_out_for_it(bench, measured_on):
    run = measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': 0.05}),
        ('viscous_friction', 'pulley_L', {'damping': 0.6}),
    )
    problem = prepared([run], bench).problem
    # a bias of which there is none, far from where it would be fitted to
    stuck = problem.empty.joined(DAMPED, {'damping': 0.6}).joined(FAR, {'torque': 0.004})
    rival = problem.fitted(stuck.joined(COULOMB, {'torque': 0.05}), rounds=1)
    smaller = relieved(problem, rival)
    assert smaller.model.causes == (DAMPED, COULOMB)
    assert smaller.cost < 1.01 * rival.cost
    alone = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.05}), rounds=1)
    assert relieved(problem, alone) is None


def test_two_that_share_what_they_do_are_each_left_out_to_see(bench, measured_on):
    there = {
        Candidate('contact_stiffness', 'contact'): {'scale': 0.27},
        Candidate('backlash', 'motor_M'): {'angle': 0.003, 'held': 0.0},
    }
    effects = [(c.effect, c.place, values) for c, values in there.items()]
    problem = prepared([measured_on(bench, *effects, touching=True)], bench).problem
    # a softer cable has taken half of what the contact yields, and first order holds it for more
    cable = Candidate('cable_stiffness', 'cable_m1')
    model = problem.empty.joined(cable, {'scale': 0.4})
    for cause, values in there.items():
        model = model.joined(cause, values | ({'scale': 0.43} if 'scale' in values else {}))
    smaller = relieved(problem, problem.fitted(model, rounds=1))
    assert smaller.model.causes == tuple(there)
    assert smaller.model.values(0)['scale'] == pytest.approx(0.27, rel=0.01)


def test_near_is_half_of_a_cause_and_close_nearly_all(bench, measured_on):
    problem = prepared([measured_on(bench)], bench).problem
    fit = problem.fitted(problem.empty, rounds=0)
    samples = float(len(fit.left))
    state, without = (replace(fit, cost=part * samples) for part in (1.0, 11.0))
    rivals = [
        Rival(one, replace(fit, cost=part * samples))
        for one, part in ((COULOMB, 1.4), (WEIGHT, 1.8), (DAMPED, 5.0), (FAR, 7.0))
    ]
    assert halfway(state, without, rivals) == [COULOMB, WEIGHT, DAMPED]
    assert close_ones(problem, state, without, rivals) == rivals[:2]
    # of what stays of channels less is noise
    machine = SimpleNamespace(by_misfit=True, structured=problem.structured)
    assert close_ones(machine, state, without, rivals) == rivals[:1]
    # who comes that near may be the cause; the same effect elsewhere is of the same kind
    cause = Candidate('coulomb_friction', 'pulley_M')
    state = replace(state, model=SimpleNamespace(causes=(cause,)))
    for others, said in ((rivals, {cause}), (rivals[:1], set()), (rivals[2:], set())):
        found = Found(states=[state], rivals=[others], without=[without])
        assert contested(problem, found) == said


@pytest.mark.parametrize(('here', 'fits'), [(1.3, 2), (0.9, 1)])
def test_who_is_only_as_good_by_derivatives_of_another_state_is_fitted_again(here, fits):
    asked = []

    def fitted(model, known=None, **_):
        asked.append(known)
        return Fit(model, left, np.zeros((100, 0)), 100.0 * (here if known else 0.7))

    left = np.ones(100)
    problem = SimpleNamespace(
        by_misfit=False, structured=lambda _left: 1.0, slopes=lambda _fit: {'own': left},
        fitted=fitted,
    )  # fmt: skip
    steps = SimpleNamespace(problem=problem, pool=SimpleNamespace(map=map))
    state, without, rival = (
        Fit(None, left, np.zeros((100, 0)), cost) for cost in (100.0, 900.0, 140.0)
    )
    [found] = sharpened(steps, state, without, [Rival(COULOMB, rival)], 3)
    assert found.fit.cost == pytest.approx(90.0 if fits == 1 else 70.0)
    assert len(asked) == fits


def test_a_rival_is_asked_to_do_what_the_cause_does_beside_the_others(bench, measured_on):
    run = measured_on(
        bench,
        ('gravity', 'pulley_3', {'torque': 0.5, 'phase': -0.03}),
        ('viscous_friction', 'pulley_L', {'damping': 0.6}),
    )
    problem = prepared([run], bench).problem
    both = problem.empty.joined(DAMPED, {'damping': 0.6})
    both = both.joined(WEIGHT, {'torque': 0.5, 'phase': -0.03})
    state = problem.fitted(both, rounds=2)
    bare = bared(problem, state, 1)
    assert bare.model.causes == (DAMPED,)
    np.testing.assert_array_equal(bare.model.moved, state.model.moved)
    np.testing.assert_array_equal(bare.left, problem.left(state.model.without(1)))
    columns = dict(zip(problem.labels(bare.model), bare.slope.T, strict=True))
    for label, column in problem.slopes(state).items():
        if label in columns:
            np.testing.assert_array_equal(columns[label], column)
    # at small angles a spring is a weight, and that is what it is asked to be
    screen = Screen(problem, bare)
    [best, *_] = screen.proposals(SPRING)
    spring = screen.corrected(best).values
    assert spring['stiffness'] == pytest.approx(state.model.values(1)['torque'], rel=0.1)
    assert spring['rest'] == pytest.approx(state.model.values(1)['phase'], abs=0.01)
    # and so is one that has come near, for it may be held back where it is
    steps = Steps(problem, [SPRING], 1, lambda *_: None)
    without = problem.fitted(problem.empty.joined(DAMPED, {'damping': 0.6}))
    near = state.cost + 0.01 * (without.cost - state.cost)
    stays = Rival(SPRING, Fit(bare.model.joined(SPRING, spring), bare.left, bare.slope, near))
    [again] = Begun(steps).beside_the_others(state, WEIGHT, without, [stays])
    assert again.candidate == SPRING
    assert again.fit.cost < near


def test_other_dry_frictions_of_one_pulley_are_alike_and_what_leads_it_back():
    other = Candidate('tension_friction', 'pulley_3')
    assert alike(COULOMB, other)
    assert not alike(COULOMB, COULOMB)
    assert not alike(COULOMB, Candidate('tension_friction', 'pulley_L'))
    assert not alike(COULOMB, WEIGHT)
    assert alike(WEIGHT, SPRING)
    assert not alike(WEIGHT, WEIGHT)
    assert not alike(WEIGHT, Candidate('joint_spring', 'pulley_L'))
