"""Shares of the gap are those of the noise, whatever laws may get wrong."""

import pytest

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.locate import whereabouts
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate

TRUE = {
    Candidate('coulomb_friction', 'pulley_3'): {'torque': 0.3},
    Candidate('torque_gain', 'motor_M'): {'gain': 1.1},
}


@pytest.fixture(scope='module')
def ready(bench, measured_on):
    """Return a recording in contact, with friction of 3 and a motor that gives more."""
    effects = [(c.effect, c.place, values) for c, values in TRUE.items()]
    run = measured_on(bench, *effects, trajectory='paper_fig12', settings=(), touching=True)
    return prepared([run], bench)


def shares(ready, model):
    """Return the share of each place."""
    problem = ready.problem
    without = [problem.fitted(model.without(k), rounds=0) for k in range(len(TRUE))]
    start, final = (problem.fitted(one, rounds=0) for one in (problem.empty, model))
    found = Found(states=[start, final], without=without)
    listed = whereabouts(ready, found, [0, 1], final, 0.0).listed
    return {
        place: sum(w.share for w in listed if w.place == place)
        for place in ('pulley_3', 'motor_M')
    }


def test_what_laws_may_get_wrong_takes_no_share_away(ready):
    model = ready.problem.empty
    for cause, values in TRUE.items():
        model = model.joined(cause, values)
    allowing = ready.allowing(ready.problem.empty, model)
    assert allowing.problem.doubted.max() > 10.0
    plain = shares(ready, model)
    assert min(plain.values()) > 0.03
    assert shares(allowing, model) == pytest.approx(plain, abs=0.02)
