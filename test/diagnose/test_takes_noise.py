"""What only makes less of noise is no cause."""

from types import SimpleNamespace

import numpy as np
import pytest

from tendon_ros.diagnose import judge
from tendon_ros.diagnose.belief import belief
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import IDLE, takes_noise
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

LATE = Candidate('sensor_delay', 'encoder_body')
DAMPED = Candidate('viscous_friction', 'pulley_body')
LIGHT = Candidate('inertia', 'pulley_body')


@pytest.mark.parametrize(
    ('cause', 'before', 'gain', 'shared', 'apart', 'noise'),
    [
        (LATE, 0.9, 0.5, 0.0, 1.0, True),
        (LATE, 0.9, 0.5, 0.2, 1.0, False),
        # guesses could have done it
        (LATE, 0.9, 0.5, 0.2, 0.3, True),
        (LATE, 0.9, 0.5, 0.35, 0.3, False),
        # recordings without any effect leave as much
        (LATE, 0.9, 0.06, 0.04, 1.0, True),
        # more than noise is left without it, whatever its form
        (LATE, 3.0, 0.5, 0.0, 0.3, False),
        # it has nothing to do with how counts become torques
        (DAMPED, 0.9, 0.5, 0.0, 1.0, False),
        # and a lighter body has: the accelerations are its noise
        (LIGHT, 0.9, 0.5, 0.0, 1.0, True),
        (LIGHT, 0.9, 0.5, 0.2, 1.0, False),
        (LIGHT, 3.0, 0.5, 0.0, 1.0, False),
    ],
)
def test_what_has_no_form_and_is_no_more_than_noise_is_no_cause(
    monkeypatch, cause, before, gain, shared, apart, noise
):
    model = SimpleNamespace(causes=[cause])
    rollouts = SimpleNamespace(instrument=load_instrument('single_body'))

    def fit(power):
        left = np.full(100, np.sqrt(power))
        return SimpleNamespace(left=left, cost=100.0 * power, model=model)

    without, final = fit(before), fit(before - 0.3)
    monkeypatch.setattr(judge, 'its_own', lambda *_: apart)
    monkeypatch.setattr(judge, 'gains', lambda *_: (gain, gain))
    problem = SimpleNamespace(
        structured=lambda left: shared if left is without.left else 0.0,
        rollouts=rollouts,
    )
    found = SimpleNamespace(without=[without], final=final)
    assert takes_noise(problem, found, 0) == noise


FRICTION = Candidate('coulomb_friction', 'pulley_body')


@pytest.fixture
def rubbing(measured_on):
    """Return a problem on a body that rubs, and what a search would leave that found it."""
    body = load_instrument('single_body')
    run = measured_on(body, ('coulomb_friction', 'pulley_body', {'torque': 0.2}))
    ready = prepared([run], body)
    start = ready.problem.fitted(ready.problem.empty)
    final = ready.problem.fitted(start.model.joined(FRICTION, {'torque': 0.2}))
    return ready, Found(states=[start, final], rivals=[[]], without=[start])


def test_such_a_cause_is_neither_believed_nor_kept(rubbing, monkeypatch):
    """Who is fitted next to it would come out too small."""
    sure = belief(*rubbing)
    assert sure.weighed[0].chance > IDLE
    assert sure.kept == (0,)
    for module in ('judge', 'belief'):
        monkeypatch.setattr(f'tendon_ros.diagnose.{module}.takes_noise', lambda *_: True)
    idle = belief(*rubbing)
    assert idle.weighed[0].chance == IDLE
    assert idle.kept == ()


def test_what_is_doubted_for_another_reason_is_kept(rubbing):
    ready, found = rubbing
    found.unmet = [FRICTION]
    assert belief(ready, found).named == {}
    assert belief(ready, found).kept == (0,)
