"""The rig that is diagnosed as the paper's authors did by hand tells nothing of what it is."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.paper.withheld_rig import PLANS, recorded, STAND, WITHHELD, withheld_rig


@pytest.fixture(scope='module')
def stand():
    return load_instrument(STAND)


@pytest.fixture(scope='module')
def short(stand):
    plan = replace(PLANS[1], settings={'duration': 1.0, 'amplitude': '6 deg'})
    return recorded(withheld_rig(stand), plan, seed=1)


def test_file_of_the_stand_knows_nothing(stand):
    assert stand.effects == ()
    assert {loop.pretension for loop in stand.loops} == {5.0}
    assert stand.tolerances['cable_L3.pretension'] == 0.01


def test_rig_has_what_is_withheld_and_numbers_a_percent_off(stand):
    rig = withheld_rig(stand)
    assert {(use.effect, use.place) for use in rig.effects} >= {use[:2] for use in WITHHELD}
    off = [a.inertia / b.inertia - 1.0 for a, b in zip(rig.pulleys, stand.pulleys, strict=True)]
    assert 0.0 < np.max(np.abs(off)) < 0.04
    assert withheld_rig(stand) == rig
    assert withheld_rig(stand, seed=2) != rig


def test_recording_holds_only_what_the_stand_measures(stand, short):
    expected = {s.channel for s in stand.sensors}
    expected |= {f'setpoint/pulley_{name}/position' for name in stand.driven}
    assert set(short.channels) == expected
    assert 'pretension' not in str(short.metadata)


def test_sensors_count_and_are_noisy(short):
    angle = short['pulley/pulley_3/position'].value
    counts = angle / (2.0 * np.pi / 16384)
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)
    torque = short['actuator/pulley_M/effort'].value
    assert 0.003 < np.std(np.diff(torque, 3)) / np.sqrt(20.0) < 0.05
