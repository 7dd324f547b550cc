"""What friction might be a little further on is asked without going there."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.statics import Statics

BUILT_UP = 2e-3  # [rad]


def friction_of(*uses):
    return Statics(replace(load_instrument('single_body'), effects=uses))


@pytest.fixture
def statics():
    return friction_of(
        EffectUse('coulomb_friction', 'pulley_body', {'torque': 0.1}),
        EffectUse('presliding_friction', 'pulley_body', {'torque': 0.0, 'angle': BUILT_UP}),
    )


def test_friction_beside_is_what_a_step_there_and_back_would_show(statics):
    still, there = np.zeros(1), np.array([0.1])
    statics.carry(still, there, 0.5)
    before = statics.at(there, still).friction
    assert before == pytest.approx(-0.1, abs=1e-3)  # it slides
    # ahead nothing changes, back it turns round: all of it far enough, hardly any by a hair
    assert statics.friction_beside(there, np.array([0.05])) == pytest.approx(0.2, abs=2e-3)
    small = statics.friction_beside(there, np.array([0.1 * BUILT_UP]))
    assert 0.005 < small[0] < 0.05
    # nobody went there
    np.testing.assert_array_equal(statics.at(there, still).friction, before)
    further = there + 0.01
    statics.carry(there, further, 0.1)
    assert statics.at(further, still).friction == pytest.approx(-0.1, abs=1e-3)


def test_what_has_no_friction_changes_none():
    statics = friction_of()
    assert statics.friction_beside(np.zeros(1), np.array([0.05])) == 0.0
