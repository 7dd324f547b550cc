"""Coordinates: parameters survive the way to their axes and back, and valleys become straight."""

import math

import numpy as np
import pytest

from tendon_ros.effects import catalogue, find
from tendon_ros.effects.gravity import gravity_law
from tendon_ros.effects.joint_spring import joint_spring_law
from tendon_ros.identify.coordinates import Coordinates


@pytest.mark.parametrize('effect', catalogue().values(), ids=lambda e: e.id)
def test_there_and_back(effect):
    coordinates = Coordinates(effect.parameters)
    values = {
        p.name: min(max(0.7 * p.typical, p.low), p.high) if p.search != 'switch' else p.typical
        for p in effect.parameters
    }
    back = coordinates.values(coordinates.place(values))
    assert back == pytest.approx(values, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize('effect', catalogue().values(), ids=lambda e: e.id)
def test_no_size_is_no_effect(effect):
    coordinates = Coordinates(effect.parameters)
    z = [0.0 if n in coordinates.sizes else 0.3 for n in range(len(effect.parameters))]
    values = coordinates.values(z)
    for p in effect.parameters:
        if not p.is_shape and p.search not in ('share', 'switch'):
            assert values[p.name] == pytest.approx(p.neutral, abs=1e-12)


@pytest.mark.parametrize('phase', [-2.5, -0.3, 1.4, 3.0])
def test_a_weight_may_hang_anywhere(phase):
    coordinates = Coordinates(find('gravity').parameters)
    z = coordinates.place({'torque': 0.4, 'phase': phase})
    values = coordinates.values(z)
    assert abs(values['phase']) <= math.pi / 2
    for theta in (-1.0, 0.2, 2.0):
        wanted = gravity_law(theta, 0.0, 0.0, 0.4, phase)[0]
        assert gravity_law(theta, 0.0, 0.0, **values)[0] == pytest.approx(wanted)


@pytest.mark.parametrize(('effect', 'law'), [('gravity', gravity_law),
                                             ('joint_spring', joint_spring_law)])  # fmt: skip
def test_torque_is_linear_in_the_coordinates(effect, law):
    coordinates = Coordinates(find(effect).parameters)
    theta = np.linspace(-0.3, 0.3, 7)

    def torque(*z):
        return np.array([law(t, 0.0, 0.0, **coordinates.values(z))[0] for t in theta])

    one, both = torque(1.0, 0.0), torque(1.0, 0.5)
    assert torque(2.0, 1.0) == pytest.approx(2.0 * both)
    assert torque(1.0, 1.0) - both == pytest.approx(both - one)


def test_a_spring_is_never_negative():
    coordinates = Coordinates(find('joint_spring').parameters)
    assert coordinates.values((-1.0, 0.0))['stiffness'] == 0.0
    assert coordinates.values((-1.0, 0.3))['stiffness'] > 0.0


def test_a_spring_that_rests_too_far_keeps_its_torque_and_a_descent_sees_it():
    coordinates = Coordinates(find('joint_spring').parameters)
    size = find('joint_spring').typical['stiffness']
    for across in (3.0, 6.0, -6.0):
        values = coordinates.values((0.01, across))
        assert abs(values['rest']) == pytest.approx(30.0 * math.pi)
        assert values['stiffness'] * values['rest'] == pytest.approx(size * across)
        # from where it then is, a stiffer spring is another one
        along, moved = coordinates.within((0.01, across))
        assert moved == pytest.approx(across)
        stiffer = coordinates.values((along + 0.02, across))
        assert stiffer['stiffness'] == pytest.approx(values['stiffness'] + 0.02 * size)
        assert abs(stiffer['rest']) < abs(values['rest'])


@pytest.mark.parametrize(('along', 'across'), [(-5.0, 9.1), (3.0, -20.0), (30.0, 2.0)])
def test_an_amplitude_ends_in_whatever_phase_and_keeps_what_small_angles_tell(along, across):
    effect = find('eccentricity')
    coordinates = Coordinates(effect.parameters)
    [amplitude] = [p for p in effect.parameters if p.name == 'amplitude']
    end = amplitude.high / amplitude.typical
    z = coordinates.within((along, across))
    assert math.hypot(*z) == pytest.approx(end)
    assert z[0] == pytest.approx(min(along, end))
    assert z[1] == pytest.approx(0.0, abs=1e-6) or z[1] * across > 0.0
    assert coordinates.place(coordinates.values(z)) == pytest.approx(z, abs=1e-6)
    inside = tuple(0.5 * place for place in z)
    assert coordinates.within(inside) == inside
