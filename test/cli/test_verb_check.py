"""``tendon check`` says what an instrument file describes, or what is wrong with it."""

import pytest

from tendon_ros.base.resources import config_path
from tendon_ros.cli.main import main


@pytest.mark.parametrize(
    'name', sorted(path.stem for path in config_path('instruments').glob('*.yaml'))
)
def test_every_installed_instrument_is_sound(name, capsys):
    assert main(['check', name]) == 0
    assert f'{name} is valid' in capsys.readouterr().out


def test_summary_of_the_papers_rig(capsys):
    assert main(['check', 'paper_rig']) == 0
    lines = capsys.readouterr().out.splitlines()
    assert '  12   .   .   30  -30  -30' in lines
    assert '  cable_L3' in lines
    assert '  encoder_M  actuator/pulley_M/position' in lines
    assert any('4.196 Hz' in line and 'pulley 3' in line for line in lines)


def test_effects_in_force_are_listed(tmp_path, capsys):
    file = tmp_path / 'patched.yaml'
    use = '{effect: pretension, place: cable_L3, parameters: {scale: 0.9}}'
    file.write_text(f'base: paper_rig\neffects: [{use}]\n')
    assert main(['check', str(file)]) == 0
    assert 'pretension at cable_L3: scale=0.9' in capsys.readouterr().out


def test_fault_is_one_line_and_status_2(tmp_path, capsys):
    file = tmp_path / 'bad.yaml'
    file.write_text('base: paper_rig\npulleys: {M: {inertia: 3 kg}}\n')
    assert main(['check', str(file)]) == 2
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert f"{file}: pulleys.M.inertia: '3 kg' is not in kg*m^2 (on a straight axis" in error
