"""Parameters as data: what is refused, in which words, and what options make of them."""

import argparse

import pytest

from tendon_ros.nodes.settings import (
    add_options,
    checked,
    given_options,
    refuse_unknown,
    Setting,
    SettingError,
)

RATE = Setting('rate', 500.0, 'how often', 'Hz', 1.0, 1000.0)
ENGINE = Setting('engine', 'auto', 'how', choices=('auto', 'plain'))
SEED = Setting('seed', -1, 'of noise', '', -1, 10)
CONTACT = Setting('contact', True, 'whether')
AMPLITUDE = Setting('amplitude', 1.0, 'how far', 'rad', low=0.0)
SHIFT = Setting('shift', 0.0, 'where', 'rad', high=2.0)


@pytest.mark.parametrize(
    ('setting', 'value', 'said'),
    [
        (RATE, 500, 'write 500.0'),
        (RATE, 0.5, r'0\.5 Hz is out of bounds; give 1 to 1000'),
        (AMPLITUDE, -1.0, r'-1 rad is out of bounds; give at least 0$'),
        (SHIFT, 3.0, r'3 rad is out of bounds; give at most 2$'),
        (RATE, float('nan'), 'not a finite number'),
        (RATE, '500', 'is not a number'),
        (SEED, 1.0, 'whole number'),
        (SEED, True, 'whole number'),
        (CONTACT, 1, 'true or false'),
        (ENGINE, 'fast', 'there are auto, plain'),
    ],
)
def test_unfit_values_are_refused_with_the_mend(setting, value, said):
    with pytest.raises(SettingError, match=f'parameter {setting.name}.*{said}'):
        checked(setting, value)


@pytest.mark.parametrize(('setting', 'value'), [(RATE, 1.0), (SEED, 10), (ENGINE, 'plain')])
def test_fit_values_pass_unchanged(setting, value):
    assert checked(setting, value) == value


def test_an_unknown_name_is_refused_with_the_closest():
    refuse_unknown('simulator', ['rate'], ['rate', 'seed'])
    with pytest.raises(SettingError, match=r"no parameter 'rte'; did you mean rate\?"):
        refuse_unknown('simulator', ['rte'], ['rate', 'seed'])
    with pytest.raises(SettingError, match=r"'xyz'; it has rate, seed and effects\.PLACE"):
        refuse_unknown('simulator', ['xyz'], ['rate', 'seed', 'effects.a.b.c'])


def test_options_set_only_what_is_given():
    settings = (RATE, ENGINE, SEED, CONTACT, Setting('exit_when_done', True, 'leave'))
    parser = argparse.ArgumentParser()
    add_options(parser, settings)
    args = parser.parse_args(['--rate', '250', '--no-contact', '--no-exit-when-done'])
    assert given_options(args, settings) == {
        'rate': 250.0,
        'contact': False,
        'exit_when_done': False,
    }
    with pytest.raises(SettingError, match='out of bounds'):
        given_options(parser.parse_args(['--rate', '1e9']), settings)
