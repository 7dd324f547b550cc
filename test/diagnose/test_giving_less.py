"""A motor that for a while gives less than it reports is no push."""

import numpy as np
import pytest

from tendon_ros.diagnose.belief import belief
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.giving_less import _with_less, BRIEF, ENDS, giving_less
from tendon_ros.diagnose.judge import IDLE
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate

EFFORT = 'actuator/pulley_M/effort'
PUSH = Candidate('disturbance', 'pulley_M')
LIMIT = Candidate('torque_saturation', 'motor_M')
WHEN = {'start': 1.5, 'duration': 1.2}


@pytest.fixture(scope='module')
def fitted_to(bench, measured_on, spoilt):
    """Return a way to fits of some causes to a recording of the bench."""

    def fit(effects, causes, change=None, **motion):
        runs = (measured_on(bench, *effects, **motion),)
        runs = spoilt(runs, EFFORT, change) if change else runs
        ready = prepared(runs, bench)
        model = ready.problem.empty
        for candidate, values in causes:
            model = model.joined(candidate, values)
        return ready, ready.problem.fitted(model)

    return fit


def dipped(time, value):
    """Return a torque of which a third is reported and not given, for a while."""
    less = (time >= WHEN['start']) & (time < WHEN['start'] + WHEN['duration'])
    return time, np.where(less, 1.5 * value, value)


def test_what_is_in_proportion_to_the_torque_is_no_push(fitted_to):
    begun = [(PUSH, {'torque': -0.5, **WHEN})]
    ready, state = fitted_to((), begun, dipped)
    assert giving_less(ready.problem, state) == {0}
    empty = ready.problem.fitted(ready.problem.empty)
    found = Found(states=[empty, state], rivals=[[]], without=[empty])
    [weighed] = belief(ready, found).weighed
    assert weighed.chance <= IDLE


def test_pushes_within_one_another_are_no_more(fitted_to):
    """What a motor gives less has its own ends: those of the pushes excuse nothing before."""
    within = {'torque': -0.1, 'start': 1.9, 'duration': 0.4}
    begun = [(PUSH, {'torque': -0.5, **WHEN}), (PUSH, within)]
    steady = {'trajectory': 'paper_fig12', 'settings': (), 'touching': True}
    ready, state = fitted_to((), begun, dipped, **steady)
    assert giving_less(ready.problem, state) == {0, 1}


def test_who_helps_such_a_push_goes_with_it(fitted_to):
    begun = [
        (PUSH, {'torque': -0.5, **WHEN}),
        (LIMIT, {'limit': 2.0, 'knee': 0.5}),
        (Candidate('coulomb_friction', 'pulley_L'), {'torque': 0.1}),
    ]
    friction = ('coulomb_friction', 'pulley_L', {'torque': 0.1})
    ready, state = fitted_to((friction,), begun, dipped)
    assert 0 in giving_less(ready.problem, state)
    assert 2 not in giving_less(ready.problem, state)


def test_what_stays_elsewhere_excuses_no_push(fitted_to):
    """A friction that nobody thought of leaves much, but not while the motor gives less."""
    friction = ('coulomb_friction', 'pulley_L', {'torque': 0.3})

    def dip(time, value):
        less = (time >= WHEN['start']) & (time < WHEN['start'] + WHEN['duration'])
        return time, np.where(less, 1.2 * value, value)

    ready, state = fitted_to((friction,), [(PUSH, {'torque': -0.2, **WHEN})], dip)
    assert giving_less(ready.problem, state) == {0}


@pytest.mark.parametrize('torque', [-0.5, 0.3])
def test_a_push_is_one(fitted_to, torque):
    push = ('disturbance', 'pulley_M', {'torque': torque, **WHEN})
    friction = ('coulomb_friction', 'pulley_M', {'torque': 0.1})
    begun = [(PUSH, push[2]), (Candidate(*friction[:2]), friction[2])]
    ready, state = fitted_to((push, friction), begun)
    assert giving_less(ready.problem, state) == frozenset()


def test_only_pushes_on_motors_are_asked(fitted_to):
    push = ('disturbance', 'pulley_3', {'torque': 0.3, **WHEN})
    ready, state = fitted_to((push,), [(Candidate(*push[:2]), push[2])])
    assert giving_less(ready.problem, state) == frozenset()


@pytest.mark.parametrize('bins', [BRIEF, 130, 20 * ENDS])
def test_the_stretch_is_found_in_short_and_long_ones(bins):
    time = 8e-3 * np.arange(bins)
    known = 50.0 * np.sin(time) + 60.0
    less = (time > 0.4 * time[-1]) & (time < 0.7 * time[-1])
    stays = _with_less(0.5 * known * less, known, time)
    if bins == BRIEF:
        assert np.array_equal(stays, 0.5 * known * less)
    else:
        assert np.max(np.abs(stays)) <= 2.0
    # less than nothing is reported by no motor
    assert np.max(np.abs(_with_less(-0.5 * known * less, known, time))) > 2.0


def test_what_went_along_with_it_is_not_written(bench, measured_on, spoilt):
    """Numbers within tolerance, moved to what nothing explains, foretell worse than the file."""

    def halved(time, value):
        less = (time >= WHEN['start']) & (time < WHEN['start'] + WHEN['duration'])
        return time, np.where(less, 2.0 * value, value)

    runs = spoilt((measured_on(bench),), EFFORT, halved)
    outcome = diagnose(runs, bench, jobs=1, plan=False)
    assert outcome.diagnosis.verdict == 'unexplained'
    assert any('left as they are' in line for line in outcome.diagnosis.left_out)
    assert all(gap.after == gap.before for gap in outcome.diagnosis.gap)
    assert outcome.instrument.pulleys == bench.pulleys
    assert outcome.instrument.loops == bench.loops
