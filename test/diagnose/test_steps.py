"""Steps of a search: what may not be named is not named under way either."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate

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
