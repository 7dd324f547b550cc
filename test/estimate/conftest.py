"""Rigs and simulated recordings for the observers."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory


@pytest.fixture(scope='session')
def bench():
    """Return the practice bench as a user knows it."""
    return load_instrument('bench_rig')


@pytest.fixture(scope='session')
def pressing(bench):
    """Return a simulated recording without noise: the tip presses, then lets go."""
    return simulate(bench, chosen_trajectory('paper_fig12', bench.motor_names), rate=100.0)


@pytest.fixture(scope='session')
def noisy(bench):
    """Return the same with the noise of the sensors."""
    return simulate(bench, chosen_trajectory('paper_fig12', bench.motor_names), rate=100.0, seed=7)


@pytest.fixture(scope='session')
def free_recording(bench):
    """Return a simulated recording in which the tip touches nothing."""
    away = replace(bench, contacts=tuple(replace(c, enabled=False) for c in bench.contacts))
    return simulate(
        away, chosen_trajectory('multisine', bench.motor_names, {'duration': '6 s'}), rate=125.0
    )


@pytest.fixture
def rms():
    """Return the root of the mean square."""
    return lambda values: float(np.sqrt(np.mean(np.square(values))))
