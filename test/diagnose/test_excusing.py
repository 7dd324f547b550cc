"""Torque limits that excuse: what they are, what may not come beside them, and the way back up."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from tendon_ros.diagnose.excusing import (
    excused,
    excuses,
    needs_excuse,
    raised,
)
from tendon_ros.diagnose.first import FirstRound
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.motor_gain import motor_gain
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.screening import Screen
from tendon_ros.identify.starting import Starting
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument

CUT = Candidate('torque_saturation', 'motor_axis')


@pytest.fixture(scope='module')
def cut_at(measured_on):
    """Return a function that makes the problem of an axis whose torque is cut off."""
    axis = load_instrument('driven_axis')
    swings = (('duration', '6 s'), ('amplitude', '40 deg'))

    def made(limit):
        cut = (CUT.effect, CUT.place, {'limit': limit, 'knee': 0.05})
        return prepared([measured_on(axis, cut, settings=swings)], axis).problem

    return made


@pytest.mark.parametrize(('limit', 'sunk'), [(3.0, False), (0.005, True)])
def test_a_limit_that_nearly_all_torques_pass_is_none(sound_problem, limit, sunk):
    model = sound_problem.empty
    model = model.joined(Candidate('torque_gain', 'motor_M'), {'gain': 0.9})
    model = model.joined(Candidate('torque_saturation', 'motor_M'), {'limit': limit, 'knee': 0.01})
    assert excuses(sound_problem, model, 1) is sunk
    assert not excuses(sound_problem, model, 0)
    # whoever joins may bend another one into an excuse
    model = model.joined(Candidate('coulomb_friction', 'pulley_M'), {'torque': 0.1})
    limits = {Candidate('torque_saturation', 'motor_M')} if sunk else set()
    assert excused(sound_problem, model) == limits


@pytest.mark.parametrize(('knee', 'bends'), [(0.6, True), (0.4, False)])
def test_a_limit_that_bends_all_torques_is_none_where_they_are_known(sound_problem, knee, bends):
    """A ripple that is not told yet gives a true limit such a knee: so it may come in with it."""
    limit = Candidate('torque_saturation', 'motor_M')
    model = sound_problem.empty.joined(limit, {'limit': 1.0, 'knee': knee})
    assert excuses(sound_problem, model, 0) is bends
    again = raised(sound_problem, model)
    assert again.values(0)['limit'] == 1.0
    assert again.values(0)['knee'] <= knee
    assert not excuses(sound_problem, again, 0)


@pytest.mark.parametrize(('place', 'limit', 'needs'), [
    ('motor_M', 3.0, False), ('motor_M', 0.005, True), ('motor_L', 0.005, False),
])  # fmt: skip
def test_a_gain_beside_a_limit_that_excuses_is_none(sound_problem, place, limit, needs):
    model = sound_problem.empty.joined(
        Candidate('torque_saturation', 'motor_M'), {'limit': limit, 'knee': 0.01}
    )
    model = model.joined(Candidate('torque_gain', place), {'gain': 5.0})
    assert needs_excuse(sound_problem, model, 1) is needs
    assert not needs_excuse(sound_problem, model, 0)


def test_a_limit_that_sank_is_raised_to_where_it_excuses_no_more(sound_problem):
    limit, friction = Candidate('torque_saturation', 'motor_M'), Candidate('gravity', 'pulley_M')
    model = sound_problem.empty.joined(limit, {'limit': 0.005, 'knee': 0.4})
    model = model.joined(friction, {'torque': 0.1, 'phase': 0.0})
    again = raised(sound_problem, model)
    assert set(again.causes) == {limit, friction}
    assert not excused(sound_problem, again)
    assert raised(sound_problem, again) is again
    gain = motor_gain(sound_problem, again, 'M')
    usual = sound_problem.rollouts.usual('M', gain)
    assert usual < again.values(again.causes.index(limit))['limit'] < 1.2 * usual


def test_limits_are_looked_for_among_what_the_motor_gives(cut_at):
    """And not among what it reports, where that is twice or half as much."""
    problem = cut_at(0.06)
    gives = Candidate('torque_gain', 'motor_axis')

    def levels(model):
        state = problem.fitted(model, rounds=0)
        return [values['limit'] for _, values in Starting(problem, state).of(CUT)]

    known = levels(problem.begun)
    for gain in (0.5, 2.0):
        scaled = levels(problem.begun.joined(gives, {'gain': gain}))
        assert scaled == pytest.approx([gain * level for level in known])


@pytest.fixture(scope='module')
def half_cut(cut_at):
    """Return the problem of an axis of which half of the torques are cut off, and its start."""
    problem = cut_at(0.06)
    return problem, problem.fitted(problem.begun)


SUNK = {'limit': 0.002, 'knee': 0.3}


@pytest.mark.parametrize(('left', 'comes'), [(1.0, True), (0.05, False)])
def test_a_limit_that_sinks_comes_in_where_nothing_explains_as_much(half_cut, left, comes):
    problem, start = half_cut
    steps = Steps(problem, [CUT], 1, lambda *_: None)
    proposal = steps.screened(Screen(problem, start))[0]
    sunk = replace(proposal, z=CUT.coordinates.place(SUNK))
    # what another one would leave, too
    state = replace(start, cost=left * start.cost)
    rivals = steps.fitted(state, [sunk], 0.0)
    assert [r.candidate for r in rivals] == ([CUT] if comes else [])
    assert all(excuses(problem, r.fit.model, 0) for r in rivals)


def test_a_limit_that_sank_finds_its_way_up(half_cut):
    problem, _ = half_cut
    sunk = problem.fitted(problem.begun.joined(CUT, SUNK), rounds=8)
    assert excuses(problem, sunk.model, 0)
    state = Steps(problem, [CUT], 1, lambda *_: None).raised(sunk)
    assert state.cost < sunk.cost
    assert not excuses(problem, state.model, 0)


@pytest.mark.parametrize(
    ('values', 'comes'), [(SUNK, False), ({'limit': 0.06, 'knee': 0.05}, True)]
)
def test_an_excuse_is_not_taken_where_few_are_asked(half_cut, values, comes):
    """Without any size only signs are asked, beside which it is no merit to leave little."""
    problem, start = half_cut
    alone = problem.fitted(problem.begun.joined(CUT, values), rounds=0)
    usual = SimpleNamespace(
        grown=lambda *_: None, alone=lambda *_: alone, believes=lambda *_: True
    )
    steps = Steps(problem, [CUT], 1, lambda *_: None)
    found = FirstRound(steps, start, usual, {})._from_the_file()
    assert (found is alone) is comes


@pytest.mark.parametrize(('limit', 'stands'), [(0.45, True), (0.8, False)])
@pytest.mark.parametrize('own', [False, True])
def test_a_limit_that_just_overcomes_what_rubs_is_none(cut_at, limit, stands, own):
    problem = cut_at(3.0)
    rig = problem.rollouts.instrument
    rubs = {'static': 0.2, 'sliding': 0.4, 'speed': 0.1}
    model = problem.empty.joined(CUT, {'limit': limit, 'knee': 0.01})
    if own:
        friction = EffectUse('stribeck_friction', f'pulley_{rig.motors[0].pulley}', rubs)
        rig = replace(rig, effects=(friction,))
        segments = problem.rollouts.segments
        problem = Problem(Rollouts(rig, segments), problem.tolerances, problem.masks)
    else:
        friction = Candidate('stribeck_friction', f'pulley_{rig.motors[0].pulley}')
        model = model.joined(friction, rubs)
    assert problem.rollouts.usual('axis', 1.0) < 0.4
    assert excuses(problem, model, 0) is stands
