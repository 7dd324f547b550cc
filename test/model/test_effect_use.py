"""Effects in force: beside those of an instrument, or instead of one of them."""

from tendon_ros.model.effect_use import in_force
from tendon_ros.model.instrument import EffectUse

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
