"""An event that stands out from all other times, and one that fits what a law gets wrong."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.outstanding import stands_out_in_time
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.worth import worthwhile
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

PUSH = Candidate('disturbance', 'pulley_body')
RUBS = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
LONG = (('duration', '8 s'), ('amplitude', '40 deg'))


@pytest.fixture(scope='module')
def body():
    """Return one body on a motor."""
    return load_instrument('single_body')


@pytest.fixture(scope='module')
def pushed(body, measured_on):
    """Return the problem of a body that rubs and is pushed once, without and with the push."""
    values = {'torque': 0.05, 'start': 4.0, 'duration': 0.6}
    run = measured_on(body, RUBS, ('disturbance', 'pulley_body', values), settings=LONG)
    problem = prepared([run], body).problem
    rubbing = problem.fitted(problem.empty.joined(Candidate(*RUBS[:2]), RUBS[2]))
    return problem, rubbing, problem.fitted(rubbing.model.joined(PUSH, values))


def leaving(problem, fit, *spans, size=3.0):
    """Return a fit that leaves more at some times [s]."""
    [segment] = problem.rollouts.segments
    within = [(segment.time >= begun) & (segment.time < ended) for begun, ended in spans]
    at = problem.sampled([np.any([*within, np.zeros(len(segment.time), dtype=np.bool_)], axis=0)])
    left = np.where(at, size, 1.0)
    return replace(fit, left=left, cost=float(left @ left))


def test_a_push_beside_a_friction_stands_out_and_is_worth_having(pushed):
    problem, rubbing, both = pushed
    start = problem.fitted(problem.empty)
    assert stands_out_in_time(problem, rubbing, both, PUSH)
    assert worthwhile(problem, start, rubbing, both)


@pytest.mark.parametrize(
    ('others', 'told'),
    [
        ((), True),
        # as much is left once more, for as long: so much do laws get wrong
        (((6.0, 6.6),), False),
        # for a tenth of the time only
        (((6.0, 6.06),), True),
    ],
)
def test_what_comes_again_does_not_stand_out(pushed, others, told):
    problem, _, both = pushed
    [values] = [both.model.values(1)]
    own = values['start'], values['start'] + values['duration']
    without = leaving(problem, both, own, *others)
    assert stands_out_in_time(problem, without, leaving(problem, both, *others), PUSH) is told
    # nor does what leaves as much once it is known
    assert not stands_out_in_time(problem, without, without, PUSH)


def test_what_lasts_for_all_of_the_recordings_does_not(pushed):
    problem, rubbing, both = pushed
    model = rubbing.model.joined(PUSH, {'torque': 0.05, 'start': 0.0, 'duration': 100.0})
    always = replace(both, model=model)
    assert not stands_out_in_time(problem, leaving(problem, both, (0.0, 100.0)), always, PUSH)
