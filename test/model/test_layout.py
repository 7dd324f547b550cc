"""The layout: pulleys in a banded order, places that do not overlap, effects that are refused."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import EffectError
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.layout import arrays_of, structure_of


def test_pulleys_are_put_in_a_banded_order(bench_rig):
    chain = bench_rig.chain(30)
    shuffled = np.random.default_rng(0).permutation(len(chain.pulleys))
    mixed = replace(chain, pulleys=tuple(chain.pulleys[i] for i in shuffled))
    structure = structure_of(mixed)
    assert sorted(structure.order) == list(range(31))
    assert structure['BAND'] == 1
    assert structure_of(bench_rig.five_pulleys())['BAND'] == 2


def test_numbers_do_not_make_another_kernel(bench_rig):
    rig = bench_rig.five_pulleys()
    heavy = replace(rig, pulleys=tuple(replace(p, inertia=1.0) for p in rig.pulleys))
    assert structure_of(heavy) == structure_of(rig)
    assert structure_of(bench_rig.five_pulleys(wall='', friction=0.0)) == structure_of(rig)
    assert structure_of(replace(rig, sensors=rig.sensors[:1])) == structure_of(rig)
    assert structure_of(replace(rig, loops=rig.loops[:2])) != structure_of(rig)


@pytest.mark.parametrize('array', ['m', 'd', 'w', 'c', 'g'])
def test_places_do_not_overlap(bench_rig, array):
    # the layout's own table of places lives with Structure; only its results are looked at
    from tendon_ros.model.structure import PLACES

    structure = structure_of(bench_rig.five_pulleys())
    starts = [structure[name] for name in PLACES[array]]
    assert starts == sorted(starts)
    assert starts[0] == 0
    assert structure.length(array) >= starts[-1]


def test_numbers_follow_their_pulleys(bench_rig):
    rig = bench_rig.five_pulleys()
    arrays = arrays_of(rig)
    at = arrays.structure
    inertia = arrays.m[at['INERTIA'] : at['INERTIA'] + 5]
    assert list(inertia) == [rig.pulleys[i].inertia for i in at.order]
    # every loop's row, entry by entry, is the routing matrix
    routing = np.zeros((3, 5))
    for k, row in enumerate(at.loop_pulley):
        for e, i in enumerate(row):
            routing[k, at.order[i]] = arrays.m[at['RADIUS'] + at['WIDTH'] * k + e]
    assert np.array_equal(routing, rig.routing())


@pytest.mark.parametrize(
    ('use', 'said'),
    [
        (EffectUse('coulomb_friction', 'pulley_9', {}), "no place 'pulley_9'; it has .*pulley_3"),
        (EffectUse('coulomb_friction', 'cable_m1', {}), 'cannot act at cable_m1'),
        (
            EffectUse('coulomb_friction', 'pulley_3', {'torque': -1.0}),
            'torque = -1 N m is outside',
        ),
        (EffectUse('coulomb_friction', 'pulley_3', {'torqe': 0.1}), "no parameter 'torqe'"),
    ],
)
def test_effects_that_cannot_act_are_refused(bench_rig, use, said):
    with pytest.raises(EffectError, match=said):
        arrays_of(bench_rig.five_pulleys(effects=(use,)))


def test_an_effect_that_is_off_has_no_law(bench_rig):
    bare = arrays_of(bench_rig.five_pulleys(friction=0.0))
    rubbed = arrays_of(bench_rig.five_pulleys(friction=0.1))
    at = bare.structure
    assert bare.d[at['BUDGETS'] + 1] == 0
    assert rubbed.d[at['BUDGETS'] + 1] == 3
    assert bare.d[at['ACTIVE']] == 0
