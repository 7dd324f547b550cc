"""Steps of a descent: where they lead, what holds them, and derivatives that follow."""

import numpy as np
import pytest

from tendon_ros.identify.descent import Descent, follow, Place, TRIES, unpressed

FAR = np.array([[-9.0, 9.0], [-9.0, 9.0]])
NONE = np.zeros(2, dtype=bool)


def valley(x):
    # Rosenbrock's, at (1, 1)
    return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])


def slopes(x):
    return np.array([[-20.0 * x[0], 10.0], [-1.0, 0.0]])


def descended(descent, x, rounds=60):
    place = descent.at(np.array(x))
    for _ in range(rounds):
        place = descent.step(place, slopes(place.x), TRIES[0], 1e-12)
    return place


def test_the_end_of_a_curved_valley_is_reached():
    end = descended(Descent(valley, np.zeros(2), np.zeros(2), FAR, NONE), [-1.2, 1.0])
    assert end.x == pytest.approx([1.0, 1.0], abs=1e-6)
    assert end.cost == pytest.approx(0.0, abs=1e-12)


def test_a_prior_holds_back_as_much_as_it_says():
    # (x - 3)^2 + 2 x^2 is least at 1
    descent = Descent(lambda x: x[:1] - 3.0, np.array([2.0, 1.0]), np.zeros(2), FAR, NONE)
    end = descent.step(descent.at(np.zeros(2)), np.array([[1.0, 0.0]]), 1, 1e-12)
    assert end.x == pytest.approx([1.0, 0.0], rel=1e-2)


def test_a_prior_counts_from_what_is_likely():
    # (x - 3)^2 + 2 (x - 6)^2 is least at 5
    likely = np.array([6.0, 0.0])
    descent = Descent(lambda x: x[:1] - 3.0, np.array([2.0, 1.0]), likely, FAR, NONE)
    end = descent.step(descent.at(np.zeros(2)), np.array([[1.0, 0.0]]), 1, 1e-12)
    assert end.x == pytest.approx([5.0, 0.0], rel=1e-2)
    assert end.cost == pytest.approx(6.0, rel=1e-2)


def test_bounds_and_what_stays_are_kept():
    narrow = np.array([[-9.0, 0.5], [-9.0, 9.0]])
    end = descended(Descent(valley, np.zeros(2), np.zeros(2), narrow, NONE), [0.0, 0.0])
    assert end.x == pytest.approx([0.5, 0.25], abs=1e-6)
    held = descended(
        Descent(valley, np.zeros(2), np.zeros(2), FAR, np.array([False, True])), [0.0, 0.0]
    )
    assert held.x[1] == 0.0
    assert 0.0 < held.x[0] < 0.5


def test_what_presses_against_a_bound_is_told_from_what_leaves_it():
    x = np.array([-9.0, -9.0, 9.0, 9.0, 0.0])
    gradient = np.array([1.0, -1.0, 1.0, -1.0, 1.0])
    bounds = np.tile([-9.0, 9.0], (5, 1))
    assert unpressed(x, bounds, gradient).tolist() == [False, True, True, False, True]


def test_a_step_that_promises_too_little_is_not_tried():
    asked = []

    def counted(x):
        asked.append(x)
        return valley(x)

    descent = Descent(counted, np.zeros(2), np.zeros(2), FAR, NONE)
    place = descent.at(np.array([-1.2, 1.0]))
    assert descent.step(place, slopes(place.x), TRIES[0], 10.0) is place
    assert len(asked) == 1


def test_no_step_leads_to_where_nothing_can_be_computed():
    nothing = np.zeros(2), np.zeros(2)
    descent = Descent(lambda x: np.where(x > 0.5, np.inf, x - 2.0), *nothing, FAR, NONE)
    place = descent.at(np.zeros(2))
    end = descent.step(place, np.eye(2), TRIES[0], 1e-12)
    assert end is place or (np.isfinite(end.cost) and end.cost < place.cost)
    assert descent.step(place, np.eye(2), 1, 1e-12) is place


def test_derivatives_that_follow_tell_what_the_step_has_changed():
    descent = Descent(valley, np.zeros(2), np.zeros(2), FAR, NONE)
    before, after = descent.at(np.array([-1.0, 0.5])), descent.at(np.array([-0.6, 0.1]))
    slope = slopes(before.x)
    way = after.x - before.x
    follow(slope, [0, 1], before, after)
    assert slope @ way == pytest.approx(after.left - before.left)
    kept = slopes(before.x)
    follow(kept, [0], before, after)
    assert np.array_equal(kept[:, 1], slopes(before.x)[:, 1])
    same = slopes(before.x)
    follow(same, [0, 1], before, before)
    assert np.array_equal(same, slopes(before.x))


def test_following_derivatives_need_fewer_to_be_taken():
    def taken(steps):
        descent = Descent(valley, np.zeros(2), np.zeros(2), FAR, NONE)
        place = descent.at(np.array([-1.2, 1.0]))
        for count in range(1, 100):
            slope = slopes(place.x)
            for tries in TRIES[:steps]:
                last, place = place, descent.step(place, slope, tries, 1e-12)
                follow(slope, [0, 1], last, place)
            if place.cost < 1e-9:
                return count
        pytest.fail('the end was not reached')

    assert taken(3) < taken(1)


def test_a_place_knows_its_cost():
    descent = Descent(valley, np.array([2.0, 0.0]), np.zeros(2), FAR, NONE)
    place = descent.at(np.array([2.0, 4.0]))
    assert isinstance(place, Place)
    assert place.cost == pytest.approx(1.0 + 8.0)
