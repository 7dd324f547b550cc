"""Guesses of a kind lean towards one factor where torque drives, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.alike import leaning
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.driving import as_recorded
from tendon_ros.identify.multistart import kinds_of
from tendon_ros.model.instrument import Curve
from tendon_ros.model.instrument_file import load_instrument

SOFT = 0.15  # times the stiffness that the tutorial guesses


@pytest.fixture(scope='module')
def ready(by_voltage):
    run = by_voltage(10.0)
    belt = as_recorded(load_instrument('belt_by_voltage'), set(run.channels))
    curves = tuple(
        Curve(c.name, tuple(x / SOFT for x in c.elongation), c.tension) for c in belt.curves
    )
    return prepared([run], replace(belt, curves=curves))


@pytest.fixture(scope='module')
def leant(ready):
    belt = ready.problem.rollouts.instrument
    said = []
    found = leaning(
        ready, everyone(belt, [s.channel for s in belt.sensors]), lambda *s: said.append(s)
    )
    assert said == [('looking over what is guessed', 0.0)]
    return found


def test_guesses_of_a_kind_lean_towards_one_factor(ready, leant):
    assert not ready.problem.begun.moved.any()
    begun = leant.problem.begun.moved
    factors = {}
    for n, kind in kinds_of(leant.problem).items():
        axis = leant.problem.tolerances[n].axis
        if axis.log:
            factors.setdefault(kind, set()).add(round(axis.value(float(begun[n])), 9))
    assert all(len(found) == 1 for found in factors.values())
    # in proportion to the torque, of which the unit is guessed as well
    [stiff], [unit] = factors['stiffness'], factors['torque_gain']
    assert 0.4 / SOFT < stiff / unit < 2.5 / SOFT
    measured = [n for n in range(len(begun)) if n not in kinds_of(leant.problem)]
    assert not begun[measured].any()


def test_what_guesses_cost_counts_from_there(ready, leant):
    there, file = (
        leant.problem.fitted(m, rounds=0) for m in (leant.problem.begun, ready.problem.empty)
    )
    assert there.cost == pytest.approx(float(there.left @ there.left))
    assert file.cost > float(file.left @ file.left)
    # the gap is still that of the file
    assert np.array_equal(
        leant.problem.left(leant.problem.empty), ready.problem.left(ready.problem.empty)
    )


def test_it_is_not_forgotten_when_noise_or_blocks_change(leant):
    for other in (leant.moved(1), leant.loosened(2.0), leant.heard_again(leant.problem.empty)):
        assert np.array_equal(other.problem.begun.moved, leant.problem.begun.moved)
        assert np.array_equal(other.held.begun.moved, leant.problem.begun.moved)


def test_what_is_likely_makes_no_interval_narrower(ready, leant):
    guessed = np.array([t.guessed for t in leant.problem.tolerances])
    free = leant.unleant().problem
    held, let = (p.prior(p.empty) for p in (leant.problem, free))
    assert np.all(let[guessed] < held[guessed])
    assert np.array_equal(let[~guessed], held[~guessed])
    assert np.array_equal(free.begun.moved, leant.problem.begun.moved)
    assert ready.unleant() is ready


def test_what_leans_on_nothing_stays_so_where_laws_are_doubted(leant):
    free = leant.unleant()
    doubting = free.allowing(free.problem.empty, free.problem.empty)
    for problem, was in zip(
        (doubting.problem, doubting.held, doubting.whole),
        (free.problem, free.held, free.whole),
        strict=True,
    ):
        assert problem.tolerances == was.tolerances
        assert len(problem.predicted(problem.empty)) == len(was.predicted(was.empty))


def test_where_motion_drives_guesses_stay_with_the_file(measured_on):
    axis = load_instrument('driven_axis')
    ready = prepared([measured_on(axis)], axis)
    assert any(t.guessed for t in ready.problem.tolerances)
    assert leaning(ready, everyone(axis, [s.channel for s in axis.sensors])) is ready
