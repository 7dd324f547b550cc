"""What only an end of a pulley's range asks for is something that it touches there."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.ends import at_an_end, end_of_all
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

LIMIT = Candidate('torque_saturation', 'motor_axis')
SLOW = (('duration', '8 s'), ('amplitude', '25 deg'))


@pytest.fixture(scope='module')
def axis():
    """Return an axis of which inertia and damping are known, and its motor."""
    axis = load_instrument('driven_axis')
    [pulley] = axis.pulleys
    return replace(
        axis,
        pulleys=(replace(pulley, inertia=2e-3),),
        tolerances={'pulley_axis.inertia': 0.05, 'pulley_axis.damping': 0.1},
    )


@pytest.fixture(scope='module')
def runs(axis, measured_on):
    """Return two recordings of which the second meets a stop within its range, and the third."""
    [hand] = axis.contacts
    stop = replace(axis, contacts=(replace(hand, position=np.radians(12.0), stiffness=2e5),))
    free = [measured_on(axis, settings=SLOW, seed=n, name=f'free_{n}') for n in (1, 2)]
    return [*free, measured_on(stop, settings=SLOW, touching=True, seed=3, name='stopped')]


def test_a_torque_limit_that_only_a_stop_asks_for_is_none(axis, runs):
    problem = prepared(runs, axis).problem
    start = problem.fitted(problem.empty, rounds=6)
    final = problem.fitted(problem.empty.joined(LIMIT, {'limit': 0.5, 'knee': 0.1}), rounds=12)
    assert final.cost < 0.2 * start.cost
    assert at_an_end(problem, final, [start]) == {0}
    end = end_of_all(problem, start)
    assert (end.pulley, end.recordings) == ('axis', ('stopped',))
    assert end.angle == pytest.approx(np.radians(12.0), abs=0.01)


def test_a_limit_is_met_wherever_the_torque_is(axis, measured_on):
    limit = ('torque_saturation', 'motor_axis', {'limit': 0.03, 'knee': 0.005})
    run = measured_on(axis, limit, settings=SLOW)
    problem = prepared([run], axis).problem
    start = problem.fitted(problem.empty, rounds=6)
    final = problem.fitted(problem.empty.joined(LIMIT, {'limit': 0.03, 'knee': 0.005}), rounds=12)
    assert final.cost < 0.5 * start.cost
    assert not at_an_end(problem, final, [start])
    assert end_of_all(problem, start) is None


def test_a_stop_is_no_cause_of_the_catalogue(axis, runs):
    out = diagnose(runs, axis, jobs=1, plan=False)
    told = out.diagnosis
    assert not told.causes
    assert told.verdict == 'unexplained'
    # nor is it of use where nothing is touched
    assert all(one.effect != LIMIT.effect for one in told.beside)
    assert any('it touches something there' in said for said in told.doubts)
    # numbers of the file do not make up for it
    assert not any('end of its tolerance' in said for said in told.doubts)
    assert all(abs(one.off) < 1.0 for one in out.evidence.moved if one.quantity == 'inertia')
