"""Channels against what the model expects: sign, unit, dead, clipped."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.diagnose.intake import admitted
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument


@pytest.fixture(scope='module')
def boundless(bench):
    """Return the bench without limits on its motors' positions."""
    everywhere = (float('-inf'), float('inf'))
    return replace(
        bench, motors=tuple(replace(m, position_limit=everywhere) for m in bench.motors)
    )


def left_out_of_all(intake, name, words):
    said = [s for s in intake.left_out if f'{name} left out' in s]
    return (
        all(name not in r for r in intake.recordings)
        and len(said) == len(intake.left_out) == len(intake.recordings)
        and all(words in s for s in said)
    )


@pytest.mark.parametrize(
    ('name', 'factor', 'words'),
    [
        ('actuator/pulley_M/effort', -1.0, 'the wrong sign'),
        ('actuator/pulley_L/effort', -1.0, 'the wrong sign'),
        ('load_cell/force', -1.0, 'the wrong sign'),
        ('pulley/pulley_1/position', -1.0, 'the wrong sign'),
        ('pulley/pulley_2/position', -1.0, 'the wrong sign'),
        ('pulley/pulley_3/position', 180.0 / np.pi, 'degrees instead of rad'),
        ('pulley/pulley_3/position', -180.0 / np.pi, 'and the wrong sign'),
        ('pulley/pulley_1/position', 16384 / (2.0 * np.pi), 'counts'),
        ('actuator/pulley_M/effort', 1e3, 'mN m instead of N m'),
        ('load_cell/force', 1e-3, 'kN instead of N'),
    ],
)
def test_sign_and_unit(bench, sound, scaled, name, factor, words):
    assert left_out_of_all(admitted(scaled(sound, name, factor), bench), name, words)


@pytest.mark.parametrize('name', ['single_body', 'wrist_two_jaws'])
def test_sign_and_unit_on_other_rigs(name, recorded, scaled):
    rig = load_instrument(name)
    runs = recorded(rig)
    channel = f'actuator/pulley_{rig.driven[-1]}/effort'
    for factor, words in ((-1.0, 'the wrong sign'), (1e3, 'mN m')):
        bad = scaled(runs, channel, factor)
        if name == 'single_body':
            with pytest.raises(RecordingError, match=rf'{words}.*; then: .*nothing to compare'):
                admitted(bad, rig)
        else:
            assert left_out_of_all(admitted(bad, rig), channel, words)


@pytest.mark.parametrize('motor', ['M', 'L'])
def test_a_motor_position_of_the_wrong_sign(bench, sound, scaled, motor):
    name = f'actuator/pulley_{motor}/position'
    free = scaled(sound[1:], name, -1.0)
    with pytest.raises(
        RecordingError, match=f'{name} has the wrong sign: turned, all else agrees'
    ):
        admitted(free, bench)


def test_motor_positions_in_degrees_without_limits_or_setpoints(boundless, sound, scaled, only):
    runs = only(sound, 'actuator', 'pulley', 'load_cell')
    for motor in 'ML':
        runs = scaled(runs, f'actuator/pulley_{motor}/position', 180.0 / np.pi)
    with pytest.raises(RecordingError, match='are in degrees, for then all else agrees'):
        admitted(runs, boundless)


def test_everything_in_degrees(boundless, sound, scaled):
    runs = sound
    for name in [n for n in sound[0].channels if n.endswith('position')]:
        runs = scaled(runs, name, 180.0 / np.pi)
    with pytest.raises(RecordingError, match='degrees'):
        admitted(runs, boundless)


def test_one_bad_recording_does_not_condemn_the_others(bench, sound, scaled):
    bad = scaled(sound[1:], 'pulley/pulley_1/position', -1.0)
    intake = admitted([sound[0], *bad], bench)
    assert 'pulley/pulley_1/position' in intake.recordings[0]
    assert 'pulley/pulley_1/position' not in intake.recordings[1]


def test_a_dead_channel(bench, sound, spoilt):
    for name in ('pulley/pulley_3/position', 'actuator/pulley_M/effort'):
        runs = spoilt(sound, name, lambda t, v: (t, np.full_like(v, v[0])))
        intake = admitted(runs, bench)
        assert name not in intake.recordings[1]
        assert any(f'free: {name} left out: it stays at' in s for s in intake.left_out)


@pytest.mark.parametrize('step', [0.0, 2e-3])
def test_a_channel_of_noise_alone_is_dead_where_the_motion_should_change_it(
    bench, sound, spoilt, step
):
    """An open input floats: nothing of what moves shows in it."""
    noise = np.random.default_rng(4)

    def floating(t, v):
        read = 0.01 + 2e-3 * noise.standard_normal(v.size)
        return t, step * np.round(read / step) if step else read

    name = 'actuator/pulley_M/effort'
    intake = admitted(spoilt(sound, name, floating), bench)
    assert all(name not in run for run in intake.recordings)
    said = [s for s in intake.left_out if f'{name} left out: it stays at 0.0' in s]
    assert len(said) == len(sound)
    assert all('but for noise where the motion should change it' in s for s in said)


def test_noise_is_no_dead_channel_where_nothing_should_change_it(bench, sound, spoilt):
    noise = np.random.default_rng(4)
    runs = spoilt(
        sound[1:], 'load_cell/force', lambda t, v: (t, 0.02 * noise.standard_normal(v.size))
    )
    assert admitted([sound[0], *runs], bench).left_out == ()


def test_a_load_cell_that_nothing_touches_is_not_dead(bench, sound, spoilt):
    runs = spoilt(sound[1:], 'load_cell/force', lambda t, v: (t, np.zeros_like(v)))
    assert admitted([sound[0], *runs], bench).left_out == ()


def test_clipped_samples_are_taken_out(bench, sound, spoilt):
    runs = spoilt(sound, 'load_cell/force', lambda t, v: (t, np.minimum(v, 30.0)))
    intake = admitted(runs, bench)
    force = intake.recordings[0]['load_cell/force'].value
    assert force.max() < 30.0
    assert force.size < runs[0]['load_cell/force'].value.size
    assert len(intake.left_out) == 1
    assert 'contact: load_cell/force is clipped at 30 N in ' in intake.left_out[0]


def test_a_clipped_effort(bench, sound, spoilt):
    runs = spoilt(sound, 'actuator/pulley_L/effort', lambda t, v: (t, np.clip(v, -1.9, 0.8)))
    intake = admitted(runs, bench)
    for run in intake.recordings:
        assert np.abs(run['actuator/pulley_L/effort'].value).max() < 1.9
    assert all('actuator/pulley_L/effort is clipped' in s for s in intake.left_out)


def test_a_hold_is_not_clipped(bench, sound, spoilt):
    """At rest a coarse converter gives one value for seconds, often the largest of all."""
    for name, step in (('load_cell/force', 0.5), ('actuator/pulley_M/effort', 0.05)):
        runs = spoilt(sound, name, lambda t, v, s=step: (t, s * np.round(v / s)))
        assert admitted(runs, bench).left_out == ()


def test_a_motor_at_its_limit_is_not_clipped(bench, recorded):
    weak = replace(
        bench,
        motors=tuple(
            replace(m, controller=replace(m.controller, limit=1.0)) for m in bench.motors
        ),
    )
    assert admitted(recorded(weak), weak).left_out == ()
    # nor is it where the file does not know the limit: that is an effect
    use = EffectUse('torque_saturation', 'motor_M', {'limit': 1.0})
    assert admitted(recorded(bench, [use]), bench).left_out == ()
    assert admitted(recorded(weak), bench).left_out == ()
