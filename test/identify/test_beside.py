"""Beside: a change is judged with everything free to move within its bounds."""

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.beside import Beside

FRICTION = ('viscous_friction', 'pulley_3', {'damping': 0.05})


@pytest.fixture(scope='module')
def state(bench, measured_on):
    """Return a problem whose tolerances are pressed against their ends, and its fit."""
    problem = prepared([measured_on(bench, FRICTION)], bench).problem
    return problem, problem.fitted(problem.empty)


def test_a_change_that_is_what_is_left_explains_all_of_it(state):
    problem, fit = state
    gain, sizes = Beside(problem, fit).best(fit.left[:, None], np.array([[-30.0], [30.0]]), [])
    assert gain > 0.9 * float(fit.left @ fit.left)
    # tolerances that were pressed go back by themselves
    assert sizes[0] < -0.5


def test_a_bound_is_kept(state):
    problem, fit = state
    bounds = np.array([[-0.25], [30.0]])
    _, sizes = Beside(problem, fit).best(fit.left[:, None], bounds, [])
    assert sizes[0] == pytest.approx(-0.25)


def test_what_tolerances_do_as_well_explains_nothing_more(state):
    problem, fit = state
    free = np.flatnonzero(problem.free(fit) & (np.abs(fit.slope).sum(axis=0) > 0.0))
    column = fit.slope[:, [free[-1]]]
    gain, _ = Beside(problem, fit).best(column, np.array([[-30.0], [30.0]]), [])
    assert gain < 0.05 * fit.cost
