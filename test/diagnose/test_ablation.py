"""A torque constant beside a guessed inertia is no cause because a fit does not find back."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose.ablation import left_out, sets_the_unit
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

PUSH = Candidate('disturbance', 'pulley_body')
GAIN = Candidate('torque_gain', 'motor_body')
PUSHED = {'torque': -0.5, 'start': 3.0, 'duration': 1.0}


@pytest.fixture(scope='module')
def search(measured_on):
    """Return a problem, and a search that ended with three times the torque, inertia and push."""
    body = load_instrument('single_body')
    body = replace(body, tolerances=body.tolerances | {'pulley_body.inertia': math.inf})
    run = measured_on(body, (PUSH.effect, PUSH.place, PUSHED))
    problem = prepared([run], body).problem
    start = problem.fitted(problem.empty)
    three = [
        t.axis.place(3.0) if (t.place, t.quantity) == ('pulley_body', 'inertia') else 0.0
        for t in problem.tolerances
    ]
    model = replace(problem.empty, moved=np.array(three)).joined(GAIN, {'gain': 3.0})
    final = problem.fitted(model.joined(PUSH, PUSHED | {'torque': -1.5}), rounds=0)
    return problem, Found(states=[start, final])


def test_without_it_all_torques_are_a_third_of_theirs(search):
    problem, found = search
    state = left_out(problem, found.final, 0, rounds=3, accuracy=1e-3)
    assert state.model.causes == (PUSH,)
    assert state.model.values(0)['torque'] == pytest.approx(-0.5, rel=0.05)
    assert state.cost < 1.05 * found.final.cost


def test_only_a_guess_may_be_scaled_along_with_it(search, measured_on):
    problem, found = search
    assert sets_the_unit(problem, found.final.model, 0)
    assert not sets_the_unit(problem, found.final.model, 1)
    body = load_instrument('single_body')
    measured = prepared([measured_on(body)], body).problem
    assert not sets_the_unit(measured, measured.empty.joined(GAIN, {'gain': 3.0}), 0)


def test_a_challenge_sends_it_away(search):
    problem, found = search
    steps = Steps(problem, [GAIN, PUSH], 1, lambda *_: None)
    challenged = replace(found, states=[*found.states])
    # that two on one body may be one is asked elsewhere
    Challenge(steps, {}).of(challenged, brief=True)
    assert challenged.final.model.causes == (PUSH,)
    assert challenged.final.model.values(0)['torque'] == pytest.approx(-0.5, rel=0.05)
