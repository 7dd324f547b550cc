"""Quantities with units are read exactly, written readably and refused with the mend."""

import math
import re

from hypothesis import given
from hypothesis import strategies as st
import pytest

from tendon_ros.base.quantity import EXAMPLES, factor, parsed, readable_unit, written
from tendon_ros.effects import catalogue

finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12)


@pytest.mark.parametrize(
    ('text', 'unit', 'value'),
    [
        ('30 mm', 'm', 0.03),
        ('0.7 mm', 'm', 0.0007),
        ('2.25e-4 kg*m^2', 'kg m^2', 2.25e-4),
        ('12 g*cm^2', 'kg*m^2', 1.2e-6),
        ('0.9 N*m*s/rad', 'N m s/rad', 0.9),
        ('0.9 N*m*s', 'N m s/rad', 0.9),
        ('17 deg', 'rad', math.radians(17)),
        ('1 turn', 'rad', 2 * math.pi),
        ('20 kgf', 'N', 196.133),
        ('60 rpm', 'rad/s', 2 * math.pi),
        ('1 kHz', 'Hz', 1000.0),
        ('10 %', '1', 0.1),
        ('.5', '', 0.5),
    ],
)
def test_reads_units(text, unit, value):
    assert parsed(text, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ('text', 'unit', 'said'),
    [
        ('30', 'm', "'30' has no unit; write a quantity such as '30 mm'"),
        ('30 N', 'm', 'is not in m'),
        ('30 mmm', 'm', "unit that does not exist, 'mmm'"),
        ('nan m', 'm', 'not finite'),
        ('-inf', 'm', 'not finite'),
        ('1e400 m', 'm', 'too large'),
        ('1e9999999 m', 'm', 'too large'),
        ('30 a("b")', 'm', 'unit that does not exist'),
        ('5 %', 'rad', "not in rad (it names no angle); write a quantity such as '17 deg'"),
        ('5 rad/s', 'Hz', 'not in Hz (its angle has no place there)'),
        ('5 N m/deg', 'N m', 'its angle has no place there'),
        ('5 N', 'N m', 'on a straight axis'),
        ('1 s^-1', 'rad/s', 'not in rad/s'),
        ('5 deg', '1', 'not a plain number'),
        ('', 'm', 'not a number with a unit'),
        ('3 )', 'm', 'does not exist'),
        ({'a': 1}, 'm', 'dict'),
    ],
)
def test_refuses_with_the_mend(text, unit, said):
    with pytest.raises(ValueError, match='write a') as error:
        parsed(text, unit)
    assert said in str(error.value)
    assert '\n' not in str(error.value)


@pytest.mark.parametrize(
    ('text', 'unit', 'value'),
    [
        ('turn / (4096 * 35)', 'rad', 2 * math.pi / (4096 * 35)),
        ('3.9811e-5 N m', 'N m', 3.9811e-5),
        ('mA * 0.08 N m/A', 'N m', 8e-5),
        ('percent * 2.5 N m', 'N m', 0.025),
        ('rpm', 'rad/s', 2 * math.pi / 60),
        ('mm * rad/m', 'rad', 1e-3),
        ('turn / (4096 * count)', 'rad', 2 * math.pi / 4096),
        ('-5 Hz', 'Hz', -5.0),
    ],
)
def test_a_unit_may_have_numbers_in_it(text, unit, value):
    assert factor(text, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ('text', 'unit', 'said'),
    [
        ('6000 rpm', 'Hz', 'not in Hz (its angle has no place there)'),
        ('N m/deg', 'N m', 'its angle has no place there'),
        ('count', 'rad', 'names no angle'),
        ('1', 'rad', 'names no angle'),
        ('', 'rad', 'names no angle'),
        ('Hz', 'rad/s', 'names no angle'),
        ('N', 'rad', 'not in rad'),
        ('0 rad', 'rad', 'is 0 rad'),
        ('1e400 rad', 'rad', 'is inf rad'),
        ('turn / 0', 'rad', 'does not exist'),
        ('turn (', 'rad', 'does not exist'),
        ('nonsense', 'rad', 'does not exist'),
    ],
)
def test_a_unit_of_another_kind_is_refused(text, unit, said):
    with pytest.raises(ValueError, match='^' + re.escape(repr(text))) as error:
        factor(text, unit)
    assert said in str(error.value)
    assert '\n' not in str(error.value)


@pytest.mark.parametrize('unit', EXAMPLES)
@given(value=finite)
def test_what_is_written_is_read_back_exactly(unit, value):
    assert parsed(written(value, unit), unit) == value


@pytest.mark.parametrize(
    ('value', 'unit', 'text'),
    [
        (0.03, 'm', '30 mm'),
        (math.radians(5), 'rad', '5 deg'),
        (1000.0, 'Hz', '1 kHz'),
        (2e5, 'N/m', '200 N/mm'),
        (5.0, 'N', '5 N'),
        (1.5, '1', '1.5'),
    ],
)
def test_writes_what_a_person_would(value, unit, text):
    assert written(value, unit) == text


def test_column_falls_back_to_the_unit_that_is_exact():
    assert readable_unit((0.0, 2.5e-5, 1e-3), 'm') == 'mm'
    assert readable_unit((0.0, 0.1 + 1e-16 / 3, math.pi), 'm') == 'm'


def test_every_unit_of_the_catalogue_is_known():
    for effect in catalogue().values():
        for parameter in effect.parameters:
            text = written(parameter.typical, parameter.unit)
            assert parsed(text, parameter.unit) == parameter.typical
