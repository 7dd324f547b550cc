"""Tolerances: what the file states may move, as far as it states, and nothing else."""

from dataclasses import replace
import math

import pytest

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.tolerance import REACH, tolerances
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument


def by_name(instrument):
    return {f'{t.place}.{t.quantity}': t for t in tolerances(instrument)}


def test_a_file_that_states_nothing_is_as_good_as_files_are(bench):
    found = by_name(bench)
    for pulley in ('M', 'L', '1', '2', '3'):
        assert found[f'pulley_{pulley}.inertia'].effect == 'inertia'
        assert found[f'pulley_{pulley}.damping'].effect == 'viscous_friction'
    for loop in ('m1', '12', 'L3'):
        tight = found[f'cable_{loop}.pretension'].axis
        assert tight.value(1.0) - tight.value(0.0) < 0.05
        assert tight.spread == 1.0
    # nobody doubts a torque constant or a wall unless the file does
    assert not [name for name in found if 'torque_gain' in name or name.endswith('.position')]


def test_what_the_file_states(bench):
    stated = {
        'pulley_3.inertia': 0.1,
        'cable_L3.pretension': 0.0,
        'motor_M.torque_gain': 0.05,
        'contact.position': 0.01,
        'pulley_1.damping': math.inf,
        'cable_m1.stiffness': math.inf,
    }
    found = by_name(replace(bench, tolerances=stated))
    inertia = found['pulley_3.inertia'].axis
    assert inertia.value(1.0) == pytest.approx(1.1, rel=0.01)
    assert inertia.value(9.0) == pytest.approx(math.exp(REACH * 0.1))
    assert 'cable_L3.pretension' not in found
    assert found['motor_M.torque_gain'].axis.value(-1.0) == pytest.approx(0.95, rel=0.01)
    wall = found['contact.position'].axis
    assert wall.value(0.0) == 0.0
    assert wall.value(1.0) == pytest.approx(0.01)


def test_what_may_be_twice_as_large_may_be_half_as_large(bench):
    inertia = by_name(replace(bench, tolerances={'pulley_3.inertia': 0.3}))['pulley_3.inertia']
    assert not inertia.guessed
    assert inertia.axis.place(2.0) == pytest.approx(-inertia.axis.place(0.5))
    low, high = (inertia.axis.value(z) for z in inertia.axis.ends)
    assert low * high == pytest.approx(1.0)
    assert 2.4 < high < 2.5


def test_a_guess_may_be_anything_positive(bench):
    stated = {'cable_m1.stiffness': math.inf, 'pulley_1.damping': math.inf}
    found = by_name(replace(bench, tolerances=stated))
    stiff = found['cable_m1.stiffness'].axis
    assert stiff.log
    assert stiff.value(-1e3) > 0.0
    assert stiff.value(5.0) > 5.0
    damping = found['pulley_1.damping'].axis
    assert damping.value(20.0) > 5.0 * 0.02
    assert damping.spread > 5.0


def test_damping_of_zero_may_only_move_where_it_was_guessed(bench):
    still = replace(
        bench, pulleys=tuple(replace(p, damping=0.0) for p in bench.pulleys), tolerances={}
    )
    assert not [name for name in by_name(still) if name.endswith('.damping')]
    guessed = replace(still, tolerances={'pulley_2.damping': math.inf})
    assert 'pulley_2.damping' in by_name(guessed)


def test_what_the_tip_met_is_rarely_measured(bench):
    [contact] = bench.contacts
    assert 'contact.damping' not in by_name(bench)  # the file has a number
    silent = replace(bench, contacts=(replace(contact, damping=0.0),))
    some = by_name(silent)['contact.damping']
    assert (some.effect, some.parameter) == ('contact_stiffness', 'damping')
    assert some.axis.value(-5.0) == 0.0
    assert some.axis.value(1.0) == pytest.approx(1e-3 * contact.stiffness)
    assert not some.guessed
    guess = by_name(replace(bench, tolerances={'contact.damping': math.inf}))['contact.damping']
    assert guess.guessed
    assert guess.axis.value(-1e9) == -contact.damping
    # a guess is never narrower than silence
    hard = replace(contact, damping=0.0, stiffness=1e7)
    unknown = replace(bench, contacts=(hard,), tolerances={'contact.damping': math.inf})
    quiet = by_name(replace(bench, contacts=(hard,)))['contact.damping'].axis
    assert by_name(unknown)['contact.damping'].axis.high >= quiet.high


def test_a_push_that_happens_once_more_is_not_that_of_the_file(bench):
    push = EffectUse('disturbance', 'pulley_2', {'torque': 0.2, 'start': 1.0, 'duration': 0.5})
    known = replace(bench, effects=(push,), tolerances={'pulley_2.disturbance.torque': 0.1})
    [torque] = [t for t in tolerances(known) if t.effect == 'disturbance']
    assert not torque.is_moved_by(Candidate('disturbance', 'pulley_2'))


def test_an_effect_of_which_only_some_parameters_are_given_leaves_the_others_as_they_are(bench):
    # what a search finds of a cable is how stiff it is, and says nothing of its damping
    softer = EffectUse('cable_stiffness', 'cable_m1', {'scale': 0.8})
    guessed = {'cable_m1.damping': math.inf}
    found = by_name(replace(bench, effects=(softer,), tolerances=guessed))
    damping = found['cable_m1.damping']
    assert damping.given
    assert damping.axis.value(0.0) == 0.0


def test_an_angle_that_is_guessed_to_be_zero_may_turn():
    body = load_instrument('single_body')
    use = EffectUse(
        'torque_ripple', 'motor_body', {'amplitude': 0.0, 'cycles': 12.0, 'phase': 0.0}
    )
    name = 'motor_body.torque_ripple'
    rig = replace(
        body,
        effects=(use,),
        tolerances={f'{name}.phase': math.inf, f'{name}.amplitude': 0.1},
    )
    own = {t.parameter: t.axis for t in tolerances(rig) if t.effect == 'torque_ripple'}
    assert own['phase'].ends[1] > 1.0
    # a tenth of nothing is nothing
    assert set(own) == {'phase'}
