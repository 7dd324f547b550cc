"""The page of the nodes names every parameter, and the parameter file only what exists."""

from pathlib import Path

import pytest
import yaml

from tendon_ros.base.resources import config_path
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.nodes import estimator, monitor, recorder, simulator, trajectory
from tendon_ros.nodes.effect_settings import effect_settings
from tendon_ros.nodes.settings import checked

NODES = (simulator, estimator, trajectory, recorder, monitor)
PROGRAMS = {module.PROGRAM.name: module.PROGRAM for module in NODES}
PAGE = Path(__file__).parents[2] / 'docs' / 'nodes.md'


@pytest.mark.parametrize('name', PROGRAMS)
def test_every_parameter_is_on_the_page(name):
    section = PAGE.read_text().split(f'### {name}\n')[1].split('\n#')[0]
    plain = {one.name for one in PROGRAMS[name].settings if '.' not in one.name}
    assert {setting for setting in plain if f'`{setting}`' not in section} == set()


def test_the_parameter_file_gives_what_the_nodes_take():
    document = yaml.safe_load(config_path('nodes/rig.yaml').read_text())
    effects = effect_settings(load_instrument('paper_rig'))
    assert {key.removeprefix('/**/') for key in document} == set(PROGRAMS) - {'recorder'}
    for key, section in document.items():
        program = PROGRAMS[key.removeprefix('/**/')]
        known = {one.name: one for one in (*program.settings, *effects)}
        for name, value in section['ros__parameters'].items():
            assert checked(known[name], value) == value


@pytest.mark.parametrize('program', PROGRAMS.values(), ids=PROGRAMS)
def test_defaults_are_allowed(program):
    for one in program.settings:
        assert checked(one, one.default) == one.default
