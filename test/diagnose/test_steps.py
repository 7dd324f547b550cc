"""Steps of a search: what may not be named is not named under way either."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.found import best_of
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import BRIEF, LEADERS, Steps
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.screening import Screen

CREEP = Candidate('cable_creep', 'cable_12')
SOFTER = Candidate('cable_stiffness', 'cable_12')
FRICTION = ('coulomb_friction', 'pulley_M')


@pytest.fixture(scope='module')
def soft(bench, measured_on):
    """Return the problem of a bench with a softer cable, and a fit that calls it creep."""
    softer = (SOFTER.effect, SOFTER.place, {'scale': 0.6})
    run = measured_on(bench, softer, touching=True, trajectory='paper_fig12', settings=())
    problem = prepared([run], bench).problem
    start = problem.fitted(problem.empty)
    model = problem.empty.joined(CREEP, {'fraction': 0.4, 'time': 0.01, 'share': 0.5})
    state = problem.fitted(model, rounds=0)
    return problem, start, replace(state, slope=np.zeros_like(state.slope))


@pytest.mark.parametrize(
    ('candidates', 'named'), [((CREEP, SOFTER), [SOFTER]), ((CREEP,), [])], ids=['all', 'withheld']
)
def test_creep_that_is_over_at_once_takes_no_name_that_was_withheld(soft, candidates, named):
    problem, start, state = soft
    steps = Steps(problem, candidates, 1, lambda *_: None)
    assert list(steps.pruned(start, state).model.causes) == named


def test_a_spring_that_is_relaxed_turns_away_goes_by_the_name_of_the_motors_bias(soft):
    problem, _, _ = soft
    spring = Candidate('joint_spring', 'pulley_M')
    bias = Candidate('torque_bias', 'motor_M')
    far = problem.empty.joined(spring, {'stiffness': 0.002, 'rest': 60.0})
    steps = Steps(problem, [spring, bias], 1, lambda *_: None)
    named = steps.renamed(problem.fitted(far, rounds=0))
    assert named.model.causes == (bias,)
    assert named.cost < problem.fitted(far, rounds=0).cost


def test_a_brief_look_fits_few_and_the_right_one_among_them(soft, bench):
    problem, start, _ = soft
    steps = Steps(problem, everyone(bench, [s.channel for s in bench.sensors]), 1, lambda *_: None)
    proposals = best_of(steps.screened(Screen(problem, start)))
    brief = steps.fitted(start, proposals, 0.0, brief=True)
    assert len(brief) <= BRIEF < len(steps.fitted(start, proposals, 0.0))
    assert SOFTER in [rival.candidate for rival in brief]


def test_who_comes_first_is_fitted_though_first_order_sees_little_of_it(soft, bench):
    problem, start, _ = soft
    steps = Steps(problem, everyone(bench, [s.channel for s in bench.sensors]), 1, lambda *_: None)
    found = best_of(steps.screened(Screen(problem, start)))[: LEADERS + 4]
    seen = replace(found[-2], gain=0.5), replace(found[-1], gain=0.05)
    little = [replace(p, gain=0.2) for p in found[:-2]]
    fits = steps.fitted(start, [*little, *seen], 1.0)
    asked = [*little[:LEADERS], seen[0]]
    assert {rival.candidate for rival in fits} <= {p.candidate for p in asked}
    assert len(fits) > 2
    assert SOFTER in [rival.candidate for rival in fits]


def test_a_limit_that_sinks_is_kept_for_those_beside_it(sound_problem):
    limit, friction = Candidate('torque_saturation', 'motor_M'), Candidate(*FRICTION)
    sunk = sound_problem.empty.joined(limit, {'limit': 0.005, 'knee': 0.01})
    beside = sunk.joined(friction, {'torque': 0.05})
    steps = Steps(sound_problem, [limit, friction], 1, lambda *_: None)
    alone, both = (sound_problem.fitted(model, rounds=0) for model in (sunk, beside))
    assert steps.renamed(alone, [limit]).model.causes == ()
    assert steps.renamed(both, [limit]) is both
    # but none comes in like that
    assert steps.renamed(both).model.causes == (friction,)
