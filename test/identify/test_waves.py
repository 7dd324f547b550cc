"""Ripples are looked for where a motor passed enough of their waves to tell them."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.starting import Starting
from tendon_ros.identify.waves import powers, ripples, shows, travel
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory import Trajectory

RIPPLE = Candidate('torque_ripple', 'motor_body')
RIPPLE_THERE = (RIPPLE.effect, RIPPLE.place, {'amplitude': 0.1, 'cycles': 14.0, 'phase': 0.3})


@pytest.fixture(scope='module')
def problem(measured_on):
    """Return the problem of a body that turns by some 20 degrees, on which a weight hangs."""
    body = load_instrument('single_body')
    weight = ('gravity', 'pulley_body', {'torque': 0.5, 'phase': 0.3})
    return prepared([measured_on(body, weight)], body).problem


def test_half_a_wave_shows_and_slow_ones_take_two(problem):
    turns = travel(problem, 'body') / (2.0 * np.pi)
    half = max(6.0, 0.5 / turns)
    assert shows(problem, 'motor_body', 1.01 * half)
    assert not shows(problem, 'motor_body', 0.99 * half)
    assert not shows(problem, 'motor_body', 2.0)


def test_fits_of_a_ripple_begin_where_it_can_be_told(problem):
    """The weight bends like a wave a turn, which would stand before any ripple that is one."""
    starts = Starting(problem, problem.fitted(problem.empty, rounds=0)).of(RIPPLE)
    assert starts
    assert all(shows(problem, RIPPLE.place, values['cycles']) for _, values in starts)


def test_ripples_are_looked_for_as_closely_as_the_travel_tells_them_apart(problem):
    turns = travel(problem, 'body') / (2.0 * np.pi)
    grid = ripples(problem, RIPPLE.place, 400.0)
    np.testing.assert_allclose(np.diff(grid), 0.5)
    assert grid[0] >= 1.0
    assert grid[-1] == 400.0
    assert all(shows(problem, RIPPLE.place, one) for one in grid[:50])
    # less than the motor has passed of it cannot be told
    assert grid[0] * turns >= 0.5


def test_powers_are_those_of_each_wave_alone():
    rng = np.random.default_rng(1)
    cycles = 1.0 + 0.1 * np.arange(390)
    angle = rng.uniform(-120.0, 150.0, 900)
    left = np.sin(14.2 * angle + 0.7) + rng.normal(size=900)
    sign = np.sign(rng.normal(size=900))
    found = powers(cycles, angle, np.zeros(900), sign * left, sign)
    for k in (5, 131, 132, 133, 388):
        wave = sign * np.exp(1j * cycles[k] * angle)
        part = sign * left - np.mean(sign * left)
        own = abs(wave @ part) ** 2 / (np.abs(wave - wave.mean()) ** 2).sum()
        assert found[k] == pytest.approx(own, rel=0.1, abs=5.0)
    assert cycles[np.argmax(found)] == pytest.approx(14.2)


def test_what_passes_faster_than_bins_is_not_taken_for_what_does_not_pass():
    # at a steady speed, 40 waves on a turn pass once a bin: whatever lasts looks like them
    angle = (2.0 * np.pi / 40.0) * np.arange(1200.0)
    left = np.where(angle > 94.0, 1.0, -1.0)
    cycles = 1.0 + 0.25 * np.arange(200)
    found = powers(cycles, angle, np.gradient(angle), left, np.ones(1200))
    assert found[np.abs(cycles - 40.0) < 1.0].max() == 0.0


def test_a_ripple_of_a_motor_that_turns_round_and_round_is_found_where_it_is():
    body = load_instrument('single_body')
    ripple = EffectUse(*RIPPLE_THERE)
    time = np.arange(0.0, 16.0, 0.01)
    turned = 4.0 * np.pi * np.sin(0.5 * time) ** 2
    there_and_back = Trajectory('turns', time, {'body': turned})
    run = simulate(replace(body, effects=(*body.effects, ripple)), there_and_back, seed=1)
    problem = prepared([run], body).problem
    assert travel(problem, 'body') > 3.0 * np.pi
    starts = Starting(problem, problem.fitted(problem.empty, rounds=0)).of(RIPPLE)
    assert starts[0][1]['cycles'] == pytest.approx(14.0, abs=0.2)
    # and at whole numbers of waves, which poles make
    begun = {values['cycles'] for _, values in starts}
    assert {float(round(waves)) for waves in begun} <= begun
    assert 14.0 in begun
