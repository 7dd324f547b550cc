"""What is noise in what a model leaves, and what has structure."""

import numpy as np
import pytest

from tendon_ros.identify.residuals import neighbours


@pytest.mark.parametrize('period', [0.002, 0.008, 0.017, 0.02, 0.024])
def test_acceleration_that_counts_make_up_has_no_structure(period):
    # a second difference of angles whose errors share nothing beyond a bin
    error = np.random.default_rng(4).normal(size=20_000)
    made_up = np.diff(error, 2)
    apart = neighbours(period, counted=True)
    step = made_up[apart:] - made_up[:-apart]
    assert np.mean(step**2) / 2.0 == pytest.approx(np.mean(made_up**2), rel=0.05)


def test_slow_samples_and_motion_without_counts_are_compared_sooner():
    assert neighbours(0.1, counted=True) == 1
    assert neighbours(0.02, counted=False) == 2
