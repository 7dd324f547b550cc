"""A planned motion starts and ends at rest, at its goal, within the speed that is allowed."""

import numpy as np
import pytest

from tendon_ros.nodes.motion import plan

SPEEDS = {'a': 0.5, 'b': 0.1}


def test_both_ends_and_rest_there():
    motion = plan({'a': 0.1, 'b': -0.2}, {'a': 0.3, 'b': 0.1}, 2.0, SPEEDS)
    time = np.linspace(2.0, motion.end, 2001)
    path = motion.at(time)
    assert path[0].tolist() == [0.1, -0.2]
    assert path[-1].tolist() == [0.3, 0.1]
    speed = np.gradient(path, time, axis=0)
    assert np.abs(speed[[0, -1]]).max() < 1e-4
    assert np.abs(speed).max(axis=0)[1] == pytest.approx(0.1, rel=1e-3)
    assert np.abs(speed).max(axis=0)[0] < 0.5


def test_it_stays_at_the_goal_exactly_and_joints_left_out_stay():
    motion = plan({'a': 0.1, 'b': -0.2}, {'a': 0.3}, 0.0, SPEEDS)
    assert motion.at(np.array([motion.end, 99.0])).tolist() == [[0.3, -0.2]] * 2
    assert np.all(motion.at(np.linspace(0.0, 1.0, 50))[:, 1] == -0.2)


@pytest.mark.parametrize(('shortest', 'duration'), [(1.0, 1.875 * 0.3 / 0.1), (60.0, 60.0)])
def test_it_takes_longer_than_it_has_to_only_where_asked(shortest, duration):
    motion = plan({'a': 0.0, 'b': 0.0}, {'a': 0.3, 'b': -0.3}, 0.0, SPEEDS, shortest=shortest)
    assert motion.duration == pytest.approx(duration)
    time = np.linspace(0.0, motion.end, 2001)
    speed = np.abs(np.gradient(motion.at(time), time, axis=0)).max(axis=0)
    assert np.all(speed <= 1.0001 * np.array(list(SPEEDS.values())))


def test_no_way_takes_no_time():
    motion = plan({'a': 0.1}, {'a': 0.1}, 3.0, SPEEDS)
    assert motion.duration == 0.0
    assert motion.at(np.array([3.0])).tolist() == [[0.1]]
