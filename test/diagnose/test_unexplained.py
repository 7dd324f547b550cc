"""How likely something has a cause that was not named."""

import pytest

from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.unexplained import left_over


@pytest.mark.parametrize(('left', 'form'), [(0.03, 0.0), (0.138, 0.029), (0.124, 0.022)])
def test_noise_that_wanders_is_no_gap(left, form):
    # the last two: sound simulated belts whose sensors drift
    assert left_over(left, form) < NAMED


@pytest.mark.parametrize(('left', 'form'), [(0.2, 0.0), (0.5, 0.18), (20.0, 3.0)])
def test_what_stays_beyond_noise_and_laws_has_a_cause(left, form):
    assert left_over(left, form) > NAMED
