"""Parameters have to pay for themselves, and simplicity has its price."""

from dataclasses import replace
import math

import pytest

from tendon_ros.diagnose import parsimony
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.found import best_of, Found, Rival
from tendon_ros.diagnose.parsimony import as_good, criterion
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.screening import Screen

COULOMB = Candidate('coulomb_friction', 'pulley_3')
STRIBECK = Candidate('stribeck_friction', 'pulley_3')
FALLING = {'static': 0.3, 'sliding': 0.05, 'speed': 0.3}


@pytest.fixture(scope='module')
def problem(bench, measured_on):
    """Return the problem of a bench with friction that falls with speed."""
    run = measured_on(bench, (STRIBECK.effect, STRIBECK.place, FALLING))
    return prepared([run], bench).problem


def test_a_parameter_pays_by_the_second(problem):
    simple = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.2}), rounds=1)
    rich = problem.fitted(problem.empty.joined(STRIBECK, FALLING), rounds=1)
    seconds = 1 + problem.clusters(1.0).max()
    even = simple.cost * math.exp(-2.0 * math.log(seconds) / seconds)
    assert criterion(problem, replace(rich, cost=0.95 * even)) < criterion(problem, simple)
    assert criterion(problem, replace(rich, cost=1.05 * even)) > criterion(problem, simple)


@pytest.mark.parametrize(('apart', 'good'), [(0.95, True), (1.05, False)])
def test_no_simpler_cause_takes_the_place_of_one_that_is_a_better_bet(
    problem, monkeypatch, apart, good
):
    # laws and machine so far apart that any two fits tie
    monkeypatch.setattr(parsimony, 'tie', lambda *_: 1e6)
    simple = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.2}), rounds=1)
    rich = problem.fitted(problem.empty.joined(STRIBECK, FALLING), rounds=1)
    seconds = 1 + problem.clusters(1.0).max()
    even = simple.cost * math.exp(-2.0 * math.log(seconds) / seconds)
    assert as_good(problem, simple, replace(rich, cost=even / apart)) == good
    monkeypatch.setattr(parsimony, 'tie', lambda *_: 0.0)
    assert not as_good(problem, simple, replace(rich, cost=0.99 * simple.cost))


@pytest.mark.parametrize('given', [(), (('torque', 0.02),)])
@pytest.mark.parametrize(
    ('more', 'named'), [(0.3, Candidate('asymmetric_friction', 'pulley_3')), (0.04, COULOMB)]
)
def test_a_law_that_holds_another_pays_for_itself(bench, measured_on, more, named, given):
    """Friction that differs by a little is a fact of these data, and none of the machine."""
    whole = Candidate('asymmetric_friction', 'pulley_3')
    # the file may have some of it, and say how well it knows how much: it is wrong either way
    plain = replace(COULOMB, given=given, stated=bool(given))
    named = plain if named == COULOMB else named
    run = measured_on(bench, (COULOMB.effect, COULOMB.place, {'torque': 0.2}))
    problem = prepared([run], bench).problem
    steps = Steps(problem, [plain, whole], 1, lambda *_: None)
    start = problem.fitted(problem.empty)
    found = Found(proposals=best_of(steps.screened(Screen(problem, start))))
    model = problem.empty.joined(whole, {'forward': 0.22, 'backward': 0.18})
    simple = problem.fitted(problem.empty.joined(plain, {'torque': 0.2}))
    rich = problem.fitted(model)
    found.states += [start, replace(rich, cost=simple.cost - more * len(rich.left))]
    challenge = Challenge(steps, {})
    rivals = [Rival(plain, simple)]
    better = challenge._better(found, whole, start, rivals, brief=True)
    assert (whole if better is None else better.model.causes[0]) == named
