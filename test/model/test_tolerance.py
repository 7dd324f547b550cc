"""An instrument file says how well its numbers are known, and is written back with it."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import pytest

from tendon_ros.base.errors import InstrumentError
from tendon_ros.model.instrument_file import load_instrument, save_instrument
from tendon_ros.model.tolerance import (
    read_stated,
    read_tolerance,
    Stated,
    written_stated,
    written_tolerance,
)

RIG = """\
pulleys:
  M: {inertia: 0.04 kg*m^2 +- 3 %, damping: 0.9 N*m*s/rad guessed}
  1: {inertia: 0.04 kg*m^2 ± 0.01 kg*m^2}
  2: {inertia: 0.04 kg*m^2, damping: 0 N*m*s/rad guessed}
curves:
  steel: {elongation: {mm: [0, 1, 2]}, tension: {N: [0, 10, 100]}}
loops:
  m1: {route: {M: 30 mm, 1: -30 mm}, curve: steel, pretension: 5 N +/- 0.5 N, stiffness: ± 2.5 %}
couplings:
  shaft: {route: {1: 1, 2: -1}, stiffness: 15 N*m/rad guessed}
motors:
  drive: {pulley: M, controller: {kp: 20 N*m/rad, limit: 5 N*m}, torque_gain: guessed}
contacts:
  tip: {route: {2: 1}, arm: 50 mm, stiffness: 200 N/mm ± 10 %, position: 17 deg ± 2 deg}
effects:
  - effect: gravity
    place: pulley_2
    parameters: {torque: 0.4 N*m guessed, phase: 10 deg ± 2 deg}
  - {effect: tension_friction, place: pulley_1, parameters: {coefficient: 0.1 ± 20 %}}
"""

SAID = {
    'pulley_M.inertia': 0.03,
    'pulley_M.damping': math.inf,
    'pulley_1.inertia': 0.25,
    'pulley_2.damping': math.inf,
    'cable_m1.pretension': 0.1,
    'cable_m1.stiffness': 0.025,
    'coupling_shaft.stiffness': math.inf,
    'motor_drive.torque_gain': math.inf,
    'contact.stiffness': 0.1,
    'contact.position': math.radians(2.0),
    'pulley_2.gravity.torque': math.inf,
    'pulley_2.gravity.phase': math.radians(2.0),
    'pulley_1.tension_friction.coefficient': 0.2,
}


@pytest.fixture
def file(tmp_path):
    path = tmp_path / 'rig.yaml'
    path.write_text(RIG)
    return path


def test_only_what_the_file_says_is_listed(file):
    rig = load_instrument(file)
    assert rig.tolerances == pytest.approx(SAID)
    assert rig.pulleys[0].inertia == 0.04
    assert rig.loops[0].pretension == 5.0
    assert load_instrument('paper_rig').tolerances == {}


def test_tolerances_come_back_as_they_were(file, tmp_path):
    rig = load_instrument(file)
    save_instrument(rig, tmp_path / 'again.yaml')
    assert load_instrument(tmp_path / 'again.yaml') == rig
    text = (tmp_path / 'again.yaml').read_text()
    for part in ('inertia: 0.04 kg*m^2 ± 3 %', 'damping: 0.9 N*m*s/rad guessed', '17 deg ± 2 deg'):
        assert part in text


def test_tolerance_of_what_is_not_there_is_refused(file, tmp_path):
    rig = replace(load_instrument(file), tolerances={'pulley_9.inertia': 0.1})
    with pytest.raises(InstrumentError, match='tolerances only for numbers'):
        save_instrument(rig, tmp_path / 'again.yaml')


def test_several_contacts_are_told_apart(file):
    second = '  stop: {route: {2: -1}, arm: 50 mm, stiffness: 1 N/mm guessed}\n'
    file.write_text(RIG.replace('effects:', second + 'effects:'))
    said = load_instrument(file).tolerances
    assert said['contact_stop.stiffness'] == math.inf
    assert said['contact_tip.stiffness'] == 0.1


def test_a_variant_says_anew_how_well_its_numbers_are_known(file, tmp_path):
    variant = tmp_path / 'variant.yaml'
    variant.write_text(
        'base: rig.yaml\npulleys: {M: {inertia: 0.05 kg*m^2}, 1: {inertia: 0.05 kg*m^2 guessed}}\n'
    )
    said = load_instrument(variant).tolerances
    expected = {**SAID, 'pulley_1.inertia': math.inf}
    del expected['pulley_M.inertia']
    assert said == pytest.approx(expected)


@pytest.mark.parametrize(
    ('old', 'new', 'said'),
    [
        ('+- 3 %', '+- 3', "pulleys.M.inertia: '3' has no unit; write a quantity such as '2.25e"),
        ('+- 3 %', '+- 3', "or a share such as '3 %'"),
        ('+- 3 %', '+- 3 N', "pulleys.M.inertia: '3 N' is not in kg*m^2"),
        ('+- 3 %', '+- 0 %', 'pulleys.M.inertia: '),
        ('+- 3 %', '+- -3 %', 'a tolerance must be positive'),
        ('+- 3 %', '+-', 'pulleys.M.inertia: '),
        ('+- 3 %', 'guesed', "pulleys.M.inertia: '0.04 kg*m^2 guesed': did you mean 'guessed'?"),
        ('+- 3 %', 'guessed ± 3 %', 'what is guessed has no tolerance; write one or the other'),
        ('0.04 kg*m^2 +- 3 %', '0 kg*m^2 guessed', 'pulleys.M.inertia: '),
        ('0 N*m*s/rad guessed', '0 N*m*s/rad ± 3 %', '0 has no relative tolerance'),
        ('stiffness: ± 2.5 %', 'stiffness: 3 N/mm', "loops.m1.stiffness: '3 N/mm' is no toleranc"),
        (
            'stiffness: ± 2.5 %',
            'stiffness: 3 N/mm',
            "a loop's stiffness is the scale of its curve",
        ),
        ('0.04 kg*m^2 +- 3 %', 'guessed', 'write the number that is guessed before it, in kg*m^2'),
        ('stiffness: ± 2.5 %', 'stiffness: ± 3', "write '+- 3 %' or 'guessed'"),
        ('torque_gain: guessed', 'torque_gain: 0.9', "motors.drive.torque_gain: '0.9' is no tol"),
        ('17 deg ± 2 deg', '17 deg ± 2 %', 'contacts.tip.position: '),
        ('0.4 N*m guessed', '0.4 N*m ± 3', "effects.0: '3' has no unit"),
        ('0.4 N*m guessed', '0.4 N guessed', 'effects.0: gravity at pulley_2: torque: '),
        ('17 deg ± 2 deg', '17 deg ± 2 mm', "contacts.tip.position: '2 mm' is not in rad"),
    ],
)
def test_each_fault_is_one_line_with_file_and_field(file, old, new, said):
    assert old in RIG
    file.write_text(RIG.replace(old, new, 1))
    with pytest.raises(InstrumentError) as error:
        load_instrument(file)
    assert str(error.value).startswith(f'{file}: ')
    assert said in str(error.value)
    assert '\n' not in str(error.value)


def test_where_no_tolerance_is_read_none_is_taken(file):
    file.write_text(RIG.replace('arm: 50 mm', 'arm: 50 mm guessed'))
    with pytest.raises(InstrumentError, match=r'contacts.tip.arm: '):
        load_instrument(file)


@given(
    value=st.floats(1e-9, 1e9),
    tolerance=st.one_of(st.none(), st.just(math.inf), st.floats(1e-9, 1e9)),
    unit=st.sampled_from(['kg*m^2', 'N', 'N/m', 'rad', 'N*m*s/rad']),
)
def test_any_statement_is_read_back_exactly(value, tolerance, unit):
    assert read_stated(written_stated(value, unit, tolerance), unit) == Stated(value, tolerance)
    if tolerance is not None:
        assert read_tolerance(written_tolerance(tolerance)) == tolerance
