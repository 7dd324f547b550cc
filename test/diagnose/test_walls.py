"""What the tip met in each recording: a wall of the file, a load, or nothing."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.gather import pushed_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory


def test_contacts_are_found_for_each_recording(bench, pressed, free):
    ready = prepared([pressed, free], bench)
    first, second = ready.whole.rollouts.segments
    assert first.contacts == ('tip',)
    assert second.contacts == ()
    assert not first.pushed
    assert not second.pushed
    assert pushed_words(ready) == []


def test_contacts_are_found_without_a_load_cell(bench, pressed, free, only):
    runs = only([pressed, free], 'actuator/', 'setpoint/')
    first, second = prepared(runs, bench).whole.rollouts.segments
    assert first.contacts == ('tip',)
    assert second.contacts == ()


@pytest.mark.parametrize('scale', [0.3, 3.0])
@pytest.mark.parametrize('angle', [-0.04, 0.02])
def test_a_wall_that_presses_with_another_force_was_met(bench, measured_on, only, scale, angle):
    run = measured_on(
        bench,
        ('contact_stiffness', 'contact', {'scale': scale}),
        ('encoder_offset', 'encoder_L', {'angle': angle}),
        trajectory='paper_fig12',
        settings=(),
        touching=True,
    )
    [segment] = prepared(only([run], 'actuator/'), bench).whole.rollouts.segments
    assert segment.contacts == ('tip',)


def test_a_bias_is_no_wall(bench, measured_on, only):
    runs = [
        measured_on(
            bench,
            ('torque_bias', 'motor_L', {'torque': bias}),
            ('coulomb_friction', 'pulley_M', {'torque': 0.2}),
            name=f'{bias:g}',
        )
        for bias in (-0.5, -0.25, 0.25, 0.5)
    ]
    for segment in prepared(only(runs, 'actuator/'), bench).whole.rollouts.segments:
        assert segment.contacts == ()


@pytest.mark.parametrize('bias', [0.0, 0.5])
def test_a_cell_that_touches_nothing_does_not_push(bench, free, bias):
    cell = free['load_cell/force']
    run = free.with_channels([Channel(cell.name, cell.time, cell.value + bias)])
    [segment] = prepared([run], bench).whole.rollouts.segments
    assert not segment.pushed
    assert 'load_cell/force' in {m.sensor.channel for m in segment.measured}


def test_a_torque_without_its_sign_denies_no_wall(bench, measured_on):
    rectified = measured_on(
        bench,
        ('sensor_rectified', 'torque_L', {'rectified': 1.0}),
        trajectory='paper_fig12',
        settings=(),
        touching=True,
    )
    kept = {k: c for k, c in rectified.channels.items() if k.startswith('actuator/')}
    [segment] = prepared([replace(rectified, channels=kept)], bench).whole.rollouts.segments
    assert segment.contacts == ('tip',)


def test_a_measured_load_pushes_where_no_wall_fits(bench, measured_on):
    # something soft at another place than the wall of the file
    soft = replace(
        bench,
        contacts=tuple(
            replace(c, stiffness=0.005 * c.stiffness, position=-0.15, damping=0.0)
            for c in bench.contacts
        ),
    )
    run = measured_on(soft, touching=True, trajectory='paper_fig12', settings=())
    ready = prepared([run], bench)
    [segment] = ready.whole.rollouts.segments
    assert segment.pushed == ('2',)
    [words] = pushed_words(ready)
    assert 'load pushes the model and is no longer compared' in words
    left = ready.whole.left(ready.whole.empty)
    assert np.mean(left**2) < 2.0


@pytest.mark.parametrize('bias', [0.0, 0.02])
def test_a_known_bias_of_the_cell_is_no_reason_against_a_load(bias):
    grasper = load_instrument('davinci_grasper')
    held = EffectUse('joint_spring', 'pulley_jaw', {'stiffness': 0.04, 'rest': -1.0})
    motion = chosen_trajectory(
        'multisine', grasper.motor_names, {'amplitude': '20 deg', 'duration': '4 s'}
    )
    run = simulate(replace(grasper, effects=(held,)), motion, rate=200.0)
    jaw = run['pulley/pulley_jaw/position']
    load = Channel('load_cell/torque', jaw.time, 0.04 * (jaw.value + 1.0) + bias)
    channels = {s.channel for s in grasper.sensors}
    kept = {n: c for n, c in run.channels.items() if n in channels or n.startswith('setpoint/')}
    known = EffectUse('load_cell_bias', 'load_cell', {'force': bias})
    run = replace(run, channels=kept).with_channels([load])
    ready = prepared([run], replace(grasper, effects=(known,) if bias else ()))
    [segment] = ready.whole.rollouts.segments
    assert segment.pushed == ('jaw',)
