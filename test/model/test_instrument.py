"""The paper's equations (1)-(6) fall out of the network that its file describes."""

import numpy as np
import pytest

from tendon_ros.base.errors import InstrumentError
from tendon_ros.model.cable import elongation_at, tension_at
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.modes import modes
from tendon_ros.model.statics import Statics

R, J, J3, B, ARM = 0.03, 2.25e-4, 4e-2, 0.9, 0.05


@pytest.fixture(scope='module')
def rig():
    return load_instrument('paper_rig')


@pytest.fixture(scope='module')
def printed():
    return load_instrument('paper_rig_printed')


def net_force(rig, delta):
    """Return the paper's T(delta): the difference of two preloaded cables."""
    [curve] = rig.curves
    preload = elongation_at(curve, 5.0)
    return tension_at(curve, preload + delta) - tension_at(curve, preload - delta)


def paper_torques(rig, angle, speed, sign):
    """Return J times acceleration of eqs. (1)-(6), motors and tip free, written out by hand."""
    M, L, one, two, three = angle
    T_m1 = net_force(rig, R * M - R * one)
    T_12 = net_force(rig, R * one - R * three - R * two)
    T_L3 = net_force(rig, R * L - R * three)
    return np.array(
        [
            -B * speed[0] - R * T_m1,  # (1)
            -B * speed[1] - R * T_L3,  # (2)
            -B * speed[2] - R * T_12 + R * T_m1,  # (4)
            -B * speed[3] + R * T_12,  # (5)
            -B * speed[4] + sign * R * T_12 + R * T_L3,  # (6)
        ]
    )


def test_table_1(rig):
    assert rig.pulley_names == ('M', 'L', '1', '2', '3')
    assert [p.inertia for p in rig.pulleys] == [J, J, J, J, J3]
    assert [p.damping for p in rig.pulleys] == [B] * 5
    assert rig.contacts[0].arm == ARM
    assert rig.driven == ('M', 'L')
    assert rig.inner == ('1', '2', '3')


def test_routing_is_the_papers(rig):
    expected = R * np.array([[1, 0, -1, 0, 0], [0, 0, 1, -1, -1], [0, 1, 0, 0, -1]])
    np.testing.assert_array_equal(rig.routing(), expected)


@pytest.mark.parametrize(('name', 'sign'), [('paper_rig', 1.0), ('paper_rig_printed', -1.0)])
def test_equations_1_to_6(name, sign):
    rig = load_instrument(name)
    statics = Statics(rig, engine='plain')
    rng = np.random.default_rng(1)
    for _ in range(20):
        angle, speed = rng.normal(0.0, 0.05, 5), rng.normal(0.0, 0.5, 5)
        torque = statics.at(angle, speed).torque
        np.testing.assert_allclose(torque, paper_torques(rig, angle, speed, sign), atol=1e-9)


def test_only_the_consistent_form_is_a_conservative_spring(rig, printed):
    angle = np.array([0.05, -0.02, 0.03, 0.01, -0.01])
    consistent = Statics(rig, engine='plain').at(angle, np.zeros(5)).stiffness
    as_printed = Statics(printed, engine='plain').at(angle, np.zeros(5)).stiffness
    np.testing.assert_allclose(consistent, consistent.T, atol=1e-9)
    np.testing.assert_allclose(as_printed[:4], consistent[:4])
    assert np.abs(as_printed - as_printed.T).max() > 1.0
    assert np.linalg.eigvalsh(consistent).min() > -1e-9


def test_modes_of_a_spring_between_held_motors(rig):
    found = modes(rig, rig.driven)
    assert all(mode.damping > 0.0 for mode in found)
    [swing] = [mode for mode in found if mode.damping < 1.0 - 1e-9]
    assert swing.pulley == '3'
    assert 4.0 < swing.frequency < 4.5


def test_printed_form_feeds_on_itself_at_low_damping(rig, printed):
    from dataclasses import replace

    def least(one):
        soft = replace(one, pulleys=tuple(replace(p, damping=0.02) for p in one.pulleys))
        return min(mode.damping for mode in modes(soft, soft.driven))

    assert least(rig) > 0.0
    assert least(printed) < 0.0


def test_single_body_has_its_closed_form():
    body = load_instrument('single_body')
    [mode] = modes(body)
    assert mode.rate == pytest.approx(body.pulleys[0].damping / body.pulleys[0].inertia)
    assert modes(body, body.driven) == ()


def test_unknown_pulley_is_named_with_those_that_exist(rig):
    with pytest.raises(InstrumentError, match=r"no pulley '4'; it has 1, 2, 3, L, M"):
        rig.index('4')


def test_wrist_couples_pitch_into_the_jaws():
    """The null space of the routing is the dVRK's coupling matrix, roll, pitch, yaw, grip."""
    wrist = load_instrument('wrist_two_jaws')
    C = wrist.routing()
    discs, joints = C[:, :4], C[:, 4:]
    roll, pitch, jaw_a, jaw_b = -np.linalg.solve(joints, discs)
    np.testing.assert_allclose(roll, [-1.5632, 0, 0, 0], atol=1e-3)
    np.testing.assert_allclose(pitch, [0, 1.0186, 0, 0], atol=1e-3)
    np.testing.assert_allclose((jaw_a + jaw_b) / 2, [0, -0.8306, 0.6089, 0.6089], atol=1e-3)
    np.testing.assert_allclose(jaw_b - jaw_a, [0, 0, -1.2177, 1.2177], atol=1e-3)


def test_grasper_has_the_recorded_ratio(davinci_npz):
    grasper = load_instrument('davinci_grasper')
    [loop] = grasper.loops
    ratio = -loop.route['spindle'] / loop.route['drum']
    with np.load(davinci_npz) as runs:
        table = np.concatenate([runs[f'0{level}'][::10] for level in range(10)])
    spindle, jaw = -table[:, 1] * 2 * np.pi / 8192, table[:, 4] * 2 * np.pi / 4000
    torque, load = table[:, 2] * 3.9811e-5, -table[:, 5] * 3.9811e-5
    columns = np.column_stack([np.ones_like(spindle), spindle, load, torque])
    fit = np.linalg.lstsq(columns, jaw, rcond=None)[0]
    assert fit[1] == pytest.approx(ratio, abs=0.02)
    assert load.min() > 0.0  # the jaw pushes its load along its angle
