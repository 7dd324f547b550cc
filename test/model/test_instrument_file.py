"""Instrument files are read, checked field by field, and written back exactly."""

from dataclasses import replace
import math
from pathlib import Path

from hypothesis import given, HealthCheck, settings
from hypothesis import strategies as st
import pytest

from tendon_ros.base.errors import EffectError, InstrumentError
from tendon_ros.base.resources import config_path
from tendon_ros.effects import catalogue
from tendon_ros.model.effect_use import checked_use
from tendon_ros.model.instrument import EffectUse, Pulley, Sensor
from tendon_ros.model.instrument_file import find_instrument, load_instrument, save_instrument
from tendon_ros.model.numbers import place_index

INSTALLED = sorted(path.stem for path in config_path('instruments').glob('*.yaml'))

GOOD = """\
pulleys:
  M: {inertia: 2.25e-4 kg*m^2, damping: 0.9 N*m*s/rad}
  1: {inertia: 2.25e-4 kg*m^2}
  02: {inertia: 1 g*cm^2}
curves:
  steel:
    elongation: {mm: [0, 1, 2]}
    tension: {N: [0, 10, 100]}
loops:
  m1: {route: {M: 30 mm, 1: -30 mm}, curve: steel, pretension: 5 N}
couplings:
  shaft: {route: {1: 1, 02: -1}, stiffness: 15 N*m/rad}
motors:
  drive:
    pulley: M
    controller: {kp: 20 N*m/rad, limit: 5 N*m}
    gear_ratio: 35
    encoder: {counts: 4096}
    torque_sensor: {noise: 10 mN*m}
contacts:
  tip: {route: {02: 1}, arm: 50 mm, stiffness: 200 N/mm, damping: 3 s/m, position: 17 deg}
joint_sensors:
  1: {resolution: 0.1 deg}
speed_sensors:
  M: {resolution: 1 rpm}
  1: {noise: 0.1 rad/s}
shaft_sensors:
  02: {through: shaft}
load_cell: {noise: 0.05 N}
effects:
  - {effect: tension_friction, place: pulley_1, parameters: {coefficient: 0.12}}
"""


def write(folder: Path, text: str, name: str = 'rig.yaml') -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_reads_everything(tmp_path):
    rig = load_instrument(write(tmp_path, GOOD))
    assert rig.name == 'rig'
    assert rig.pulley_names == ('M', '1', '02')
    assert rig.pulleys[0] == Pulley('M', 2.25e-4, 0.9)
    assert rig.pulleys[2].inertia == 1e-7
    assert rig.loops[0].route == {'M': 0.03, '1': -0.03}
    assert rig.couplings[0].stiffness == 15.0
    assert rig.motors[0].torque_limit == math.inf
    assert rig.contacts[0].position == pytest.approx(math.radians(17), rel=1e-15)
    assert rig.control_period == 1e-3
    assert [use.effect for use in rig.effects] == ['tension_friction']


def test_sensors_have_the_names_and_channels_of_the_contract(tmp_path):
    rig = load_instrument(write(tmp_path, GOOD))
    assert rig.sensors == (
        Sensor(
            'encoder_M',
            'angle',
            'M',
            'actuator/pulley_M/position',
            resolution=2 * math.pi / 4096 / 35,
        ),
        Sensor('torque_drive', 'motor_torque', 'drive', 'actuator/pulley_M/effort', noise=0.01),
        Sensor(
            'encoder_1', 'angle', '1', 'pulley/pulley_1/position', resolution=math.radians(0.1)
        ),
        Sensor('speed_M', 'velocity', 'M', 'actuator/pulley_M/velocity', resolution=math.pi / 30),
        Sensor('speed_1', 'velocity', '1', 'pulley/pulley_1/velocity', noise=0.1),
        Sensor('shaft_02', 'loop_torque', '02', 'pulley/pulley_02/effort', through='shaft'),
        Sensor('load_cell', 'contact_force', 'tip', 'load_cell/force', noise=0.05),
    )


@pytest.mark.parametrize('name', INSTALLED)
def test_installed_instruments_come_back_as_they_were(name, tmp_path):
    one = load_instrument(name)
    assert one.name == name
    save_instrument(one, tmp_path / 'again.yaml')
    assert load_instrument(tmp_path / 'again.yaml') == one


def test_every_section_comes_back_as_it_was(tmp_path):
    one = load_instrument(write(tmp_path, GOOD))
    save_instrument(one, tmp_path / 'again.yaml')
    assert load_instrument(tmp_path / 'again.yaml') == one


def test_written_file_reads_like_one_by_hand(tmp_path):
    save_instrument(load_instrument('paper_rig'), tmp_path / 'again.yaml')
    text = (tmp_path / 'again.yaml').read_text()
    for part in ('M: 30 mm', 'pretension: 5 N', 'arm: 50 mm', 'rate: 1 kHz', '[-45 deg, 45 deg]'):
        assert part in text


@settings(
    max_examples=30,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(
    values=st.lists(st.floats(1e-9, 1e9), min_size=8, max_size=8),
    continuous=st.booleans(),
    description=st.text(
        st.characters(codec='utf-8', exclude_categories=('Cs', 'Cc')), max_size=40
    ),
)
def test_any_numbers_come_back_exactly(tmp_path, values, continuous, description):
    one = load_instrument('bench_rig')
    a, b, c, d, e, f, g, h = values
    changed = replace(
        one,
        description=description,
        pulleys=(Pulley('M', a, b), *one.pulleys[1:]),
        loops=(replace(one.loops[0], damping=c, route={'M': d, '1': -e}), *one.loops[1:]),
        contacts=(replace(one.contacts[0], position=-f, enabled=False),),
        sensors=(replace(one.sensors[0], resolution=g), *one.sensors[1:]),
        control_period=h,
        continuous_control=continuous,
        effects=(EffectUse('gravity', 'pulley_3', {'torque': min(a, 5.0), 'phase': 0.3}),),
    )
    save_instrument(changed, tmp_path / 'any.yaml')
    assert load_instrument(tmp_path / 'any.yaml') == changed


def test_every_effect_of_the_catalogue_can_be_written(tmp_path):
    bench = load_instrument('davinci_grasper')
    uses = [
        EffectUse(effect.id, place, effect.typical)
        for effect in catalogue().values()
        for place in bench.places()
        if fits(bench, effect, place)
    ]
    assert {use.effect for use in uses} == set(catalogue())
    patched = replace(bench, effects=tuple(uses))
    save_instrument(patched, tmp_path / 'patched.yaml')
    assert load_instrument(tmp_path / 'patched.yaml') == patched


def fits(one, effect, place):
    """Tell whether an effect can act at a place."""
    try:
        checked_use(one, effect.id, place, {})
    except EffectError:
        return False
    return place_index(one, place)[0] in effect.kinds


def test_what_no_file_can_say_is_refused(tmp_path):
    one = load_instrument('bench_rig')
    with pytest.raises(InstrumentError, match='cannot describe'):
        save_instrument(replace(one, sensors=one.sensors[1:]), tmp_path / 'x.yaml')
    with pytest.raises(InstrumentError, match='choose a place'):
        save_instrument(one, tmp_path / 'none' / 'x.yaml')


#: what is wrong, as a text that replaces another in GOOD, and what the message must say
FAULTS = [
    ('inertia: 1 g*cm^2', 'inertia: 1', "pulleys.02.inertia: '1' has no unit; write a quantity"),
    ('inertia: 1 g*cm^2', 'inertia: 1 g', "pulleys.02.inertia: '1 g' is not in kg*m^2"),
    (
        'route: {M: 30 mm',
        'route: {M: 30 mm ± 1 mm',
        "loops.m1.route.M: '30 mm ± 1 mm': no tolerance may stand here; write '30 mm'",
    ),
    ('inertia: 1 g*cm^2', 'inertia: 0 g*cm^2', "pulleys.02.inertia: '0 g*cm^2' must be positive"),
    ('inertia: 1 g*cm^2', 'inertia: .nan', 'pulleys.02.inertia: '),
    ('inertia: 1 g*cm^2', 'inertia: [1]', 'pulleys.02.inertia: list'),
    ('inertia: 1 g*cm^2', 'inertai: 1 g*cm^2', 'pulleys.02.inertai: unknown key, did you mean'),
    ('{inertia: 1 g*cm^2}', '{}', 'pulleys.02.inertia: is missing'),
    ('{inertia: 1 g*cm^2}', 'heavy', 'pulleys.02: is not a section'),
    ('0.9 N*m*s/rad', '-0.9 N*m*s/rad', 'pulleys.M.damping: '),
    ('  02: {inertia', '  M: {inertia', 'line 4: M: is given twice'),
    ('  02: {inertia', '  a b: {inertia', "pulleys.a b: 'a b' is no name"),
    ('route: {M: 30 mm', 'route: {N: 30 mm', "loops.m1.route: no pulley 'N'"),
    ('route: {M: 30 mm', 'route: {M: 0 mm', "loops.m1.route.M: '0 mm' must be not zero"),
    ('route: {1: 1, 02: -1}', 'route: {}', 'couplings.shaft.route: is empty'),
    ('curve: steel', 'curve: stel', "loops.m1.curve: no curve 'stel', did you mean 'steel'?"),
    ('pretension: 5 N', 'pretension: 500 N', 'loops.m1.pretension: 500 N is outside'),
    ('pretension: 5 N', 'pretension: 5 N, torque_sign: {02: -1}', 'loops.m1.torque_sign'),
    ('pretension: 5 N', 'pretension: 5 N, torque_sign: {1: 2}', 'loops.m1.torque_sign.1'),
    ('{mm: [0, 1, 2]}', '{mm: [0, 1]}', 'curves.steel: 2 elongations for 3 tensions'),
    (
        '{mm: [0, 1, 2]}\n    tension: {N: [0, 10, 100]}',
        '{mm: [0]}\n    tension: {N: [5]}',
        'curves.steel: 1 elongations for 1 tensions; give at least two pairs',
    ),
    ('{mm: [0, 1, 2]}', '{mm: [0, 2, 1]}', 'curves.steel.elongation: point 2'),
    ('{mm: [0, 1, 2]}', '[0, 1, 2]', 'curves.steel.elongation: is not one unit with a list'),
    ('{mm: [0, 1, 2]}', '{mm: 3}', 'curves.steel.elongation: mm holds no list'),
    ('{mm: [0, 1, 2]}', '{mm: [0, x, 2]}', 'curves.steel.elongation: '),
    ('{N: [0, 10, 100]}', '{N: [0, 10, 9]}', 'curves.steel.tension: falls'),
    ('{N: [0, 10, 100]}', '{N: [-1, 10, 100]}', 'curves.steel.tension: goes from -1'),
    ('pulley: M', 'pulley: X', "motors.drive.pulley: no pulley 'X'"),
    ('counts: 4096', 'counts: 0', 'motors.drive.encoder.counts: '),
    ('counts: 4096', 'counts: 4096, resolution: 1 deg', 'motors.drive.encoder: has both'),
    ('gear_ratio: 35', 'position_limit: [1 deg]', 'motors.drive.position_limit: '),
    ('gear_ratio: 35', 'gear_ratio: -35', 'motors.drive.gear_ratio: '),
    ('damping: 3 s/m', 'damping: 3 N*s/m', 'contacts.tip.damping: '),
    ('damping: 3 s/m', 'damping: -3 s/m', 'contacts.tip.damping: '),
    ('damping: 3 s/m', 'law: sponge', "contacts.tip.law: 'sponge'"),
    ('damping: 3 s/m', 'enabled: perhaps', "contacts.tip.enabled: 'perhaps'"),
    ('  1: {resolution', '  M: {resolution', 'joint_sensors.M: the pulley has a motor'),
    ('  1: {resolution', '  X: {resolution', "joint_sensors: no pulley 'X'"),
    ('  1: {noise: 0.1 rad/s}', '  X: {}', "speed_sensors: no pulley 'X'"),
    ('noise: 0.1 rad/s', 'noise: 0.1 rad', 'speed_sensors.1.noise: '),
    ('through: shaft', 'through: m1', "shaft_sensors.02.through: no pulley of its route '02'"),
    ('through: shaft', 'through: x', "shaft_sensors.02.through: no loop or coupling 'x'"),
    ('load_cell: {', 'load_cell: {contact: tap, ', "load_cell.contact: no contact 'tap'"),
    ('noise: 0.05 N}', 'noise: 0.05 N*m}', 'load_cell.noise: '),
    ('noise: 0.05 N}', 'noise: 0.05 N guessed}', 'load_cell.noise: '),
    ('effects:', 'control: {rate: 0 Hz}\neffects:', 'control.rate: must be positive'),
    ('effects:', 'control: {rate: often}\neffects:', 'control.rate: '),
    ('effects:', 'control: {rate: 1 kHz, period: 1 ms}\neffects:', 'control: has both'),
    ('effects:', 'colour: red\neffects:', 'colour: unknown key'),
    ('place: pulley_1', 'place: pulley_9', "effects.0: rig: no place 'pulley_9'; it has"),
    ('place: pulley_1', 'place: cable_m1', 'effects.0: tension_friction cannot act at cable_m1'),
    ('tension_friction', 'tension_fiction', "effects.0: no effect 'tension_fiction'; there are"),
    ('coefficient: 0.12', 'coefficent: 0.12', 'effects.0: tension_friction has no parameter'),
    ('coefficient: 0.12', 'coefficient: 99', 'out of bounds; give'),
    ('coefficient: 0.12', 'coefficient: 1 N', 'not a plain number'),
    ('motors:', 'motors: [', 'line '),
    ('motors:', 'engines:', 'engines: unknown key'),
]


@pytest.mark.parametrize(('old', 'new', 'said'), FAULTS)
def test_each_fault_is_one_line_with_file_and_field(tmp_path, old, new, said):
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(InstrumentError) as error:
        load_instrument(path)
    message = str(error.value)
    assert message.startswith(f'{path}: ')
    assert said in message
    assert '\n' not in message


def test_effect_given_twice(tmp_path):
    path = write(tmp_path, GOOD + GOOD.splitlines()[-1] + '\n')
    with pytest.raises(InstrumentError, match='tension_friction at pulley_1 is given twice'):
        load_instrument(path)


def test_two_motors_on_one_pulley(tmp_path):
    second = '  other: {pulley: M, controller: {kp: 1 N*m/rad, limit: 1 N*m}}\ncontacts:'
    with pytest.raises(InstrumentError, match=r'motors.other.pulley: M is driven by motor drive'):
        load_instrument(write(tmp_path, GOOD.replace('contacts:', second, 1)))


@pytest.mark.parametrize('text', ['', '- a\n', '5\n'])
def test_no_sections_at_all(tmp_path, text):
    with pytest.raises(InstrumentError, match='holds no `key: value` pairs'):
        load_instrument(write(tmp_path, text))


def test_file_that_is_not_text(tmp_path):
    path = tmp_path / 'rig.yaml'
    path.write_bytes(b'\xff\xfe\x00')
    with pytest.raises(InstrumentError, match='not UTF-8'):
        load_instrument(path)


def test_names_resolve_to_installed_files():
    assert find_instrument('paper_rig') == find_instrument('paper_rig.yaml')
    with pytest.raises(
        InstrumentError, match=r'one of the instruments belt_by_voltage, bench_rig'
    ):
        find_instrument('paper_rog')
    with pytest.raises(InstrumentError, match='no such file'):
        find_instrument('elsewhere/paper_rig.yaml')


def test_control_rate_forms(tmp_path):
    for text, period, continuous in [
        ('{rate: 500 Hz}', 2e-3, False),
        ('{period: 0.3 ms}', 3e-4, False),
        ('{rate: continuous}', 1e-3, True),
        ('{rate: continuous, period: 0.5 ms}', 5e-4, True),  # of the set-points
    ]:
        one = load_instrument(write(tmp_path, GOOD + f'control: {text}\n'))
        assert (one.control_period, one.continuous_control) == (period, continuous)


def test_base_is_overridden_key_by_key(tmp_path):
    write(tmp_path, GOOD)
    above = 'base: rig.yaml\nloops: {m1: {pretension: 4 N}}\npulleys: {1: {damping: 1 N*m*s}}\n'
    rig = load_instrument(tmp_path / 'rig.yaml')
    variant = load_instrument(write(tmp_path, above, 'variant.yaml'))
    assert variant.name == 'variant'
    assert variant.loops == (replace(rig.loops[0], pretension=4.0),)
    assert variant.pulleys[1] == Pulley('1', 2.25e-4, 1.0)
    assert variant.motors == rig.motors


def test_base_may_be_an_installed_name(tmp_path):
    variant = load_instrument(write(tmp_path, 'base: paper_rig\ncontrol: {rate: 2 kHz}\n'))
    assert variant.control_period == 5e-4
    assert variant.curves == load_instrument('paper_rig').curves


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('base: none_such.yaml\n', 'base: none_such.yaml: no such file'),
        ('base: [paper_rig]\n', 'base: is no file name'),
        ('base: paper_rig_printed\n', 'only one level'),
        ('base: paper_rig\nloops: {12: {radius: 3 mm}}\n', 'loops.12.radius: unknown key'),
    ],
)
def test_base_faults(tmp_path, text, said):
    with pytest.raises(InstrumentError) as error:
        load_instrument(write(tmp_path, text))
    assert said in str(error.value)


def test_curve_files_are_relative_to_the_file_that_names_them(tmp_path):
    (tmp_path / 'cables').mkdir()
    (tmp_path / 'rigs').mkdir()
    points = 'elongation: {mm: [0, 1, 2]}\ntension: {N: [0, 10, 100]}\n'
    write(tmp_path / 'cables', points, 'steel.yaml')
    inline = GOOD[GOOD.index('  steel:') : GOOD.index('loops:')]
    by_file = GOOD.replace(inline, '  steel: {file: ../cables/steel.yaml}\n')
    rig = load_instrument(write(tmp_path / 'rigs', by_file))
    assert rig == load_instrument(write(tmp_path, GOOD))

    write(tmp_path / 'cables', points.replace('mm', 'N'), 'steel.yaml')
    with pytest.raises(InstrumentError, match=r'cables/steel.yaml: elongation: '):
        load_instrument(tmp_path / 'rigs' / 'rig.yaml')
    (tmp_path / 'cables' / 'steel.yaml').unlink()
    with pytest.raises(InstrumentError, match=r'curves.steel.file: .* does not exist'):
        load_instrument(tmp_path / 'rigs' / 'rig.yaml')
    both = by_file.replace('steel.yaml}', 'steel.yaml, tension: {N: [0, 1]}}')
    with pytest.raises(InstrumentError, match=r'curves.steel: give either'):
        load_instrument(write(tmp_path / 'rigs', both))


def test_bench_rig_is_the_bench_of_the_practice_bags(practice):
    import json

    bench = json.loads((practice / 'bench.json').read_text())
    rig = load_instrument('bench_rig')
    assert {p.name: p.inertia for p in rig.pulleys} == bench['inertia']
    assert {p.name: p.damping for p in rig.pulleys} == bench['damping']
    assert {loop.name: loop.pretension for loop in rig.loops} == bench['pretension']
    assert {abs(r) for loop in rig.loops for r in loop.route.values()} == {bench['radius']['M']}
    [curve] = rig.curves
    assert list(curve.elongation) == bench['curve_elongation']
    assert list(curve.tension) == bench['curve_tension']
    [contact] = rig.contacts
    assert (contact.arm, contact.stiffness, contact.damping, contact.law) == (
        bench['arm'],
        bench['contact_stiffness'],
        bench['contact_damping'],
        'spring_damper',
    )
    sensors = {s.name: s for s in rig.sensors}
    for motor in rig.motors:
        assert vars(motor.controller) == {**bench['controller'], 'derivative': 'error'}
        encoder = sensors[f'encoder_{motor.name}']
        assert encoder.resolution == 2 * math.pi / bench['sensors']['motor_counts']
        assert sensors[f'torque_{motor.name}'].noise == bench['sensors']['torque_noise']
    assert sensors['encoder_1'].resolution == 2 * math.pi / bench['sensors']['joint_counts']
    assert sensors['load_cell'].noise == bench['sensors']['force_noise']
