"""Causes that spoil what no fit saw, and events between recordings."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose import judge
from tendon_ros.diagnose.bent import degenerate
from tendon_ros.diagnose.form import form_parts
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import (
    chance,
    IDLE,
    MOSTLY,
    NOTHING,
    signs_beside,
    spoils,
    stays,
    UNSEEN_NOISE,
)
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.signs import probability, Signs
from tendon_ros.diagnose.worth import LEAST_IN_ONE
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

FRICTION = ('coulomb_friction', 'pulley_3', {'torque': 0.1})


@pytest.fixture(scope='module')
def ready(bench, measured_on):
    """Return two recordings of a bench with friction, made ready."""
    runs = [measured_on(bench, FRICTION), replace(measured_on(bench, FRICTION, seed=2), name='b')]
    return prepared(runs, bench)


def found_with(problem, *uses):
    """Return what a search would have found that ended with these causes."""
    model = problem.empty
    for effect, place, values in uses:
        model = model.joined(Candidate(effect, place), values)
    states = [problem.fitted(problem.empty), problem.fitted(model)]
    final = states[-1].model
    found = Found()
    found.states = states
    found.without = [problem.fitted(final.without(k)) for k in range(len(final.causes))]
    return found


def test_a_true_cause_spoils_nothing(ready):
    found = found_with(ready.problem, FRICTION)
    assert not spoils(ready, found, found.without[0])


def test_a_wrong_cause_spoils_what_was_not_fitted(ready):
    found = found_with(ready.problem, FRICTION)
    wrong = found.final.model.joined(Candidate('torque_bias', 'motor_M'), {'torque': 0.05})
    found.without.append(found.final)
    found.states.append(replace(found.final, model=wrong))
    assert spoils(ready, found, found.without[1])


@pytest.mark.parametrize(('part', 'spoilt'), [(1e-16, False), (1e-3, False), (0.5, True)])
def test_what_was_held_out_and_says_nothing_spoils_nothing(ready, monkeypatch, part, spoilt):
    found = found_with(ready.problem, FRICTION)
    # a hold, of which damping says the last digits; half of what was gained is more than that
    samples = sum(int(mask.sum()) for mask in ready.held.masks)
    gained = (found.without[0].cost - found.final.cost) / len(found.final.left)
    lost = np.full(8, -part * gained * samples / 8.0)
    monkeypatch.setattr(judge, 'saved', lambda *_: lost)
    assert spoils(ready, found, found.without[0]) is spoilt


@pytest.mark.parametrize(
    ('gained', 'spoilt'),
    [
        ([3.0, -4.0, -1.0], False),
        ([-3.0, -4.0, -1.0], True),
        ([np.inf, 1.0], False),
        ([np.nan], True),
    ],
)
def test_a_loss_that_seconds_differ_by_anyway_spoils_nothing(ready, monkeypatch, gained, spoilt):
    monkeypatch.setattr(judge, 'saved', lambda *_: np.array(gained))
    found = found_with(ready.problem, FRICTION)
    # beside a cause that gains nothing where it was fitted
    assert spoils(ready, found, found.final) is spoilt


@pytest.mark.parametrize(('part', 'spoilt'), [(0.5, False), (1.5, True)])
def test_what_one_second_loses_may_be_no_more_than_what_is_gained(
    ready, monkeypatch, part, spoilt
):
    """A leap of an encoder is one second: it differs from all others by itself."""
    found = found_with(ready.problem, FRICTION)
    gained = found.without[0].cost - found.final.cost
    monkeypatch.setattr(judge, 'saved', lambda *_: np.array([1.0, -part * gained, -1.0]))
    assert spoils(ready, found, found.without[0]) is spoilt


def test_numbers_that_have_to_be_off_without_a_cause_speak_for_it(ready, monkeypatch):
    found = found_with(ready.problem, FRICTION)
    [without] = found.without
    left = stays(ready, found.final)
    samples = len(without.left)
    strained = replace(without, cost=without.cost + 0.2 * samples)
    plain, more = (signs_beside(ready.problem, found, w, left) for w in (without, strained))
    # it shows in some channels, and there the more
    assert more.worth > plain.worth + 0.2
    # and where it shows in none, it says no more than it costs each sample
    nothing = replace(found.final, cost=found.final.cost + 0.2 * samples)
    assert signs_beside(ready.problem, found, nothing, left).worth == pytest.approx(0.2)
    # and may lose so much of what was held out
    held = sum(int(mask.sum()) for mask in ready.held.masks)
    gained = NOTHING * (without.cost - found.final.cost) / samples
    monkeypatch.setattr(judge, 'saved', lambda *_: np.full(8, -(gained + 0.1) * held / 4.0))
    assert spoils(ready, found, without)
    assert not spoils(ready, found, strained)


@pytest.mark.parametrize(('beside', 'believed'), [(0.2, True), (0.4, False)])
def test_what_the_law_beside_it_may_get_wrong_is_no_cause(ready, beside, believed):
    found = found_with(ready.problem, FRICTION)
    signs = Signs(0.3, left=0.0, form=1.0, beside=beside)
    assert (chance(ready, found, 0, signs) > IDLE) is believed


def test_the_law_beside_is_that_of_the_others_at_the_place(bench, measured_on):
    viscous = ('viscous_friction', 'pulley_3', {'damping': 0.5})
    bias = ('torque_bias', 'motor_M', {'torque': 0.05})
    ready = prepared([measured_on(bench, FRICTION, viscous, bias)], bench)
    found = found_with(ready.problem, FRICTION, viscous, bias)
    left = stays(ready, found.final)
    of = [signs_beside(ready.problem, found, without, left) for without in found.without]
    for part, signs in zip(
        form_parts(ready.problem, found.start, found.final)[1::-1], of[:2], strict=True
    ):
        means = [float(part[own].mean()) for own in ready.problem.channels().values()]
        assert min(means) < signs.beside < max(means)
    assert of[2].beside == 0.0


def test_what_stays_of_another_motor_says_nothing_of_a_cause(ready, bench, measured_on):
    gain = ('torque_gain', 'motor_L', {'gain': 1.1})
    ready = prepared([measured_on(bench, gain)], bench)
    problem = ready.problem
    found = found_with(problem, gain)
    [without] = found.without
    left = stays(ready, found.final)
    likely = {}
    for channel, power in left.by_channel.items():
        more = replace(left, by_channel={**left.by_channel, channel: power + 1.0})
        likely[channel] = probability(signs_beside(problem, found, without, more))
    plain = probability(signs_beside(problem, found, without, left))
    assert likely['actuator/pulley_M/effort'] > 0.8 * plain
    assert likely['actuator/pulley_L/effort'] < 0.5 * plain


def test_what_was_held_out_tells_what_stays_where_it_leaves_more(ready):
    found = found_with(ready.problem, FRICTION)
    fitted = stays(ready, found.final)
    # the same model without the friction, as if it had been bent to what was fitted
    bent = replace(found.final, model=found.start.model)
    held = ready.held.left(found.start.model)
    unseen = ready.held.structured(held)
    assert unseen > 10.0 * fitted.whole + UNSEEN_NOISE
    assert stays(ready, bent).whole == pytest.approx(unseen - UNSEEN_NOISE)
    for name, (power, count) in ready.held.structured_by_channel(held).items():
        least = max(fitted.by_channel[name], power / count - UNSEEN_NOISE)
        assert stays(ready, bent).by_channel[name] == pytest.approx(least)
    # and what was fitted tells it where that leaves more
    worse = replace(found.final, left=found.start.left)
    assert stays(ready, worse).whole == ready.problem.structured(found.start.left)


def test_a_slip_from_the_first_happened_between_recordings(ready):
    values = {'jump': 1e-4, 'time': 0.01}
    slip = Candidate('cable_slip', 'cable_12')
    assert degenerate(ready.problem, slip, values)
    assert not degenerate(ready.problem, replace(slip, only='b'), values)


@pytest.mark.parametrize(('part', 'believed'), [(0.75, False), (0.9, True)])
def test_what_happens_once_beside_what_a_law_gets_wrong_at_other_times_is_luck(
    ready, part, believed
):
    found = found_with(ready.problem, FRICTION)
    signs = Signs(8.0, left=0.1, form=1.0, event=True, part=part)
    assert (chance(ready, found, 0, signs) > IDLE) is believed


def leaving_its_worth(ready, found, k, there):
    """Return what stays where some samples leave as much as a cause is worth, with a form."""
    worth = (found.without[k].cost - found.final.cost) / len(there)
    left = stays(ready, found.final)
    more = left.whole + worth
    return replace(
        left,
        by_channel=dict.fromkeys(left.by_channel, more),
        whole=more,
        samples=left.samples + np.where(there, np.sqrt(worth / np.mean(there)), 0.0),
    )


@pytest.mark.parametrize(('where_limited', 'believed'), [(True, True), (False, False)])
def test_what_a_limit_gets_wrong_where_it_acts_says_nothing_of_friction(
    measured_on, where_limited, believed
):
    body = load_instrument('single_body')
    limit = ('torque_saturation', 'motor_body', {'limit': 0.09, 'knee': 0.05})
    rubs = ('coulomb_friction', 'pulley_body', {'torque': 0.03})
    run = measured_on(body, limit, rubs, settings=(('duration', '8 s'), ('amplitude', '30 deg')))
    ready = prepared([run], body)
    problem = ready.problem
    found = found_with(problem, limit, rubs)
    acts = form_parts(problem, found.start, found.final)[0] > LEAST_IN_ONE
    assert 0.02 < np.mean(acts) < 0.4
    left = leaving_its_worth(ready, found, 1, acts if where_limited else ~acts)
    signs = signs_beside(problem, found, found.without[1], left)
    assert (probability(signs) > NAMED) is believed


@pytest.mark.parametrize('while_pushed', [True, False])
def test_what_a_push_gets_wrong_while_it_lasts_says_nothing_of_damping(measured_on, while_pushed):
    body = load_instrument('single_body')
    push = ('disturbance', 'pulley_body', {'torque': 0.3, 'start': 3.0, 'duration': 0.7})
    # whose law acts nearly all the time: there is hardly a moment in which no other does
    spring = ('joint_spring', 'pulley_body', {'stiffness': 3.0, 'rest': 0.5})
    damped = ('viscous_friction', 'pulley_body', {'damping': 0.01})
    run = measured_on(
        body, push, spring, damped, settings=(('duration', '8 s'), ('amplitude', '30 deg'))
    )
    ready = prepared([run], body)
    problem = ready.problem
    found = found_with(problem, push, spring, damped)
    pushed, sprung, _ = form_parts(problem, found.start, found.final)
    assert np.mean(pushed + sprung < LEAST_IN_ONE) < MOSTLY
    acts = pushed > LEAST_IN_ONE
    left = leaving_its_worth(ready, found, 2, acts if while_pushed else ~acts)
    signs = signs_beside(problem, found, found.without[2], left)
    assert (probability(signs) > NAMED) is while_pushed
