"""Simulated time follows elapsed time, however the loop stumbles."""

from hypothesis import given
from hypothesis import strategies as st
import pytest

from tendon_ros.nodes.pace import Pace

PERIOD = 1e-3


@given(st.lists(st.floats(0.0, 0.09), min_size=1, max_size=200))
def test_no_period_is_lost_or_added_while_the_loop_keeps_up(gaps):
    pace = Pace(PERIOD, 100.0)
    now, done = 100.0, pace.due(100.0)
    for gap in gaps:
        now += gap
        done += pace.due(now)
        assert done == pytest.approx((now - 100.0) / PERIOD + 1, abs=1.0001)
    assert pace.slipped == 0.0


def test_a_long_stall_is_given_up_and_said():
    pace = Pace(PERIOD, 0.0)
    pace.due(0.0)
    assert pace.due(1.0) == 100
    assert pace.slipped == pytest.approx(0.9)
    assert pace.due(1.0) == 0
    assert pace.due(1.010) == 10
    assert pace.slipped == pytest.approx(0.9)


def test_the_wait_ends_when_the_next_sample_is_due():
    pace = Pace(PERIOD, 5.0)
    assert pace.wait(5.0, 2) == 0.0
    assert pace.due(5.0) == 1
    assert pace.wait(5.0003, 2) == pytest.approx(0.0017)
    assert pace.due(5.002) == 2
    assert pace.wait(5.0045, 2) == 0.0
