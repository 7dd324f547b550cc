"""A torque constant beside a guessed inertia is no cause because a fit does not find back."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose import challenge
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.free_unit import without_unit
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

PUSH = Candidate('disturbance', 'pulley_body')
GAIN = Candidate('torque_gain', 'motor_body')
PUSHED = {'torque': -0.5, 'start': 3.0, 'duration': 1.0}


@pytest.fixture(scope='module')
def found(measured_on):
    """Return steps and a search that ended with three times the torque, inertia and push."""
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
    # the same without the constant, from which nothing has come down yet
    far = problem.fitted(final.model.without(0), rounds=0)
    steps = Steps(problem, [GAIN, PUSH], 1, lambda *_: None)
    rest = problem.fitted(final.model.without(1))
    return steps, Found(states=[start, final], rivals=[[], []], without=[far, rest])


def test_it_goes_where_all_torques_a_third_of_theirs_do_as_well(found):
    steps, search = found
    assert search.without[0].cost > search.start.cost
    state = without_unit(steps, search)
    assert state is not None
    assert state.model.causes == (PUSH,)
    assert state.model.values(0)['torque'] == pytest.approx(-0.5, rel=0.05)
    assert state.cost < 1.05 * search.final.cost


def test_it_stays_where_the_fit_without_it_has_come_down(found):
    steps, search = found
    other = replace(search, without=[search.start, search.without[1]])
    assert without_unit(steps, other) is None


def test_a_challenge_sends_it_away_once(found, monkeypatch):
    steps, search = found
    asked = []

    def known(_steps, of):
        asked.append(of.final)
        return of.final

    monkeypatch.setattr(challenge, 'without_unit', known)
    challenged = challenge.Challenge(steps, {})
    challenged.of(replace(search, states=[*search.states]))
    challenged.of(replace(search, states=[*search.states]))
    assert len(asked) == 1
