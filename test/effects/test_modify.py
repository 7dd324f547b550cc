"""Modifiers change what they say, at their place, and nothing else."""

import copy

import numpy as np
import pytest

from tendon_ros.effects import catalogue, find

MODIFIERS = [e for e in catalogue().values() if e.modify]
PLACES = [(e, kind) for e in MODIFIERS for kind in e.kinds]

#: arrays that belong to each kind of place
OWN = {
    'pulley': {'inertia', 'damping', 'breakaway', 'dither'},
    'cable': {'pretension', 'scale', 'hardening', 'loop_damping', 'play'},
    'coupling': {'scale', 'hardening', 'loop_damping', 'play'},
    'motor': {'motor_gain', 'motor_bias', 'motor_limit', 'motor_knee', 'play'},
    'sensor': {'sensor_gain', 'sensor_offset', 'sensor_delay', 'sensor_lag', 'sensor_rectified'},
    'contact': {'contact_stiffness', 'contact_damping', 'contact_position'},
}


class Numbers:
    """Three pulleys, two loops and a coupling, two motors, three sensors, two contacts."""

    def __init__(self, kind=''):
        self.kind = kind
        self.values = {
            'inertia': np.array([1e-3, 2e-3, 4e-2]),
            'damping': np.array([0.05, 0.02, 0.9]),
            'breakaway': np.array([0.0, 0.0, 0.0]),
            'dither': np.array([0.0, 0.0, 0.0]),
            'lash': np.array([0.0, 0.0, 0.0]),
            'radius': np.array([[0.03, -0.02, 0.0], [0.0, 0.03, -0.03], [-35.0, 0.0, 1.0]]),
            'pretension': np.array([5.0, 6.0, 0.0]),
            'scale': np.array([1.0, 1.0, 1.0]),
            'hardening': np.array([1.0, 1.0, 1.0]),
            'loop_damping': np.array([0.0, 1.0, 2.0]),
            'play': np.array([0.0, 1e-5, 2e-5]),
            'motor_gain': np.array([1.0, 1.1]),
            'motor_bias': np.array([0.0, 0.01]),
            'motor_limit': np.array([5.0, 6.0]),
            'motor_knee': np.zeros(2),
            'motor_pulley': np.array([2, 0]),
            'sensor_gain': np.array([1.0, 1.0, 2.0]),
            'sensor_offset': np.array([0.0, 0.1, 0.0]),
            'sensor_delay': np.array([0.0, 0.0, 1e-3]),
            'sensor_lag': np.array([0.0, 0.0, 2e-3]),
            'sensor_rectified': np.array([0.0, 0.0, 0.0]),
            'contact_stiffness': np.array([2e5, 1e5]),
            'contact_damping': np.array([50.0, 10.0]),
            'contact_position': np.array([0.0, 0.1]),
        }

    def __getitem__(self, name):
        return self.values[name]

    def loops_on(self, pulley):
        return np.flatnonzero(self.values['radius'][:, pulley]).tolist()


def changed(effect, kind, index, values):
    """Return the entries that a modifier has changed: {(array, place): value}."""
    before = Numbers(kind)
    after = copy.deepcopy(before)
    effect.modify(after, index, **values)
    assert set(after.values) == set(before.values)
    return {
        (name, *(int(n) for n in place)): float(after[name][tuple(place)])
        for name, array in before.values.items()
        for place in np.argwhere(after[name] != array)
    }


@pytest.mark.parametrize(('effect', 'kind'), PLACES, ids=lambda x: getattr(x, 'id', x))
def test_neutral_changes_nothing(effect, kind):
    for index in (0, 1):
        assert changed(effect, kind, index, effect.neutral) == {}


@pytest.mark.parametrize(('effect', 'kind'), PLACES, ids=lambda x: getattr(x, 'id', x))
def test_only_the_place_is_changed(effect, kind):
    index = 2 if kind == 'coupling' else 1
    entries = changed(effect, kind, index, effect.typical)
    assert entries
    assert {name for name, *_ in entries} <= OWN[kind]
    loops = Numbers().loops_on(Numbers()['motor_pulley'][index]) if kind == 'motor' else []
    for name, place in entries:
        assert place in (loops if name == 'play' and kind == 'motor' else [index])


@pytest.mark.parametrize(
    ('name', 'kind', 'index', 'values', 'expected'),
    [
        ('inertia', 'pulley', 2, {'scale': 1.5}, {('inertia', 2): 0.06}),
        ('viscous_friction', 'pulley', 0, {'damping': 0.1}, {('damping', 0): 0.15}),
        ('viscous_friction', 'pulley', 0, {'damping': -0.03}, {('damping', 0): 0.02}),
        ('viscous_friction', 'pulley', 0, {'damping': -9.0}, {('damping', 0): 0.0}),
        (
            'presliding_friction',
            'pulley',
            1,
            {'torque': 0.1, 'angle': 0.004, 'dither': 1e-3},
            {('breakaway', 1): 0.004, ('dither', 1): 1e-3},
        ),
        ('pretension', 'cable', 1, {'scale': 0.5}, {('pretension', 1): 3.0}),
        (
            'cable_stiffness',
            'cable',
            0,
            {'scale': 0.8, 'hardening': 2.0, 'damping': 3.0},
            {('scale', 0): 0.8, ('hardening', 0): 2.0, ('loop_damping', 0): 3.0},
        ),
        ('backlash', 'coupling', 2, {'angle': 0.01, 'held': 0.0}, {('play', 2): 0.01002}),
        # motor 1 turns pulley 0, on which loop 0 (radius 0.03) and coupling 2 (ratio -35) act
        (
            'backlash',
            'motor',
            1,
            {'angle': 0.01, 'held': 0.0},
            {('play', 0): 3e-4, ('play', 2): 0.35002},
        ),
        ('backlash', 'motor', 1, {'angle': 0.01, 'held': 1.0}, {('lash', 0): 0.01}),
        ('torque_gain', 'motor', 1, {'gain': 0.9}, {('motor_gain', 1): 0.99}),
        ('torque_bias', 'motor', 1, {'torque': 0.05}, {('motor_bias', 1): 0.06}),
        (
            'torque_saturation',
            'motor',
            0,
            {'limit': 1.5, 'knee': 0.1},
            {('motor_limit', 0): 1.5, ('motor_knee', 0): 0.1},
        ),
        ('torque_saturation', 'motor', 0, {'limit': 5.5, 'knee': 0.1}, {}),
        ('encoder_offset', 'sensor', 1, {'angle': -0.3}, {('sensor_offset', 1): -0.2}),
        ('encoder_gain', 'sensor', 2, {'gain': 1.1}, {('sensor_gain', 2): 2.2}),
        ('load_cell_bias', 'sensor', 1, {'force': 0.3}, {('sensor_offset', 1): 0.4}),
        ('load_cell_gain', 'sensor', 2, {'gain': 0.5}, {('sensor_gain', 2): 1.0}),
        (
            'sensor_delay',
            'sensor',
            2,
            {'time': 0.01, 'filtered': 0.0},
            {('sensor_delay', 2): 0.011},
        ),
        (
            'sensor_delay',
            'sensor',
            2,
            {'time': 0.01, 'filtered': 0.25},
            {('sensor_delay', 2): 0.0085, ('sensor_lag', 2): 0.0045},
        ),
        ('sensor_rectified', 'sensor', 0, {'rectified': 1.0}, {('sensor_rectified', 0): 1.0}),
        ('sensor_rectified', 'sensor', 0, {'rectified': 0.4}, {}),
        (
            'contact_stiffness',
            'contact',
            1,
            {'scale': 0.5, 'damping': 3.0},
            {('contact_stiffness', 1): 5e4, ('contact_damping', 1): 13.0},
        ),
        ('contact_position', 'contact', 1, {'angle': 0.02}, {('contact_position', 1): 0.12}),
    ],
)
def test_what_is_changed(name, kind, index, values, expected):
    assert changed(find(name), kind, index, values) == pytest.approx(expected)


@pytest.mark.parametrize(
    'effect',
    [e for e in MODIFIERS if e.dissipative and not e.law],
    ids=lambda e: e.id,
)
def test_no_modifier_that_dissipates_makes_damping_negative(effect):
    for part in np.linspace(0.0, 1.0, 11):
        numbers = Numbers('pulley')
        values = {p.name: p.low + part * (p.high - p.low) for p in effect.parameters}
        effect.modify(numbers, 1, **values)
        assert np.all(numbers['damping'] >= 0.0)
