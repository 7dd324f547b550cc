"""The parameters of effects follow from the catalogue."""

from dataclasses import replace
import math

import pytest

from tendon_ros.effects import catalogue
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.nodes.effect_settings import effect_settings, effects_from
from tendon_ros.nodes.settings import checked


@pytest.fixture(scope='module')
def rig():
    return load_instrument('paper_rig')


def values_of(instrument):
    return {one.name: one.default for one in effect_settings(instrument)}


def test_every_effect_has_its_parameters_with_the_bounds_of_the_catalogue(rig):
    found = {tuple(one.name.split('.')): one for one in effect_settings(rig)}
    for effect in catalogue().values():
        wanted = {p.name for p in effect.parameters}
        places = {place for _, place, name, _ in found if name == effect.id}
        assert places or 'coupling' in effect.kinds, effect.id
        for place in places:
            mine = {k[3]: s for k, s in found.items() if k[1:3] == (place, effect.id)}
            assert mine.keys() == wanted
            for parameter in effect.parameters:
                one = mine[parameter.name]
                bounds = (parameter.low, parameter.high, parameter.unit)
                assert (one.low, one.high, one.unit) == bounds
                assert one.live
                assert parameter.meaning in one.description


def test_defaults_are_allowed_and_put_nothing_in_force(rig):
    for one in effect_settings(rig):
        assert checked(one, one.default) == one.default
        assert math.isfinite(one.default)
    assert effects_from(rig, values_of(rig)) == ()


def test_a_changed_parameter_puts_its_effect_in_force(rig):
    values = values_of(rig) | {'effects.cable_L3.pretension.scale': 0.9}
    assert effects_from(rig, values) == (EffectUse('pretension', 'cable_L3', {'scale': 0.9}),)


def test_a_parameter_that_only_shapes_puts_nothing_in_force(rig):
    values = values_of(rig) | {'effects.pulley_3.disturbance.start': 7.0}
    assert effects_from(rig, values) == ()


def test_effects_of_the_file_start_as_they_are_there(rig):
    uses = (
        EffectUse('tension_friction', 'pulley_3', {'coefficient': 0.2}),
        EffectUse('pretension', 'cable_m1', {'scale': 0.8}),
    )
    worn = replace(rig, effects=uses)
    values = values_of(worn)
    assert effects_from(worn, values) == uses
    assert arrays_of(worn).m.tolist() == arrays_of(worn, effects_from(worn, values)).m.tolist()
    values['effects.pulley_3.tension_friction.coefficient'] = 0.0
    assert effects_from(worn, values) == uses[1:]
