"""Where the play of a coupling ends, for searches that must not stop inside it."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.estimate.play import Play
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.statics import Statics


@pytest.fixture
def wide():
    """Return the grasper with a play of 71 mrad at its hinge, and which pulleys are free."""
    tool = load_instrument('davinci_grasper')
    loose = EffectUse('backlash', 'coupling_hinge', {'angle': 0.071, 'held': 0.0})
    return replace(tool, effects=(loose,)), [tool.index('drum'), tool.index('jaw')]


def test_a_coupling_wound_up_by_little_is_outside_its_play(wide):
    tool, free = wide
    play = Play(tool, free, Statics(tool))
    angle = np.zeros(len(tool.pulleys))
    for twist, inside in ((0.0, True), (0.0354, True), (0.0356, False), (0.04, False)):
        angle[tool.index('drum')] = twist
        assert play.inside(angle) is inside
        assert play.inside(-angle) is inside


def test_both_sides_are_just_outside(wide):
    tool, free = wide
    play = Play(tool, free, Statics(tool))
    row = tool.routing()[len(tool.loops) + [c.name for c in tool.couplings].index('hinge')]
    twists = [float(row @ side) for side in play.sides(np.zeros(len(tool.pulleys)))]
    assert twists == pytest.approx([0.0355, -0.0355], rel=1e-4)


def test_without_play_nothing_is_inside():
    tool = load_instrument('davinci_grasper')
    play = Play(tool, range(1, len(tool.pulleys)), Statics(tool))
    assert not play.inside(np.zeros(len(tool.pulleys)))
    assert play.sides(np.zeros(len(tool.pulleys))) == []
