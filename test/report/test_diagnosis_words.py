"""Names and numbers read as an engineer would write them."""

import numpy as np
import pytest

from tendon_ros.effects import catalogue
from tendon_ros.report.diagnosis_words import (
    channel_words,
    count,
    effect_words,
    inside,
    joined,
    number,
    percent,
    place_words,
    with_interval,
    with_unit,
)

BLANK = '\u00a0'


@pytest.mark.parametrize(
    ('place', 'words'),
    [
        ('pulley_3', 'pulley 3'),
        ('cable_left_upper', 'cable left_upper'),
        ('load_cell', 'load cell'),
        ('contact', 'contact'),
        ('torque_M', 'torque sensor M'),
    ],
)
def test_places(place, words):
    assert place_words(place) == words


@pytest.mark.parametrize(
    ('effect', 'place', 'words'),
    [
        ('tension_friction', 'pulley_3', 'Tension-proportional friction on pulley 3'),
        ('inertia', 'pulley_M', 'Inertia of pulley M'),
        ('pretension', 'cable_L3', 'Pretension of cable L3'),
        ('cable_creep', 'cable_L3', 'Cable L3 creep'),
        ('encoder_offset', 'encoder_M', 'Encoder M offset'),
        ('load_cell_gain', 'load_cell', 'Load cell gain'),
        ('contact_stiffness', 'contact', 'Contact stiffness'),
        ('sensor_delay', 'torque_M', 'Sensor delay of torque sensor M'),
    ],
)
def test_effects(effect, place, words):
    assert effect_words(effect, place) == words


def test_every_effect_can_be_named():
    places = {'pulley': 'pulley_1', 'cable': 'cable_x', 'coupling': 'coupling_x'}
    for effect in catalogue().values():
        for kind in effect.kinds:
            assert '_' not in effect_words(effect.id, places.get(kind, 'motor_M'))


def test_proper_names_keep_their_capital():
    assert inside('Coulomb friction on pulley 1') == 'Coulomb friction on pulley 1'
    assert inside('Pretension of cable L3') == 'pretension of cable L3'


@pytest.mark.parametrize(
    ('channel', 'words'),
    [
        ('actuator/pulley_M/effort', 'motor M torque'),
        ('pulley/pulley_1/position', 'pulley 1 angle'),
        ('load_cell/force', 'load cell force'),
        ('setpoint/pulley_L/position', 'motor L set-point angle'),
    ],
)
def test_channels(channel, words):
    assert channel_words(channel) == words


def test_numbers_have_the_digits_that_count():
    assert [number(x) for x in (6.31, 0.0456, 127.3, 0.0)] == ['6.3', '0.046', '127', '0']
    assert number(-0.0456) == '−0.046'
    assert [number(x) for x in (9.94, 9.96, 0.0996, -99.6)] == ['9.9', '10', '0.10', '−100']
    assert [number(x) for x in (np.inf, -np.inf, np.nan)] == ['∞', '−∞', '–']


def test_probabilities_never_claim_certainty():
    texts = [percent(x).replace(BLANK, ' ') for x in (0.0, 0.004, 0.5, 0.97, 0.9996, 1.0)]
    assert texts == ['0 %', '< 1 %', '50 %', '97 %', '> 99 %', '100 %']


def test_units_get_a_prefix_and_intervals_set_the_digits():
    assert with_unit(0.0083, 'N m') == f'8.3{BLANK}mN·m'
    assert with_unit(1.7, 'N m s/rad') == f'1.7{BLANK}N·m·s/rad'
    assert with_interval(0.05234, (0.0498, 0.0551), '1') == ('0.0523', '0.0498 … 0.0551')
    assert with_interval(-0.00231, (-0.0029, -0.0017), 'N m') == (
        f'−2.31{BLANK}mN·m',
        '−2.90 … −1.70',
    )
    assert with_interval(0.08, (0.02, np.inf), 'rad/s')[1] == '20.0 … ∞'
    assert with_interval(1234.5, (1100.0, 1400.0), 'N m')[0] == f'1234{BLANK}N·m'


def test_lists_and_counts_are_sentences():
    assert joined(['a']) == 'a'
    assert joined(['a', 'b', 'c']) == 'a, b and c'
    assert (count(1, 'channel'), count(2, 'channel')) == ('1 channel', '2 channels')
