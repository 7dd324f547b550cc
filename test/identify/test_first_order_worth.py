"""What causes are worth to first order, also where two do the very same."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.first_order_worth import growth, worths
from tendon_ros.model.instrument_file import load_instrument

BIAS = Candidate('torque_bias', 'motor_body')
DAMPED, RUBS = (Candidate(e, 'pulley_body') for e in ('viscous_friction', 'coulomb_friction'))


@pytest.fixture(scope='module')
def problem(measured_on):
    body = load_instrument('single_body')
    pushed = ('torque_bias', 'motor_body', {'torque': 0.1})
    settings = (('duration', '4 s'), ('amplitude', '30 deg'))
    return prepared([measured_on(body, pushed, settings=settings)], body).problem


@pytest.fixture(scope='module')
def state(problem):
    model = problem.empty.joined(BIAS, {'torque': 0.1}).joined(DAMPED, {'damping': 0.001})
    return problem.fitted(model.joined(RUBS, {'torque': 0.001}))


def test_a_cause_is_worth_what_squares_grow_by_without_it(problem, state):
    [bias, damped, rubs] = worths(problem, state)
    without = problem.fitted(state.model.without(0))
    assert bias == pytest.approx(without.cost - state.cost, rel=0.1)
    assert max(damped, rubs) < 0.01 * bias


def test_what_stays_may_do_the_very_same(problem, state):
    slope = state.slope.copy()
    # so large that nothing small can be added to their squares
    slope[:, 2] = slope[:, 1] = 2.0**40
    twins = replace(state, slope=slope, left=np.zeros_like(state.left))
    assert np.isfinite(growth(problem, twins)([0]))
