"""Motions that drive the model: what they are at their ends."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import predict


def test_a_motion_has_not_stopped_at_its_last_sample(body):
    time = 0.01 * np.arange(101)
    motion = Signals.smooth(0.0, 0.01, (2.0 * time**2)[None])
    rows = predict(replace(body(), control_period=0.01), motion, ('body',), len(time) - 1)
    assert rows.effort[:, 0] == pytest.approx(0.01 * 4.0, rel=1e-6)


@pytest.mark.parametrize(('samples', 'off'), [(6.0, 0.005), (12.0, 0.0005)])
def test_an_inertia_is_what_it_is_however_few_samples_a_period_has(body, samples, off):
    """By the cubic alone it would be a tenth too small where a loop shakes."""
    pace = 2.0 * np.pi * 10.0
    step = 0.1 / samples
    time = step * np.arange(201)
    motion = Signals.smooth(0.0, step, (0.1 * np.sin(pace * time))[None])
    rows = predict(replace(body(), control_period=step), motion, ('body',), len(time) - 1)
    true = -0.01 * 0.1 * pace**2 * np.sin(pace * time)
    inner = slice(20, -20)
    size = np.sum(rows.effort[inner, 0] * true[inner]) / np.sum(true[inner] ** 2)
    assert size == pytest.approx(1.0, abs=off)


def test_what_follows_the_last_sample_stands_still(body):
    motion = Signals.smooth(0.0, 0.01, np.linspace(0.0, 1.0, 51)[None])
    rows = predict(replace(body(), control_period=0.01), motion, ('body',), 60)
    assert rows.angle[-1, 0] == pytest.approx(1.0)
    assert rows.velocity[-1, 0] == 0.0
