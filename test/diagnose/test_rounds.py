"""A round of a search is not led astray by one of the causes that it adds at once."""

from dataclasses import replace
import math

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.rounds import Round
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.screening import Screen
from tendon_ros.identify.subset import Member
from tendon_ros.model.instrument_file import load_instrument

BIAS = Candidate('torque_bias', 'motor_body')
RIPPLE = Candidate('torque_ripple', 'motor_body')
ENCODER = Candidate('encoder_gain', 'encoder_body')
WAVES = {'amplitude': 0.1, 'cycles': 38.0, 'phase': 0.4}


def test_where_several_leave_more_than_one_promised_that_one_is_tried(measured_on, monkeypatch):
    body = load_instrument('single_body')
    body = replace(body, tolerances=body.tolerances | {'pulley_body.inertia': math.inf})
    run = measured_on(
        body,
        (BIAS.effect, BIAS.place, {'torque': 0.2}),
        (RIPPLE.effect, RIPPLE.place, WAVES),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )
    problem = prepared([run], body).problem
    steps = Steps(problem, [BIAS, RIPPLE, ENCODER], 1, lambda *_: None)
    state = problem.fitted(problem.empty.joined(BIAS, {'torque': 0.2}))
    screen = Screen(problem, state)
    proposals = steps.screened(screen)
    best = {p.candidate: p for p in reversed(proposals)}
    ripple, encoder = best[RIPPLE], best[ENCODER]
    # waves that are out of phase once the angle is told otherwise
    far = ENCODER.coordinates.place({'gain': 0.7})
    astray = [Member(ripple, ripple.z), Member(encoder, far)]
    monkeypatch.setattr(Round, '_subset', lambda *_: astray)
    grown = Round(steps, problem.fitted(problem.empty)).grown(state, screen, proposals)
    assert grown is not None
    assert set(grown.model.causes) == {BIAS, RIPPLE}
    assert grown.model.values(1)['amplitude'] == pytest.approx(0.1, rel=0.1)
