"""The proposed experiment is what separates, on simulated data that is fitted afterwards."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import EffectError
from tendon_ros.base.recording import Recording
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import as_recorded, drives
from tendon_ros.identify.effort import Effort
from tendon_ros.identify.excitation import separating, together
from tendon_ros.identify.excitation_channel import channels
from tendon_ros.identify.excitation_motion import library
from tendon_ros.identify.excitation_rig import fitting, performed, reaches, touching
from tendon_ros.identify.excitation_trial import Trial
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import segment_of, SETTLING
from tendon_ros.identify.tolerance import tolerances
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

TIGHT = (Candidate('pretension', 'cable_m1'), {'scale': 0.8})
LOOSE = (Candidate('pretension', 'cable_12'), {'scale': 0.8})
ENCODER = 'pulley/pulley_1/position'
MOTORS = [f'actuator/pulley_{m}/{what}' for m in 'ML' for what in ('position', 'effort')]


@pytest.fixture(scope='module')
def rig():
    """Return the bench."""
    return load_instrument('bench_rig')


@pytest.fixture(scope='module')
def found(rig):
    """Return what would separate two pretensions when only the motors are measured."""
    return separating(rig, MOTORS, [(TIGHT, LOOSE)])


def cost(rig, trajectory, channels, candidate):
    """Return the squares that a candidate leaves of a recording of the rig with TIGHT."""
    true = replace(rig, effects=(EffectUse('pretension', 'cable_m1', TIGHT[1]),))
    whole = simulate(true, trajectory, seed=3)
    kept = {name: c for name, c in whole.channels.items() if name in channels}
    segment = segment_of(rig, Recording('run', kept, whole.epoch_ns, whole.metadata), 0.008)
    contacts = tuple(c.name for c in rig.contacts if c.enabled)
    problem = Problem(
        Rollouts(rig, [replace(segment, contacts=contacts)]),
        tolerances(rig),
        [segment.time > SETTLING],
    )
    model = problem.empty.joined(candidate, {'scale': 0.8})
    return problem.fitted(model, rounds=8).cost


def test_motor_signals_alone_never_separate_loops_in_series(found):
    alone = [s for s in found if not s.add_channel]
    assert alone
    assert all(s.seconds == np.inf and s.deviations < 1.0 for s in alone)


def test_an_encoder_on_pulley_1_is_proposed(found):
    best = found[0]
    assert best.add_channel == ENCODER
    assert best.seconds <= 60.0
    assert best.separates == (('pretension', 'cable_m1'), ('pretension', 'cable_12'))
    assert ENCODER in best.do
    assert found == sorted(found, key=lambda s: s.order)


def test_the_proposal_separates_where_the_usual_run_does_not(rig, found):
    best = found[0]
    there = replace(
        rig,
        contacts=tuple(replace(c, enabled=c.name == best.motion.against) for c in rig.contacts),
    )
    proposed = best.motion.trajectory(rig.motor_names)
    usual = chosen_trajectory('multisine', rig.motor_names, {'duration': 6.0})
    names = [*MOTORS, best.add_channel]
    gain = {
        'usual': cost(rig, usual, MOTORS, LOOSE[0]) - cost(rig, usual, MOTORS, TIGHT[0]),
        'motors': cost(there, proposed, MOTORS, LOOSE[0])
        - cost(there, proposed, MOTORS, TIGHT[0]),
        'proposed': cost(there, proposed, names, LOOSE[0])
        - cost(there, proposed, names, TIGHT[0]),
    }
    assert abs(gain['usual']) < 25.0, gain
    assert abs(gain['motors']) < 25.0, gain
    assert gain['proposed'] > 100.0, gain
    foretold = best.deviations * proposed.duration**0.5
    assert foretold / 1.5 < gain['proposed'] ** 0.5 < foretold * 1.5


def test_what_is_told_from_nothing(rig):
    inertia = (Candidate('inertia', 'pulley_M'), {'scale': 1.5})
    quick = separating(rig, MOTORS, [(inertia, None)])
    best = quick[0]
    assert best.separates == (('inertia', 'pulley_M'),)
    assert not best.add_channel
    slow = [s for s in quick if s.motion.shape == 'slow_multisine' and not s.add_channel]
    # an inertia needs acceleration
    assert best.motion.shape in ('quick_steps', 'fast_multisine')
    assert best.deviations > 10.0 * max(s.deviations for s in slow)


def test_symmetric_encoder_offsets_need_an_inner_channel(rig):
    pair = tuple((Candidate('encoder_offset', f'encoder_{m}'), {'angle': 0.01}) for m in 'ML')
    found = separating(rig, [*MOTORS, 'load_cell/force'], [pair])
    assert found[0].add_channel.startswith('pulley/')
    assert all(s.seconds == np.inf for s in found if not s.add_channel)


def test_sensors_that_are_not_there_are_thought_of():
    paper = load_instrument('paper_rig')
    assert ENCODER not in [s.channel for s in paper.sensors]
    found = separating(paper, MOTORS, [(TIGHT, LOOSE)])
    best = {
        channel: next(s for s in found if s.add_channel == channel) for channel in ('', ENCODER)
    }
    assert best[ENCODER].status == 'missing'
    assert 'encoder on pulley 1' in best[ENCODER].do
    assert best[ENCODER].deviations > 2.0 * best[''].deviations


def test_one_experiment_for_several_pairs(rig, found):
    third = (Candidate('pretension', 'cable_L3'), {'scale': 0.8})
    every = [*found, *separating(rig, MOTORS, [(TIGHT, third)])]
    joint = together(every)
    best = joint[0]
    assert len(best.separates) == 3
    same = [
        s.deviations for s in every if (s.motion, s.add_channel) == (best.motion, best.add_channel)
    ]
    assert best.deviations == min(same)
    assert len(same) == 2


def test_a_place_where_nothing_can_act(rig):
    with pytest.raises(EffectError, match='no place'):
        separating(rig, MOTORS, [((Candidate('pretension', 'cable_x'), {'scale': 0.8}), None)])


def test_where_no_position_is_recorded_the_torques_move_the_model_as_the_rig_moves():
    belt = load_instrument('belt_by_voltage')
    seen = [s.channel for s in belt.sensors if s.kind != 'angle']
    driving = drives(as_recorded(belt, seen))
    assert all(d.by_torque for d in driving)
    sensed = channels(belt, driving, seen)
    motion = fitting(belt, library(belt, reaches(belt))[0])
    truth = (Candidate('coulomb_friction', 'pulley_left'), {'torque': 2e-3})
    trial = Trial(belt, driving, sensed, tolerances(belt), motion, truth, Effort())
    rig = replace(touching(belt, motion), effects=(truth[0].use(truth[1]),))
    rows, _ = performed(rig, motion.trajectory(belt.motor_names))
    for channel, said in zip(sensed, trial._said, strict=True):
        assert np.std(said) == pytest.approx(np.std(channel.reading(rows)), rel=0.1)
