"""Curves are monotone, close to the points, invertible; the identification meets the forces."""

import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from tendon_ros.base.errors import InstrumentError
from tendon_ros.base.resources import config_path
from tendon_ros.model.cable import elongation_at, hardened, tension_at, uniform_cubic
from tendon_ros.model.cable_identification import (
    BlockedTip,
    curve_from_table,
    identified,
    PowerLaw,
    tabulated,
)
from tendon_ros.model.instrument import Curve

PAPER = BlockedTip(
    forces=tuple((math.radians(a), f) for a, f in ((1, 1.83), (5, 18.0), (7, 50.0))),
    radius=0.03,
    arm=0.05,
    loops=3,
)
UNEVEN = Curve(
    'uneven',
    (0.0, 1e-4, 1.5e-4, 6e-4, 7e-4, 1.4e-3, 2e-3),
    (0.0, 1.0, 1.2, 9.0, 14.0, 80.0, 190.0),
)


@pytest.fixture(scope='module')
def sava(curve_of):
    return curve_of(config_path('cables/sava_1027.yaml'))


@pytest.fixture(scope='module', params=['sava_1027', 'bench', 'uneven'])
def curve(request, curve_of):
    if request.param == 'uneven':
        return UNEVEN
    return curve_of(config_path(f'cables/{request.param}.yaml'))


def test_close_to_the_cubic_through_the_points(curve):
    x = np.linspace(curve.elongation[0], curve.elongation[-1], 5001)
    exact = PchipInterpolator(curve.elongation, curve.tension)(x)
    error = np.abs(tension_at(curve, x) - exact)
    assert np.all(error <= 1e-3 * np.maximum(exact, 1e-3 * exact[-1]))


def test_equally_spaced_points_are_met_exactly(sava):
    _, _, cubic = uniform_cubic(sava)
    assert len(cubic) == len(sava.elongation) - 1
    np.testing.assert_allclose(tension_at(sava, np.array(sava.elongation)), sava.tension)


@settings(max_examples=50)
@given(
    steps=st.lists(
        st.tuples(st.floats(1e-6, 1e-3), st.sampled_from([0.0]) | st.floats(1e-6, 50.0)),
        min_size=1,
        max_size=12,
    ),
    cells=st.integers(1, 60),
)
def test_monotone_and_smooth_whatever_the_points(steps, cells):
    x, t = np.cumsum([(0.0, 0.0), *steps], axis=0).T
    start, rate, cubic = uniform_cubic(Curve('any', tuple(x), tuple(t)), cells)
    u = np.linspace(0.0, 1.0, 21)[:, None]
    slope = cubic[:, 1] + u * (2 * cubic[:, 2] + 3 * u * cubic[:, 3])
    assert slope.min() >= -1e-9 * max(1.0, t[-1])
    ends = cubic.sum(axis=1)
    np.testing.assert_allclose(ends[:-1], cubic[1:, 0], atol=1e-9)
    np.testing.assert_allclose(slope[-1, :-1], slope[0, 1:], atol=1e-6 * (1 + t[-1]))
    assert start + len(cubic) / rate == pytest.approx(x[-1])


def test_slack_below_and_straight_beyond(curve):
    first, last = curve.elongation[0], curve.elongation[-1]
    assert tension_at(curve, first - 1e-3) == curve.tension[0]
    beyond = tension_at(curve, last + np.array([0.0, 1e-4, 2e-4]))
    assert beyond[0] == pytest.approx(curve.tension[-1])
    assert beyond[2] - beyond[1] == pytest.approx(beyond[1] - beyond[0])
    assert beyond[1] > beyond[0]


def test_elongation_is_the_inverse(curve):
    for x in np.linspace(curve.elongation[0], 1.2 * curve.elongation[-1], 101):
        back = elongation_at(curve, float(tension_at(curve, x)))
        assert back == pytest.approx(x, abs=1e-12 + 1e-9 * x)
    assert elongation_at(curve, -1.0) == curve.elongation[0]


def test_elongation_where_the_curve_is_flat():
    flat = Curve('flat', (0.0, 1e-3, 2e-3, 3e-3), (0.0, 10.0, 10.0, 20.0))
    assert elongation_at(flat, 10.0) == pytest.approx(1e-3, abs=2e-6)
    assert elongation_at(Curve('end', (0.0, 1e-3, 2e-3), (0.0, 10.0, 10.0)), 11.0) == math.inf


@pytest.mark.parametrize('pretension', [2.0, 3.0, 5.0, 8.0, 12.0, 20.0])
def test_identified_law_gives_the_papers_forces(pretension):
    law = identified(PAPER, pretension)
    tip = law.net_force(PAPER.elongations) * PAPER.radius / PAPER.arm
    np.testing.assert_allclose(tip, [1.83, 18.0, 50.0], rtol=1e-8)
    assert law.tension(np.array([law.preload]))[0] == pytest.approx(pretension, rel=1e-8)


def test_identified_law_is_the_one_that_made_the_forces():
    made = PowerLaw(9.0, 3.0, 5.0, 0.632834520242148e-3, 6.0)
    angles = np.radians([2.0, 4.0, 6.0])
    forces = made.net_force(0.02 * angles / 2) * 0.02 / 0.04
    test = BlockedTip(tuple(zip(angles, forces, strict=True)), 0.02, 0.04, 2)
    law = identified(test, 6.0)
    assert (law.linear, law.factor, law.exponent) == pytest.approx((9.0, 3.0, 5.0), rel=1e-6)


def test_exponent_grows_with_pretension():
    exponents = [identified(PAPER, p).exponent for p in (2.0, 5.0, 10.0, 20.0)]
    assert exponents == pytest.approx([4.51, 6.37, 9.12, 15.04], abs=0.01)


def test_law_at_5_newton():
    law = identified(PAPER, 5.0)
    assert law.linear == pytest.approx(7.77, abs=0.005)
    assert law.factor == pytest.approx(1.35, abs=0.005)
    assert law.tension(np.array([2.157e-3]))[0] == pytest.approx(20 * 9.80665, rel=1e-3)


def test_table_keeps_the_forces(sava):
    preload = elongation_at(sava, 5.0)
    net = tension_at(sava, preload + PAPER.elongations)
    net -= tension_at(sava, preload - PAPER.elongations)
    np.testing.assert_allclose(net * 0.03 / 0.05, [1.83, 18.0, 50.0], rtol=2e-5)
    assert sava.tension[-1] >= 20 * 9.80665


def test_table_of_a_law_reaches_the_tension_asked_for():
    curve = tabulated(identified(PAPER, 5.0), 'c', 50.0)
    assert curve.tension[-1] >= 50.0 > curve.tension[-2]


@pytest.mark.parametrize(
    ('forces', 'pretension', 'said'),
    [
        (((0.1, 1.0), (0.2, 2.0)), 5.0, 'takes 3'),
        (((0.1, 30.0), (0.2, 35.0), (0.3, 36.0)), 5.0, 'grow faster'),
        (PAPER.forces, 0.0, 'must be positive'),
    ],
)
def test_forces_that_no_law_meets(forces, pretension, said):
    with pytest.raises(InstrumentError, match=said):
        identified(BlockedTip(forces, 0.03, 0.05, 3), pretension)


def test_tension_test_from_a_table(tmp_path):
    file = tmp_path / 'test.csv'
    file.write_text('elongation_mm, force_kgf\n0,0\n\n1,2\n2,20\n')
    curve = curve_from_table(file)
    assert curve == Curve('test', (0.0, 1e-3, 2e-3), (0.0, 19.6133, 196.133))


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('', 'line 1: 0 columns for elongation'),
        ('elongation_mm,elongation_m,force_N\n0,0,0\n', 'line 1: 2 columns for elongation'),
        ('elongation_mm,weight\n0,0\n', '0 columns for tension or force'),
        ('elongation_mm,force_N\n0,0\n1,x\n', 'line 3'),
        ('elongation_mm,force_N\n0,0\n1\n', 'line 3'),
        ('elongation,force_N\n0,0\n1,1\n', 'line 2'),
        ('elongation_mm,force_N\n0,0\n1,5\n2,4\n', 'falls to 4 N at point 2'),
        ('elongation_mm,force_N\n0,0\n2,5\n1,6\n', 'does not come after'),
        ('elongation_mm,force_N\n0,0\n', 'at least two pairs'),
    ],
)
def test_bad_tables_are_named(tmp_path, text, said):
    file = tmp_path / 'test.csv'
    file.write_text(text)
    with pytest.raises(InstrumentError) as error:
        curve_from_table(file)
    assert said in str(error.value)
    assert str(error.value).startswith(f'{file}: ')


@pytest.mark.parametrize('exponent', [0.8, 2.0, 4.0])
def test_a_hardened_curve_is_a_power_of_the_elongation(exponent):
    straight = Curve('straight', (0.0, 5e-3), (0.0, 200.0))
    x = np.linspace(1e-3, 5e-3, 41)
    wanted = 200.0 * (x / 5e-3) ** exponent
    np.testing.assert_allclose(tension_at(hardened(straight, exponent), x), wanted, rtol=5e-3)


def test_hardening_of_one_is_the_curve_itself(curve):
    assert hardened(curve, 1.0) == curve
    bent = hardened(curve, 1.7)
    assert bent.elongation[-1] == pytest.approx(curve.elongation[-1])
    assert bent.tension[-1] == pytest.approx(curve.tension[-1])
