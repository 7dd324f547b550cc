"""Axes: every parameter of the catalogue survives the way to its axis and back."""

import math

import pytest

from tendon_ros.base.parameter import Parameter
from tendon_ros.effects import catalogue, find
from tendon_ros.identify.axis import Axis, axis_of

PARAMETERS = [
    pytest.param(p, id=f'{effect.id}.{p.name}')
    for effect in catalogue().values()
    for p in effect.parameters
    if p.search != 'switch'
]


@pytest.mark.parametrize('parameter', PARAMETERS)
def test_there_and_back(parameter):
    axis = axis_of(parameter)
    low, high = axis.low, axis.high
    for part in (0.001, 0.2, 0.5, 0.9, 1.0):
        value = low + part * (high - low)
        assert axis.value(axis.place(value)) == pytest.approx(value, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize('parameter', PARAMETERS)
def test_ends_are_the_bounds_and_nothing_lies_beyond(parameter):
    axis = axis_of(parameter)
    low, high = axis.ends
    assert low < high
    assert axis.value(low - 5.0) == pytest.approx(axis.low, abs=1e-9)
    assert axis.value(high + 5.0) == pytest.approx(axis.high)
    assert axis.low >= parameter.low
    assert axis.high == parameter.high


@pytest.mark.parametrize('parameter', PARAMETERS)
def test_sizes_begin_at_neutral_and_one_is_typical(parameter):
    if parameter.is_shape or parameter.search == 'instant':
        return
    axis = axis_of(parameter)
    assert axis.value(0.0) == pytest.approx(parameter.neutral)
    assert abs(axis.place(parameter.typical)) == pytest.approx(1.0)


def test_positive_shapes_are_seen_in_decades():
    axis = axis_of(Parameter('speed', 'rad/s', 'of Stribeck', math.nan, 1e-3, 10.0, 0.1))
    assert axis.value(0.0) == pytest.approx(0.1)
    assert axis.value(2.0) / axis.value(1.0) == pytest.approx(axis.value(1.0) / axis.value(0.0))


def test_a_place_far_out_does_not_overflow():
    axis = Axis('x', '1', 1e-6, 1e6, 1.0, 0.5, log=True)
    assert axis.value(1e9) == 1e6
    assert axis.value(-1e9) == 1e-6


def test_a_yes_or_no_does_not_move():
    [rectified] = find('sensor_rectified').parameters
    axis = axis_of(rectified)
    assert axis.ends == (1.0, 1.0)
    assert [axis.value(z) for z in (-3.0, 0.4, 1.0, 2.0)] == [1.0] * 4
