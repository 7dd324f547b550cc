"""The generator's rig: the same physics as the model where nothing is wrong, from other code."""

import numpy as np
import pytest

from tendon_ros.blind import columns as k
from tendon_ros.blind.bench import nominal, nominal_rig, PULLEYS
from tendon_ros.blind.case import PLAIN, ran_all
from tendon_ros.blind.faults import Fault, rig_with
from tendon_ros.blind.gap import drive_of, gap_of
from tendon_ros.blind.law import Law
from tendon_ros.blind.laws import ARM_LAWS, AXIS_LAWS, KIN, LAWS
from tendon_ros.blind.motion import AXIS_KINDS, KINDS, LENGTHS, setpoints
from tendon_ros.blind.rig import BEFORE, run
from tendon_ros.blind.sensing import clean, floors
from tendon_ros.blind.setup import Setup
from tendon_ros.blind.unknowns import AXIS_UNKNOWNS, UNKNOWNS
from tendon_ros.effects import catalogue
from tendon_ros.model import engine
from tendon_ros.model.simulation import Simulation

BENCHES = ('bench', 'other')


def command(kind, seed=1, bench='bench'):
    reach = 0.03 / np.abs(nominal_rig(bench).routes).max(axis=0)[:2]
    return setpoints(kind, reach, np.random.default_rng(seed))


def law_of(effect):
    return next(law for law in LAWS if law.effect == effect)


@pytest.fixture(scope='module')
def ran():
    return {
        kind: run(nominal_rig('bench'), command(kind), closed=kind != 'free') for kind in KINDS
    }


@pytest.mark.parametrize('bench', BENCHES)
def test_a_rig_without_faults_is_the_model(bench):
    setpoint = command('mixed', bench=bench)[:6000]
    out = run(nominal_rig(bench), setpoint, closed=True)
    instrument = nominal(bench)
    rows = Simulation(instrument, pose={'M': 0.0, 'L': 0.0}).run(setpoint, 1)
    late = slice(1000, None)
    order = [[p.name for p in instrument.pulleys].index(name) for name in PULLEYS]
    difference = rows.angle[late][:, order] - out[late, :5]
    assert np.abs(difference).max() < 3e-4


@pytest.mark.parametrize('rig', ['axis', 'arm'])
def test_one_body_without_faults_is_the_model(rig):
    setpoint = setpoints('fast', np.ones(2), np.random.default_rng(1))[:6000]
    out = run(nominal_rig(rig), setpoint, closed=False)
    rows = Simulation(nominal(rig), pose={'M': 0.0}).run(setpoint[:, :1], 1)
    assert np.ptp(out[:, k.ANGLE]) > 0.5
    assert np.abs(rows.angle[1000:, 0] - out[1000:, k.ANGLE]).max() < 3e-3


@pytest.mark.parametrize(
    ('law', 'place'),
    [(law, place) for law in (*AXIS_LAWS, *AXIS_UNKNOWNS) for place in law.places],
    ids=lambda value: value.effect if isinstance(value, Law) else value,
)
def test_every_fault_of_an_axis_makes_a_gap(law, place):
    faults = (Fault(law, place, law.high, 5, AXIS_KINDS),)
    assert body_gap('axis', faults) > PLAIN[0]


@pytest.mark.parametrize('law', ARM_LAWS, ids=lambda law: law.effect)
def test_every_fault_of_an_arm_makes_a_gap(law):
    [place] = law.places
    faults = (Fault(law, place, law.high, 5, AXIS_KINDS),)
    assert body_gap('arm', faults) > PLAIN[0]


@pytest.mark.parametrize('rig', ['axis', 'arm'])
def test_one_body_without_faults_has_no_gap(rig):
    assert body_gap(rig, ()) < 0.8


def body_gap(rig, faults):
    """Return what the first fault, or nothing, explains of three recordings of one body."""
    setup, base, rng = Setup(rig, 'motor'), nominal_rig(rig), np.random.default_rng(1)
    commands = {kind: setpoints(kind, np.ones(2), rng) for kind in AXIS_KINDS}
    return gap_of(base, faults, 0, ran_all(base, faults, setup, commands), commands, setup)


def test_compiled_and_plain_are_the_same(monkeypatch):
    rig = nominal_rig('bench')
    fault = Fault(
        next(law for law in LAWS if law.effect == 'stribeck_friction'), 'pulley_1', 0.1, 1, KINDS
    )
    rig = rig_with(rig, [fault], 'contact')
    setpoint = command('mixed')[1000:1040]
    fast = run(rig, setpoint, closed=True)
    real = engine.engine_of
    monkeypatch.setattr('tendon_ros.blind.rig.engine_of', lambda files: real(files, 'plain'))
    np.testing.assert_allclose(run(rig, setpoint, closed=True), fast, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize('kind', KINDS)
def test_moving_the_motors_gives_the_torques_that_moved_them(kind, ran):
    rig, closed = nominal_rig('bench'), kind != 'free'
    moved = run(rig, command(kind), closed=closed, drive=drive_of(rig, ran[kind]))
    floor = floors(nominal('bench'), 'joint')
    truth = clean(rig, ran[kind], 'joint', closed=closed)
    for name, value in clean(rig, moved, 'joint', closed=closed).items():
        assert np.std(value - truth[name]) < 0.5 * floor[name], name


def test_recordings_are_as_long_as_they_say(ran):
    for kind, out in ran.items():
        assert len(out) == round(1000 * (LENGTHS[kind] + BEFORE))


def test_every_effect_of_the_catalogue_is_drawn_in_its_words():
    assert {law.effect for law in LAWS} == set(catalogue())
    for law in LAWS:
        for place in law.places:
            values = Fault(law, place, law.low, 3, KINDS).values(nominal_rig('bench'))
            known = {p.name: p for p in catalogue()[law.effect].parameters}
            for key, value in values.items():
                assert known[key].low <= value <= known[key].high, (law.effect, key)


def test_unknown_effects_are_in_no_catalogue():
    assert not {law.effect for law in UNKNOWNS} & set(catalogue())
    assert all(law.effect.startswith('unknown_') for law in UNKNOWNS)


def test_kin_contain_themselves():
    assert all(effect in kin for effect, kin in KIN.items())
    assert set(KIN) <= set(catalogue())


@pytest.mark.parametrize(
    ('law', 'place'),
    [(law, place) for law in (*LAWS, *UNKNOWNS) for place in law.places],
    ids=lambda value: value.effect if isinstance(value, Law) else value,
)
def test_every_fault_is_felt_at_its_place(law, place, ran):
    kind = 'mixed' if law.event else 'contact'
    base = nominal_rig('bench')
    rig = rig_with(base, [Fault(law, place, law.high, 5, KINDS)], kind)
    before = clean(base, ran[kind], 'joint', closed=True)
    setpoint = command(kind)
    out = run(rig, setpoint, closed=True)
    after = clean(rig, out, 'joint', closed=True)
    changed = max(np.abs(after[name] - before[name]).max() for name in after)
    readings = np.abs(out[:, k.READING :] - ran[kind][:, k.READING :]).max()
    assert max(changed, readings) > 2e-5


def test_dry_friction_is_as_large_as_it_says():
    law = law_of('coulomb_friction')
    rig = rig_with(nominal_rig('bench'), [Fault(law, 'pulley_M', 0.2, 1, KINDS)], 'free')
    ticks = np.arange(2001) * 1e-3
    angle = 0.05 * ticks  # the motor turns evenly, the tip is free
    drive = np.zeros((2001, 4))
    drive[:, 0], drive[:, 2] = angle, 0.05
    setpoint = np.zeros((2000, 2))
    rubbed = run(rig, setpoint, closed=False, drive=drive)
    smooth = run(nominal_rig('bench'), setpoint, closed=False, drive=drive)
    extra = rubbed[1500:, k.EFFORT] - smooth[1500:, k.EFFORT]
    np.testing.assert_allclose(extra, 0.2, atol=1e-3)


def test_a_cable_relaxes_by_its_fraction():
    law = law_of('cable_creep')
    rig = rig_with(nominal_rig('bench'), [Fault(law, 'cable_L3', 0.3, 1, KINDS)], 'free')
    rig.loops[2, [k.FAST_TIME, k.SLOW_TIME]] = 0.05, 0.1
    rig.pulleys[4, k.INERTIA] = 1e6  # as good as held
    drive = np.zeros((2001, 4))
    drive[:, 1] = 0.01
    held = run(rig, np.zeros((2000, 2)), closed=False, drive=drive)[:, k.EFFORT + 1]
    assert held[-1] == pytest.approx(0.7 * held[2], rel=0.02)
