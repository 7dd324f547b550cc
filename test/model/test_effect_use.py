"""Effects in force: beside those of an instrument, or instead of one of them; and their units."""

import pytest

from tendon_ros.base.errors import InstrumentError
from tendon_ros.model.effect_use import checked_use, in_force, units_at
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument, save_instrument

OWN = (
    EffectUse('stribeck_friction', 'pulley_1', {'static': 0.1, 'sliding': 0.05, 'speed': 0.2}),
    EffectUse('gravity', 'pulley_1', {'torque': 0.3, 'phase': 0.0}),
)


def test_what_stands_beside_is_added():
    more = EffectUse('gravity', 'pulley_1', {'torque': 0.1, 'phase': 0.0})
    assert in_force(OWN, [more]) == (*OWN, more)


def test_what_stands_instead_changes_what_it_names_and_nothing_else():
    faster = EffectUse('stribeck_friction', 'pulley_1', {'speed': 0.4}, instead=True)
    found = in_force(OWN, [faster])
    assert found[0].parameters == {'static': 0.1, 'sliding': 0.05, 'speed': 0.4}
    assert found[1:] == OWN[1:]
    assert OWN[0].parameters['speed'] == 0.2


def test_what_stands_instead_of_nothing_is_simply_there():
    other = EffectUse('gravity', 'pulley_2', {'torque': 0.1, 'phase': 0.0}, instead=True)
    [*_, last] = in_force(OWN, [other])
    assert (last.effect, last.place, last.instead) == ('gravity', 'pulley_2', False)


def test_two_changes_of_one_effect_both_hold():
    uses = [
        EffectUse('gravity', 'pulley_1', {'torque': 0.4}, instead=True),
        EffectUse('gravity', 'pulley_1', {'phase': 0.1}, instead=True),
    ]
    assert in_force(OWN, uses)[1].parameters == {'torque': 0.4, 'phase': 0.1}


def test_a_zero_is_in_the_unit_in_which_its_sensor_reads(tmp_path):
    text = """
name: two_readings
pulleys: {drive: {inertia: 1 g*cm^2}, jaw: {inertia: 1 g*cm^2}}
couplings: {shaft: {route: {drive: 1, jaw: -1}, stiffness: 15 N*m/rad}}
motors: {drive: {pulley: drive, controller: {kp: 20 N*m/rad, limit: 5 N*m}}}
contacts: {tip: {route: {jaw: 1}, arm: 50 mm, stiffness: 200 N/mm, position: 17 deg}}
shaft_sensors: {jaw: {through: shaft}}
load_cell: {noise: 0.05 N}
effects:
  - {effect: load_cell_bias, place: shaft_jaw, parameters: {force: 5 mN*m +- 1 mN*m}}
  - {effect: load_cell_bias, place: load_cell, parameters: {force: 0.3 N}}
"""
    path = tmp_path / 'rig.yaml'
    path.write_text(text)
    rig = load_instrument(path)

    assert units_at(rig, 'load_cell_bias', 'shaft_jaw') == {'force': 'N m'}
    assert units_at(rig, 'load_cell_bias', 'load_cell') == {'force': 'N'}
    assert [use.parameters['force'] for use in rig.effects] == [0.005, 0.3]
    save_instrument(rig, tmp_path / 'again.yaml')
    assert load_instrument(tmp_path / 'again.yaml') == rig

    path.write_text(text.replace('5 mN*m +- 1 mN*m', '5 N'))
    with pytest.raises(InstrumentError, match=r'load_cell_bias at shaft_jaw: force: .*N\*m'):
        load_instrument(path)


def test_a_weight_hangs_straight_down_at_zero_where_nothing_is_said():
    body = load_instrument('single_body')
    use = checked_use(body, 'gravity', 'pulley_body', {'torque': '1 N*m'})
    assert use.parameters == {'torque': 1.0, 'phase': 0.0}
