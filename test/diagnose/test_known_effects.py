"""Effects of the file that it says how well it knows: causes only beyond that."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.bent import degenerate
from tendon_ros.diagnose.intervals import parameter_intervals, unsized
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import everyone
from tendon_ros.model.instrument_file import load_instrument

SETTINGS = (('duration', '10 s'), ('amplitude', '40 deg'))


@pytest.fixture
def arm():
    """Return an arm whose weight is known to 5 % and 1 deg, and its torque in N m."""
    body = load_instrument('pendulum_arm')
    known = {name: spread for name, spread in body.tolerances.items() if 'torque_gain' not in name}
    return replace(body, tolerances={**known, 'pulley_arm.inertia': 0.05})


def weighing(arm, torque, phase=0.0):
    """Return the arm with another weight."""
    [weight] = arm.effects
    weight = replace(weight, parameters={'torque': torque, 'phase': phase})
    return replace(arm, effects=(weight,))


@pytest.fixture
def weight(arm):
    """Return the candidate that the weight is another one."""
    measured = [s.channel for s in arm.sensors]
    [found] = [c for c in everyone(arm, measured) if c.effect == 'gravity']
    return found


@pytest.mark.parametrize(
    ('torque', 'phase', 'tolerated'),
    [(0.44, 0.02, True), (0.5, 0.02, False), (0.44, 0.1, False)],
)
def test_an_effect_of_the_file_is_none_within_its_tolerances(
    arm, weight, measured_on, torque, phase, tolerated
):
    problem = prepared([measured_on(arm, settings=SETTINGS)], arm).problem
    assert degenerate(problem, weight, {'torque': torque, 'phase': phase}) is tolerated


@pytest.mark.parametrize(
    ('torque', 'phase', 'named'), [(0.6, 0.0, True), (0.4, 0.2, True), (0.41, 0.005, False)]
)
def test_a_weight_beyond_its_tolerance_is_a_cause_or_cannot_be_told_from_one(
    arm, measured_on, torque, phase, named
):
    run = measured_on(weighing(arm, torque, phase), settings=SETTINGS)
    told = diagnose([run], arm, jobs=1, plan=False).diagnosis
    found = {
        (c.effect, c.place) for cause in told.causes for c in (cause, *cause.indistinguishable)
    }
    assert (('gravity', 'pulley_arm') in found) is named
    assert told.verdict == ('explained' if named else 'no_gap')


@pytest.mark.parametrize(('torque', 'phase', 'sized'), [(0.6, 0.0, True), (0.42, 0.0, False)])
def test_a_weight_that_may_be_within_its_tolerance_has_no_size(
    arm, weight, measured_on, torque, phase, sized
):
    """By its interval, which is wider where torque constant and inertia are hardly known."""
    run = measured_on(weighing(arm, torque, phase), settings=SETTINGS)
    for rig, told in ((arm, sized), (load_instrument('pendulum_arm'), False)):
        problem = prepared([run], rig).problem
        values = {'torque': torque, 'phase': phase}
        fit = problem.fitted(problem.empty.joined(weight, values), rounds=6)
        assert (0 not in unsized(problem, fit)) is told


def test_a_weight_at_another_angle_is_there_whatever_its_law_gets_wrong(arm, weight, measured_on):
    """Of an angle laws get some degrees wrong, more than it may be off by the file."""
    values = {'torque': 0.4, 'phase': 0.1}
    problem = prepared([measured_on(weighing(arm, **values), settings=SETTINGS)], arm).problem
    fit = problem.fitted(problem.empty.joined(weight, values), rounds=6)
    [row] = parameter_intervals(problem, fit)
    [alone] = parameter_intervals(problem, fit, laws=False)
    farthest = next(t.axis.high for t in problem.tolerances if t.quantity == 'gravity.phase')
    assert row['phase'][0] < farthest < alone['phase'][0] < 0.1
    assert not unsized(problem, fit)


def test_of_equals_what_contradicts_a_measurement_comes_last(arm, weight):
    """A weight that was weighed costs one parameter more than one of which nothing is said."""
    assert weight.price == len(weight.parameters) + 1
    silent = replace(arm, tolerances={})
    [other] = [
        c
        for c in everyone(silent, [s.channel for s in arm.sensors])
        if c == replace(weight, stated=False)
    ]
    assert other.price == len(other.parameters)


@pytest.mark.parametrize('known', [{'pulley_arm.gravity.torque': 0.05}, {}])
def test_another_phase_of_which_nothing_is_said_is_another_weight(arm, measured_on, known):
    """Its torque is as the file has it; less said in the file hides nothing."""
    plain = {n: s for n, s in arm.tolerances.items() if 'gravity' not in n}
    silent = replace(arm, tolerances={**plain, **known})
    [weight] = [
        c for c in everyone(silent, [s.channel for s in arm.sensors]) if c.effect == 'gravity'
    ]
    run = measured_on(weighing(arm, 0.4, 0.3), settings=SETTINGS)
    problem = prepared([run], silent).problem
    values = {'torque': 0.4, 'phase': 0.3}
    fit = problem.fitted(problem.empty.joined(weight, values), rounds=6)
    assert not unsized(problem, fit)
