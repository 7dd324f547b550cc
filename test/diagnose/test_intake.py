"""Admission: sound recordings pass untouched, whatever effects there are; else it says why."""

from dataclasses import replace
import re

import numpy as np
import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.bags.reader import read_recording
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.resources import config_path
from tendon_ros.diagnose.intake import admitted
from tendon_ros.identify.driving import as_recorded
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument


def untouched(before, after):
    return all(
        a.channels.keys() == b.channels.keys()
        and all(np.array_equal(a[n].value, b[n].value) for n in a.channels)
        for a, b in zip(before, after, strict=True)
    )


def test_sound_recordings_pass_as_they_are(bench, sound):
    intake = admitted(sound, bench)
    assert intake.left_out == ()
    assert untouched(sound, intake.recordings)


@pytest.mark.parametrize('case', [0, 3, 7, 9])
def test_practice_bags_pass_without_complaint(bench, practice, case):
    bags = [read_recording(practice / f'case_{case:02}' / n) for n in ('contact', 'free', 'mixed')]
    intake = admitted(bags, bench)
    assert intake.left_out == ()
    assert untouched(bags, intake.recordings)


def test_a_real_tool_passes_without_complaint(davinci_npz):
    mapping = load_mapping(config_path('imports/davinci_grasper.yaml'))
    runs = list(import_runs(davinci_npz, mapping, ['00', '09', '24', '45']))
    intake = admitted(runs, load_instrument('davinci_grasper'))
    assert intake.left_out == ()
    assert untouched(runs, intake.recordings)


@pytest.mark.parametrize('name', ['single_body', 'wrist_two_jaws'])
def test_other_rigs_pass_without_complaint(name, recorded):
    rig = load_instrument(name)
    runs = recorded(rig)
    intake = admitted(runs, rig)
    assert intake.left_out == ()
    assert untouched(runs, intake.recordings)


@pytest.mark.parametrize(
    ('effect', 'place', 'parameters'),
    [
        ('torque_gain', 'motor_M', {'gain': 0.5}),
        ('torque_gain', 'motor_L', {'gain': 2.0}),
        ('sensor_rectified', 'torque_L', {'rectified': 1.0}),
        ('sensor_rectified', 'load_cell', {'rectified': 1.0}),
        ('encoder_offset', 'encoder_1', {'angle': 0.05}),
        ('sensor_delay', 'load_cell', {'time': 0.05}),
        ('backlash', 'motor_M', {'angle': 0.03}),
        ('coulomb_friction', 'pulley_3', {'torque': 1.0}),
        ('tension_friction', 'pulley_3', {'coefficient': 0.4}),
        ('gravity', 'pulley_3', {'torque': 1.0, 'phase': 0.8}),
        ('joint_spring', 'pulley_2', {'stiffness': 2.0, 'rest': 0.0}),
        ('torque_saturation', 'motor_M', {'limit': 1.0}),
        ('contact_stiffness', 'contact', {'scale': 1e-3}),
        ('cable_slip', 'cable_L3', {'jump': 2e-3, 'time': 3.0}),
        ('disturbance', 'pulley_3', {'torque': 1.0, 'start': 2.0, 'duration': 0.5}),
    ],
)
@pytest.mark.parametrize('channels', [('',), ('actuator/', 'setpoint/')])
def test_an_effect_is_not_bad_input(bench, recorded, only, effect, place, parameters, channels):
    runs = only(recorded(bench, [EffectUse(effect, place, parameters)]), *channels)
    intake = admitted(runs, bench)
    assert intake.left_out == ()
    assert untouched(runs, intake.recordings)


def test_a_weight_that_the_file_lacks_is_not_a_wrong_sign(recorded):
    """A pendulum's torque runs against that of its inertia, yet the drive spends energy."""
    body = load_instrument('single_body')
    use = EffectUse('gravity', 'pulley_body', {'torque': 0.5, 'phase': 0.0})
    assert admitted(recorded(body, [use]), body).left_out == ()


def test_no_recording(bench):
    with pytest.raises(RecordingError, match='no recording to diagnose; give at least one bag'):
        admitted([], bench)


def test_what_reading_left_out_is_said(bench, sound):
    said = replace(sound[0], warnings=('3 messages left out',))
    assert admitted([said, sound[1]], bench).left_out == ('contact: 3 messages left out',)


def test_the_same_bag_twice_counts_once(bench, sound):
    twin = replace(sound[0], name='copy')
    intake = admitted([*sound, twin], bench)
    assert [r.name for r in intake.recordings] == ['contact', 'free']
    assert intake.left_out == ('copy: holds the same samples as contact; counted once',)


def test_recordings_of_one_name_are_told_apart(bench, sound):
    intake = admitted([sound[0], replace(sound[1], name='contact')], bench)
    assert [r.name for r in intake.recordings] == ['contact', 'contact (2)']


def test_rigs_mixed_by_what_the_simulator_noted(bench, recorded, sound):
    heavy = replace(
        bench,
        pulleys=tuple(
            replace(p, inertia=2.0 * p.inertia) if p.name == '3' else p for p in bench.pulleys
        ),
    )
    mixed = [sound[0], recorded(heavy)[1]]
    with pytest.raises(
        RecordingError, match=r'free: .*another rig than contact \(pulleys\.3\.iner'
    ):
        admitted(mixed, bench)


def test_rigs_mixed_by_what_the_import_noted(bench, sound):
    first, second = (replace(r, metadata={'rig': f'tool {n}'}) for n, r in enumerate(sound))
    with pytest.raises(RecordingError, match='rig: tool 1 against tool 0'):
        admitted([first, second], bench)


def test_errors_are_one_line(bench, sound):
    body = load_instrument('single_body')
    with pytest.raises(RecordingError) as raised:
        admitted(sound, body)
    assert re.search('file does not fit.*pulley_body.*pulley_L, pulley_M', str(raised.value))
    assert '\n' not in str(raised.value)


def test_no_motor_position_at_all(bench, sound):
    blind = [
        replace(r, channels={n: c for n, c in r.channels.items() if n != name and name not in n})
        for r in sound
        for name in ['M/position']
    ]
    with pytest.raises(RecordingError, match='contact: a motor unmeasured: without actuator/pull'):
        admitted(blind, bench)
    blinder = [
        replace(r, channels={n: c for n, c in r.channels.items() if 'position' not in n})
        for r in sound
    ]
    with pytest.raises(RecordingError, match='contact: no motor position at all'):
        admitted(blinder, bench)


def test_what_is_lacking_may_be_there_under_another_name(bench, sound):
    def misspelt(name):
        return name.replace('pulley_L', 'pulley_Left') if name.endswith('position') else name

    renamed = [replace(r, channels={misspelt(n): c for n, c in r.channels.items()}) for r in sound]
    told = r'pulley_Left/position left out: .* has no pulley_Left; .*; then: .*a motor unmeasured'
    with pytest.raises(RecordingError, match=told):
        admitted(renamed, bench)


def test_nothing_to_compare(bench, sound):
    bare = [
        replace(
            r,
            channels={
                n: c
                for n, c in r.channels.items()
                if n.startswith('actuator') and n.endswith('position')
            },
        )
        for r in sound
    ]
    with pytest.raises(RecordingError, match=r'nothing to compare: .*actuator/pulley_L/effort'):
        admitted(bare, bench)


def test_a_torque_alone_asks_for_a_position(measured_on):
    body = load_instrument('single_body')
    run = measured_on(body)
    torque = 'actuator/pulley_body/effort'
    alone = replace(run, channels={torque: run[torque]})
    words = r'beside actuator/pulley_body/effort, .* one of actuator/pulley_body/position$'
    with pytest.raises(RecordingError, match=words):
        admitted([alone], as_recorded(body, {torque}))


def test_unknown_joints_are_left_out(bench, sound):
    position = sound[0]['pulley/pulley_1/position']
    extra = replace(position, name='pulley/pulley_thumb/position')
    intake = admitted([sound[0].with_channels([extra]), sound[1]], bench)
    assert untouched(sound, intake.recordings)
    assert (
        'pulley/pulley_thumb/position left out: bench_rig has no pulley_thumb'
        in intake.left_out[0]
    )
