"""What friction is, or might be, a little further on is asked without going there."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.statics import Since, Statics

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


@pytest.mark.parametrize('dither', [0.0, 2e-3])
@pytest.mark.parametrize('way', [3e-4, -3e-4, -3e-3, 0.05])
def test_friction_since_is_what_the_way_there_builds_up(dither, way):
    statics = friction_of(
        EffectUse('coulomb_friction', 'pulley_body', {'torque': 0.1}),
        EffectUse(
            'presliding_friction',
            'pulley_body',
            {'torque': 0.0, 'angle': BUILT_UP, 'dither': dither},
        ),
    )
    still, here, gap = np.zeros(1), np.array([0.1]), 0.02
    statics.carry(still, here, 0.5)
    kept = statics.at(here, still).friction
    since = Since(here, gap)
    foretold = statics.at(here + way, still, since)
    ahead, behind = (statics.at(here + way + h, still, since).friction for h in (1e-7, -1e-7))
    assert foretold.stiffness[0, 0] == pytest.approx(
        -(ahead - behind)[0] / 2e-7, rel=1e-4, abs=1e-6
    )
    # nothing was carried by asking
    np.testing.assert_array_equal(statics.at(here, still).friction, kept)
    statics.carry(here, here + way, gap)
    assert foretold.friction == pytest.approx(statics.at(here + way, still).friction, abs=1e-4)


def test_friction_since_of_a_pulley_that_stays_is_what_it_was(statics):
    still, here = np.zeros(1), np.array([0.1])
    statics.carry(still, here, 0.5)
    stays = statics.at(here, still, Since(here, 0.01))
    assert stays.friction == pytest.approx(statics.at(here, still).friction)
    assert np.all(np.isfinite(stays.stiffness))
