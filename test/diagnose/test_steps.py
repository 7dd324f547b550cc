"""Steps of a search: what may not be named is not named under way either."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import best_of, BRIEF, Steps
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.screening import Screen

CREEP = Candidate('cable_creep', 'cable_12')
SOFTER = Candidate('cable_stiffness', 'cable_12')


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


#: times what the file says, and what is added to dampings: where a fit from afar had ended
VALLEY = {
    'pulley_M.inertia': 1.163, 'pulley_L.inertia': 2.576, 'pulley_1.inertia': 0.91,
    'pulley_2.inertia': 0.969, 'pulley_3.inertia': 0.54, 'cable_m1.pretension': 2.159,
    'cable_m1.stiffness': 0.334, 'cable_12.pretension': 0.747, 'cable_12.stiffness': 1.657,
    'cable_L3.pretension': 0.431, 'cable_L3.stiffness': 0.796, 'pulley_M.damping': -0.018,
    'pulley_L.damping': 0.047, 'pulley_1.damping': 0.003, 'pulley_2.damping': 0.009,
    'pulley_3.damping': 0.072,
}  # fmt: skip


def test_guesses_get_out_of_a_valley_in_which_one_cable_is_soft_for_another():
    case = made(1075, 1, Settings(bench='guessed'))
    assert case.label['stratum'] == 'none'
    problem = prepared(list(case.recordings.values()), case.instrument).problem
    moved = [
        t.axis.place(VALLEY[name]) if (name := f'{t.place}.{t.quantity}') in VALLEY else 0.0
        for t in problem.tolerances
    ]
    stuck = problem.fitted(replace(problem.empty, moved=np.array(moved)), rounds=20)
    out = Steps(problem, [], 1, lambda *_: None).nudged(stuck)
    assert out.cost < 0.95 * stuck.cost
    assert problem.structured(out.left) < 0.5 * problem.structured(stuck.left)
    assert not out.model.causes


def test_nothing_is_nudged_where_nothing_is_guessed(soft):
    problem, start, _ = soft
    assert Steps(problem, [], 1, lambda *_: None).nudged(start) is start
