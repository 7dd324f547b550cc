"""Intervals cover the truth as often as they say, correlated residuals or not."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.intervals import (
    _by_form,
    deviations,
    mean_square_interval,
    parameter_intervals,
    unsized,
)
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.segment import Measured, Segment
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.signals import Signals

PERIOD, BINS = 0.01, 3000
TRUTH = 0.05


class Line:
    """Rollouts of a model that is a straight line: torque bias and gain of one motor."""

    tolerance = 4e-6

    def __init__(self, value):
        time = PERIOD * (np.arange(BINS) + 0.5)
        self.instrument = load_instrument('single_body')
        sensor = next(s for s in self.instrument.sensors if 'effort' in s.channel)
        measured = Measured(sensor, value, np.full(BINS, 0.01), 0.0)
        self.segments = (Segment('line', PERIOD, time, (), Signals.none(), (measured,), (), {}),)
        self.measured = (value[None, :],)

    def predicted(self, uses, asked=None):
        torque = sum(use.parameters['torque'] for use in uses[0])
        time = self.segments[0].time
        return (torque * (1.0 + np.sin(time))[None, :],)

    def each(self, work, numbers):
        return [work(n) for n in numbers]


def noise(rng, memory):
    """Return noise of one deviation with a memory of so many bins."""
    white = rng.normal(size=BINS + 1000)
    if not memory:
        return white[:BINS]
    part = np.exp(-1.0 / memory)
    out = np.empty_like(white)
    out[0] = white[0]
    for k in range(1, len(white)):
        out[k] = part * out[k - 1] + np.sqrt(1.0 - part**2) * white[k]
    return out[1000:]


def fits(memory, count):
    for seed in range(count):
        rng = np.random.default_rng(seed)
        line = Line(np.zeros(BINS))
        shape = 1.0 + np.sin(line.segments[0].time)
        line = Line(TRUTH * shape + 0.01 * noise(rng, memory))
        problem = Problem(line, (), [np.ones(BINS, dtype=bool)])
        cause = Candidate('torque_bias', 'motor_body')
        yield problem, problem.fitted(problem.empty.joined(cause, {'torque': 0.02}))


@pytest.mark.parametrize('memory', [0, 20])
def test_the_truth_lies_within(memory):
    inside = 0
    for problem, fit in fits(memory, 100):
        [row] = parameter_intervals(problem, fit)
        low, high = row['torque']
        inside += low <= TRUTH <= high
        assert high - low < 0.25 * TRUTH
    assert inside >= 90


def test_correlated_residuals_are_not_taken_for_proof():
    wide = [deviations(p, f)[0] for p, f in fits(20, 5)]
    white = [deviations(p, f)[0] for p, f in fits(0, 5)]
    assert np.median(wide) > 2.0 * np.median(white)


def test_the_spread_is_the_one_that_repetition_shows():
    found, told = [], []
    for problem, fit in fits(20, 60):
        found.append(fit.model.z[0][0])
        told.append(deviations(problem, fit)[0])
    assert 0.7 < np.mean(told) / np.std(found) < 1.6


def test_the_interval_of_a_gap_covers_it():
    rng = np.random.default_rng(0)
    inside = 0
    for _ in range(300):
        blocks = 4.0 * rng.chisquare(30, size=8) / 30
        low, high = mean_square_interval(blocks)
        inside += low <= 2.0 <= high
    assert 270 <= inside <= 299


def test_a_gap_of_one_block_is_hardly_known():
    low, high = mean_square_interval([4.0])
    assert low < 0.5 * 2.0 < 10.0 * 2.0 < high
    assert mean_square_interval([]) == (0.0, 0.0)


def test_no_number_of_recordings_tells_the_scale_of_what_is_guessed(measured_on):
    axis = load_instrument('driven_axis')
    motion = (('duration', '6 s'), ('amplitude', '30 deg'))
    # torques, inertia, damping and friction of 1.5 times their size look the same
    truth = (
        ('inertia', 'pulley_axis', {'scale': 1.5}),
        ('viscous_friction', 'pulley_axis', {'damping': 0.005}),
        ('coulomb_friction', 'pulley_axis', {'torque': 0.06}),
        ('torque_gain', 'motor_axis', {'gain': 1.5}),
    )
    runs = [measured_on(axis, *truth, settings=motion, seed=s, name=f'run_{s}') for s in range(6)]
    widths = []
    for count in (1, 6):
        problem = prepared(runs[:count], axis).whole
        friction = Candidate('coulomb_friction', 'pulley_axis')
        model = problem.empty.joined(friction, {'torque': 0.03})
        fit = problem.centred(problem.fitted(model))
        [interval] = parameter_intervals(problem, fit)
        low, high = interval['torque']
        # the fit ends at some scale, which is that of the inertia: there the friction is known
        inertia = next(
            t.axis.value(z)
            for t, z in zip(problem.tolerances, fit.model.moved, strict=True)
            if t.quantity == 'inertia'
        )
        assert fit.model.values(0)['torque'] == pytest.approx(0.06 / 1.5 * inertia, rel=0.1)
        assert low < 0.06 / 1.5 * inertia < high
        # it is there, whatever the unit of torque
        assert unsized(problem, fit) == frozenset()
        # parts of what was found: each fit ends where it likes on the way along the scale
        widths.append((high - low) / fit.model.values(0)['torque'])
    # with a known scale it would be some hundredths
    assert min(widths) > 1.0


def test_a_factor_beside_a_guessed_unit_may_as_well_be_none(measured_on):
    """A body of one and a half times its inertia, or a motor of two thirds of its torque."""
    axis = load_instrument('driven_axis')
    weighed = replace(axis, tolerances={**axis.tolerances, 'pulley_axis.inertia': 0.02})
    truth = (
        ('inertia', 'pulley_axis', {'scale': 1.5}),
        ('coulomb_friction', 'pulley_axis', {'torque': 0.06}),
    )
    motion = (('duration', '6 s'), ('amplitude', '30 deg'))
    problem = prepared([measured_on(axis, *truth, settings=motion)], weighed).whole
    model = problem.empty
    for effect, values in (
        ('coulomb_friction', {'torque': 0.06}),
        ('inertia', {'scale': 1.5}),
    ):
        model = model.joined(Candidate(effect, 'pulley_axis'), values)
    # by derivatives to both sides: the curvature of those to one would tell the unit
    assert unsized(problem, problem.centred(problem.fitted(model))) == {1}


def test_waves_are_counted_along_the_whole_way():
    """What a ripple's law gets wrong is its height, not how many waves a turn has."""
    parameters = {p.name: p for p in Candidate('torque_ripple', 'motor_M').parameters}
    assert _by_form(parameters['cycles'], 629.0, 0.12) < 0.03 * 629.0
    assert _by_form(parameters['amplitude'], 6.0, 0.12) == pytest.approx(0.12 * 6.0)


def test_a_size_that_another_can_take_over_may_as_well_be_none():
    [(problem, alone)] = fits(0, 1)
    assert unsized(problem, alone) == frozenset()
    # both are a torque in this model, which knows their sum and nothing else
    twin = Candidate('coulomb_friction', 'pulley_body')
    both = problem.fitted(alone.model.joined(twin, {'torque': 0.01}))
    assert unsized(problem, both) == {0, 1}
