"""Guesses of the file that have far to go: the right cause is found beside them."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose.belief import Belief
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.gather import alternatives, read_right
from tendon_ros.diagnose.guesses import astray, better, under_way
from tendon_ros.diagnose.intervals import number_intervals
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.signals import Signals

COULOMB = Candidate('coulomb_friction', 'pulley_axis')
STRIBECK = Candidate('stribeck_friction', 'pulley_axis')


@pytest.fixture(scope='module')
def axis():
    return load_instrument('driven_axis')


@pytest.fixture(scope='module')
def problem(axis, measured_on):
    """Return a problem of an axis whose inertia is half of what the file guesses."""
    pulleys = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    rig = replace(axis, pulleys=pulleys)
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    friction = ('coulomb_friction', 'pulley_axis', {'torque': 0.05})
    return prepared([measured_on(rig, friction, settings=settings)], axis).problem


def test_guesses_that_moved_may_have_done_without_the_causes(problem):
    start = problem.fitted(problem.empty)
    assert astray(problem, start, None)
    still = problem.fitted(problem.empty, rounds=0)
    assert not astray(problem, still, still)


def test_causes_beside_which_all_numbers_are_in_place_need_no_look_from_the_file(problem):
    still = problem.fitted(problem.empty, rounds=0)
    known = np.array([not t.guessed for t in problem.tolerances])
    assert known.any()

    def moved(fit, deviations):
        return replace(fit, model=replace(fit.model, moved=np.where(known, deviations, 0.0)))

    values = {'static': 0.05, 'sliding': 0.05, 'speed': 0.1}
    two = problem.empty.joined(COULOMB, {'torque': 0.05}).joined(STRIBECK, values)
    silent = replace(problem.fitted(two, rounds=0), left=np.zeros_like(still.left))
    assert not astray(problem, moved(still, 1.0), None)
    start = moved(still, 3.0)
    assert not astray(problem, start, moved(silent, 1.0))
    assert astray(problem, start, moved(silent, 3.0))
    assert astray(problem, start, None)
    assert astray(problem, start, replace(moved(silent, 1.0), left=still.left))


def test_fits_are_followed_where_guesses_are_under_way(problem):
    file = problem.fitted(problem.empty, rounds=0)
    far = problem.fitted(problem.empty)
    best = replace(far, cost=0.9 * far.cost)
    assert under_way(problem, file, best, [far, file]) == [far]
    assert under_way(problem, far, best, [far]) == []
    assert under_way(problem, file, replace(far, cost=0.5 * far.cost), [far]) == []


def test_more_parameters_have_to_explain_more(problem):
    simple = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.05}))
    values = {'static': 0.0, 'sliding': 0.05, 'speed': 0.1}
    rich = replace(problem.fitted(problem.empty.joined(STRIBECK, values)), cost=0.99 * simple.cost)
    assert better(problem, rich, None, simple) is simple
    telling = replace(rich, cost=0.1 * simple.cost)
    assert better(problem, telling, simple) is telling
    assert better(problem, None) is None


def test_a_last_state_is_fitted_to_its_end(problem):
    found = Found()
    start = problem.fitted(problem.empty)
    rough = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.2}), rounds=1)
    found.states = [start, rough]
    Challenge(Steps(problem, [COULOMB], 1, lambda *_: None), {}).of(found)
    end = problem.fitted(rough.model, rounds=60, accuracy=1e-5)
    assert found.final.cost < 0.99 * rough.cost
    assert found.final.cost < 1.03 * end.cost
    assert found.without[0].cost >= found.final.cost


def test_a_guess_is_as_uncertain_as_explanations_differ(problem):
    rubbing = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.05}))
    guessed = [t.guessed for t in problem.tolerances]
    # another explanation, with all numbers far from there
    other = replace(problem.empty, moved=rubbing.model.moved + 8.0)
    alone = number_intervals(problem, rubbing)
    both = number_intervals(problem, rubbing, [other])
    wider = [a != b for a, b in zip(alone, both, strict=True)]
    assert any(wider)
    for n, (t, (low, high)) in enumerate(zip(problem.tolerances, both, strict=True)):
        assert guessed[n] or not wider[n]
        assert low <= t.axis.value(rubbing.model.moved[n]) <= high
        if guessed[n]:
            assert low <= t.axis.value(other.moved[n]) <= high


def test_what_may_be_instead_is_an_equal_rival_or_that_a_doubted_cause_is_not_there(problem):
    final = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.05}))
    start = problem.fitted(problem.empty)
    values = {'static': 0.05, 'sliding': 0.05, 'speed': 0.1}
    rival = Rival(STRIBECK, problem.fitted(problem.empty.joined(STRIBECK, values)))
    worse = Rival(Candidate('gravity', 'pulley_axis'), start)
    found = Found(states=[start, final], rivals=[[rival, worse]], without=[start])
    doubted = Belief((None,), {}, (), (), (), None, ())
    assert alternatives(problem, found, doubted) == [rival.fit.model, start.model]
    assert alternatives(problem, found, replace(doubted, accepted=(0,))) == [rival.fit.model]


def test_guesses_may_be_as_far_back_as_other_readings_take_them(measured_on):
    """Readings a tenth farther apart make an inertia a tenth less."""
    body = load_instrument('single_body')
    body = replace(body, tolerances={'pulley_body.inertia': math.inf, 'pulley_body.damping': 0.0})
    ready = prepared([measured_on(body, settings=(('amplitude', '25 deg'),))], body)
    [segment], [(_, smoother)] = ready.whole.rollouts.segments, ready.noise.motions
    motion = segment.motion
    farther = Signals.smooth(motion.start, motion.step, 1.1 * motion.value)
    ready = replace(ready, noise=replace(ready.noise, motions=((farther, smoother),)))
    final = ready.problem.fitted(ready.problem.empty)
    [right] = read_right(ready, final)
    [inertia] = ready.problem.tolerances
    was, back = (inertia.axis.value(m.moved[0]) for m in (final.model, right))
    assert back / was == pytest.approx(1.1, rel=0.02)
    _, high = number_intervals(ready.problem, final, [right])[0]
    assert high >= back


def test_what_is_measured_stays_where_it_was_read(bench, sound):
    ready = prepared(list(sound), bench)
    assert read_right(ready, ready.problem.fitted(ready.problem.empty, rounds=0)) == []
