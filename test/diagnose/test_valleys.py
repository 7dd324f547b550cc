"""Fits of guesses get out of a valley that is not the deepest, and only they are moved."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose import valleys
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.valleys import nudged, touched, waved
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory import Trajectory

#: times what the file says, and what is added to dampings: where a fit from afar had ended
VALLEY = {
    'pulley_M.inertia': 1.163, 'pulley_L.inertia': 2.576, 'pulley_1.inertia': 0.91,
    'pulley_2.inertia': 0.969, 'pulley_3.inertia': 0.54, 'cable_m1.pretension': 2.159,
    'cable_m1.stiffness': 0.334, 'cable_12.pretension': 0.747, 'cable_12.stiffness': 1.657,
    'cable_L3.pretension': 0.431, 'cable_L3.stiffness': 0.796, 'pulley_M.damping': -0.018,
    'pulley_L.damping': 0.047, 'pulley_1.damping': 0.003, 'pulley_2.damping': 0.009,
    'pulley_3.damping': 0.072,
}  # fmt: skip


def test_guesses_get_out_of_a_valley_in_which_one_cable_is_soft_for_another():
    case = made(1075, 1, Settings(bench='guessed'))
    assert case.label['stratum'] == 'none'
    # one recording is enough: the valley is as deep in each
    problem = prepared([case.recordings['mixed']], case.instrument).problem
    moved = [
        t.axis.place(VALLEY[name]) if (name := f'{t.place}.{t.quantity}') in VALLEY else 0.0
        for t in problem.tolerances
    ]
    stuck = problem.fitted(replace(problem.empty, moved=np.array(moved)), rounds=20)
    out = nudged(Steps(problem, [], 1, lambda *_: None), stuck)
    assert out.cost < 0.95 * stuck.cost
    assert problem.structured(out.left) < 0.5 * problem.structured(stuck.left)
    assert not out.model.causes


def test_a_stop_whose_place_is_guessed_is_found_where_it_is(measured_on):
    """A stiff one: its torque tells of its place within milliradians only."""
    axis = load_instrument('driven_axis')
    [hand] = axis.contacts
    axis = replace(
        axis,
        tolerances=axis.tolerances | {'contact.position': np.inf, 'contact.stiffness': np.inf},
    )
    file = replace(axis, contacts=(replace(hand, position=0.216, stiffness=6e4, enabled=True),))
    there = replace(axis, contacts=(replace(hand, position=0.2, stiffness=4e4),))
    settings = (('duration', '8 s'), ('amplitude', '25 deg'))
    problem = prepared([measured_on(there, settings=settings, touching=True)], file).problem
    steps = Steps(problem, [], 1, lambda *_: None)
    stuck = steps.settled(problem.begun)
    found = touched(steps, stuck)
    [at] = [
        t.axis.value(float(z))
        for t, z in zip(problem.tolerances, found.model.moved, strict=True)
        if t.quantity == 'position'
    ]
    assert found.cost < 0.5 * stuck.cost
    assert at == pytest.approx(-0.016, abs=2e-3)


def test_nothing_is_nudged_where_nothing_is_guessed(bench, measured_on):
    softer = ('cable_stiffness', 'cable_12', {'scale': 0.6})
    run = measured_on(bench, softer, touching=True, trajectory='paper_fig12', settings=())
    problem = prepared([run], bench).problem
    start = problem.fitted(problem.empty)
    steps = Steps(problem, [], 1, lambda *_: None)
    assert nudged(steps, start) is touched(steps, start) is start


def test_a_ripple_gets_out_of_a_number_of_waves_that_is_not_its_own():
    body = load_instrument('single_body')
    ripple = Candidate('torque_ripple', 'motor_body')
    true = {'amplitude': 0.1, 'cycles': 14.0, 'phase': 0.3}
    time = np.arange(0.0, 16.0, 0.01)
    turns = Trajectory('turns', time, {'body': 4.0 * np.pi * np.sin(0.5 * time) ** 2})
    rig = replace(body, effects=(*body.effects, EffectUse(ripple.effect, ripple.place, true)))
    problem = prepared([simulate(rig, turns, seed=1)], body).problem
    steps = Steps(problem, [ripple], 1, lambda *_: None)
    start = problem.fitted(problem.empty)
    stuck = problem.fitted(problem.empty.joined(ripple, {**true, 'cycles': 12.5}))
    assert stuck.model.values(0)['cycles'] < 13.5
    out = waved(steps, stuck, 0, start)
    assert out.model.values(0)['cycles'] == pytest.approx(14.0, abs=0.05)
    assert out.model.values(0)['amplitude'] == pytest.approx(0.1, rel=0.1)
    assert waved(steps, out, 0, start) is out
    bias = problem.fitted(
        problem.empty.joined(Candidate('torque_bias', 'motor_body'), {'torque': 0.01})
    )
    assert waved(steps, bias, 0, start) is bias


@pytest.mark.parametrize(('count', 'seen'), [(2, 2), (7, 5)])
def test_of_many_recordings_a_few_tell_where_guesses_begin(
    bench, measured_on, monkeypatch, count, seen
):
    """And few are looked at as they are: a rougher look has led into the wrong valley."""
    runs = [measured_on(bench, seed=s, name=f'run_{s}') for s in range(count)]
    problem = prepared(runs, bench).problem
    asked = []
    monkeypatch.setattr(valleys, 'afar', lambda of, _model: asked.append(of) or [])
    assert valleys.from_afar(Steps(problem, [], 1, lambda *_: None), problem.begun) is None
    [of] = asked
    assert len(of.rollouts.segments) == seen
    assert (of is problem) == (count == seen)
