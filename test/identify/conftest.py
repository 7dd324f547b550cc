"""The practice bench, and one problem on it that several tests share."""

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument


@pytest.fixture(scope='session')
def bench():
    """Return the practice bench as a user knows it."""
    return load_instrument('bench_rig')


@pytest.fixture(scope='session')
def sound_run(bench, measured_on):
    """Return a recording of the bench as it should be, with noise."""
    return measured_on(bench)


@pytest.fixture(scope='session')
def sound_problem(bench, sound_run):
    """Return that recording as a least-squares problem."""
    return prepared([sound_run], bench).problem
