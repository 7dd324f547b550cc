"""Further causes of a machine are those that foretell what no fit has seen."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.further import foretells, further, saved, SOME
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.worth import LEAST
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.model.instrument_file import load_instrument

FRICTION = Candidate('coulomb_friction', 'pulley_body')
BIAS = Candidate('torque_bias', 'motor_body')
IMITATE = {'gravity', 'joint_spring'}  # constant torques too, where the body turns but little


@pytest.fixture(scope='module')
def ready(measured_on):
    body = load_instrument('single_body')
    effects = [
        ('coulomb_friction', 'pulley_body', {'torque': 0.2}),
        ('torque_bias', 'motor_body', {'torque': 0.1}),
    ]
    runs = [measured_on(body, *effects, seed=seed, name=f'run{seed}') for seed in (1, 2)]
    return prepared(runs, body)


@pytest.fixture(scope='module')
def rubs(ready):
    problem = ready.problem
    return problem.fitted(problem.empty.joined(FRICTION, {'torque': 0.2}))


def steps_of(ready, seconds=float('inf')):
    names = [s.channel for s in ready.problem.rollouts.instrument.sensors]
    candidates = everyone(ready.problem.rollouts.instrument, names)
    candidates = [c for c in candidates if c.effect not in IMITATE]
    return Steps(ready.problem, candidates, 1, lambda *_: None, Patience(seconds))


def test_what_is_there_foretells_and_what_is_not_does_not(ready, rubs):
    problem = ready.problem
    both = problem.fitted(rubs.model.joined(BIAS, {'torque': 0.05}))
    assert foretells(ready.held, rubs.model, both.model)
    assert not foretells(ready.held, both.model, rubs.model)
    assert not foretells(ready.held, rubs.model, rubs.model)
    assert saved(ready.held, rubs.model, both.model).sum() > 0.0


def test_what_foretells_joins_and_nothing_else(ready, rubs):
    grown = further(steps_of(ready), rubs, ready.held, 10)
    assert BIAS in grown.model.causes
    assert not any(c.instants for c in grown.model.causes)
    assert len(grown.model.causes) <= 3
    assert further(steps_of(ready), rubs, ready.held, 1) is rubs


def test_nothing_is_looked_for_once_it_is_late(ready, rubs):
    assert further(steps_of(ready, 0.0), rubs, ready.held, 10) is rubs


def test_what_held_out_blocks_judge_may_be_small(measured_on):
    body = load_instrument('single_body')
    effort = next(s.channel for s in body.sensors if s.kind == 'motor_torque')

    def prepared_with(bias):
        runs = []
        for seed in (1, 2):
            run = measured_on(
                body,
                ('coulomb_friction', 'pulley_body', {'torque': 0.2}),
                settings=(('duration', '30 s'), ('amplitude', '5 deg')),
                seed=seed,
                name=f'run{seed}',
            )
            read = replace(run[effort], value=run[effort].value + bias)
            runs.append(replace(run, channels={**run.channels, effort: read}))
        return prepared(runs, body)

    noise = min(
        float(np.median(m.doubt))
        for m in prepared_with(0.0).problem.rollouts.segments[0].measured
        if m.sensor.channel == effort
    )
    ready = prepared_with(0.2 * noise)
    problem = ready.problem
    state = problem.fitted(problem.empty.joined(FRICTION, {'torque': 0.2}))
    steps = Steps(problem, [BIAS], 1, lambda *_: None, Patience())
    grown = further(steps, state, ready.held, 10)
    gain = (state.cost - grown.cost) / len(state.left)
    assert SOME < gain < LEAST
    assert BIAS in grown.model.causes
