"""How likely something has a cause that was not named."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.evidence import ENDED
from tendon_ros.diagnose.form import form_power, own_power, own_profile
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.unexplained import (
    left_over,
    stands_out_in_a_block,
    SURPRISE,
    surprising,
    unexplained,
)
from tendon_ros.identify.candidate import everyone
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument


@pytest.mark.parametrize(('left', 'form'), [(0.03, 0.0), (0.138, 0.029), (0.124, 0.022)])
def test_noise_that_wanders_is_no_gap(left, form):
    # the last two: sound simulated belts whose sensors drift
    assert left_over(left, form) < NAMED


@pytest.mark.parametrize(('left', 'form'), [(0.2, 0.0), (0.5, 0.18), (20.0, 3.0)])
def test_what_stays_beyond_noise_and_laws_has_a_cause(left, form):
    assert left_over(left, form) > NAMED


@pytest.fixture(scope='module')
def doubtful(measured_on):
    """Return a body with friction that its file lists, whose motor is weaker in one run."""
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    runs = [
        measured_on(
            body,
            friction,
            ('torque_gain', 'motor_body', {'gain': gain}),
            settings=settings,
            name=name,
        )
        for name, gain in (('cold', 0.9), ('warm', 0.5))
    ]
    file = replace(
        body,
        effects=(EffectUse(*friction),),
        tolerances={
            'pulley_body.coulomb_friction.torque': 0.01,
            'motor_body.torque_gain': 0.01,
        },
    )
    return prepared(runs, file)


def test_what_takes_a_number_to_the_end_of_its_tolerance_is_more_than_a_law(doubtful):
    problem = doubtful.problem
    start = problem.fitted(problem.empty)
    found = Found(states=[start])
    assert max(abs(z) for t, z in problem.moved(start.model)) >= ENDED
    assert unexplained(doubtful, found, start) > NAMED
    # the same misfit, and no number at its end: the friction's law may be what is wrong
    within = replace(start.model, moved=np.clip(start.model.moved, -2.0, 2.0))
    less = unexplained(doubtful, found, replace(start, model=within))
    assert less < unexplained(doubtful, found, start)


@pytest.mark.parametrize(('once', 'told'), [(True, True), (False, False)])
def test_what_is_far_more_than_laws_get_wrong_there_is_none_of_theirs(measured_on, once, told):
    """As much on the whole: in a few knocks, or all along, by as much as a law may be off."""
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 1.0})
    run = measured_on(body, friction, settings=(('duration', '6 s'), ('amplitude', '60 deg')))
    ready = prepared([run], replace(body, effects=(EffectUse(*friction),)))
    problem = ready.problem
    start = problem.fitted(problem.empty)
    found = Found(states=[start])
    profile = own_profile(problem, start)
    assert float(np.mean(profile)) == pytest.approx(own_power(problem, start), rel=0.2)
    wrong = np.sqrt(profile)
    if once:
        knocks = np.arange(len(wrong)) % 250 < 10
        wrong = np.where(knocks, np.sqrt(25.0 * np.mean(profile)), 0.0)
    state = replace(start, left=start.left + wrong)
    assert (unexplained(ready, found, state) > NAMED) == told


@pytest.mark.parametrize(('start', 'says'), [(4.6, True), (2.9, False)])
def test_a_push_that_no_fit_has_seen_is_a_surprise_beside_a_ripple_that_may_be_wrong(
    measured_on, start, says
):
    body = load_instrument('single_body')
    push = ('disturbance', 'pulley_body', {'torque': 0.1, 'start': start, 'duration': 1.2})
    ripple = ('torque_ripple', 'motor_body', {'amplitude': 0.3, 'cycles': 23.0, 'phase': 0.4})
    run = measured_on(body, push, ripple, settings=(('duration', '12 s'), ('amplitude', '40 deg')))
    ready = prepared([run], body)
    problem = ready.problem
    [motor] = [c for c in everyone(body, list(run.channels)) if c.effect == 'torque_ripple']
    nothing = problem.fitted(problem.empty)
    fit = problem.fitted(problem.empty.joined(motor, ripple[2]))
    found = Found(states=[nothing, fit])
    # as much of the ripple's law may be wrong as the push leaves of all that was held out
    form = form_power(problem, nothing, fit)
    unseen = ready.held.structures(ready.held.left(fit.model))[1]
    assert not says or 1.0 < unseen < SURPRISE * form
    assert not surprising(ready, found)
    assert stands_out_in_a_block(ready, found) is says
