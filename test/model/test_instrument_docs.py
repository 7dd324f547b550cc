"""The page on instrument files names every key, and its example can be used."""

import math
from pathlib import Path
import re

import pytest

from tendon_ros.base.resources import config_path
from tendon_ros.model import instrument_schema
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.instrument_schema import Section

PAGE = (Path(__file__).parents[2] / 'docs' / 'instrument_file.md').read_text()


@pytest.mark.parametrize(
    'section',
    [
        s
        for s in vars(instrument_schema).values()
        if isinstance(s, type) and s is not Section and issubclass(s, Section)
    ],
)
def test_every_key_is_on_the_page(section):
    for key in section.model_fields:
        assert re.search(rf'`{key}|\b{key}:|### {key}', PAGE), key


def test_every_installed_instrument_is_on_the_page():
    for path in config_path('instruments').glob('*.yaml'):
        assert f'`{path.stem}`' in PAGE


def test_example_is_sound(tmp_path):
    example, tolerances = re.findall(r'```yaml\n(.*?)```', PAGE, re.DOTALL)
    (tmp_path / 'rigs').mkdir()
    (tmp_path / 'cables').symlink_to(config_path('cables'))
    (tmp_path / 'rigs' / 'small.yaml').write_text(example)
    small = load_instrument(tmp_path / 'rigs' / 'small.yaml')
    places = {'pulley_finger', 'cable_pull', 'motor_drive', 'encoder_drive', 'torque_drive'}
    assert places | {'load_cell', 'contact'} < {*small.places()}
    (tmp_path / 'rigs' / 'variant.yaml').write_text('base: small.yaml\n' + tolerances)
    said = load_instrument(tmp_path / 'rigs' / 'variant.yaml').tolerances
    assert said['pulley_finger.inertia'] == 0.03
    assert said['cable_pull.stiffness'] == math.inf
    assert said['pulley_finger.gravity.phase'] == math.radians(2.0)
