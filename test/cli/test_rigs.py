"""The tutorials of docs/rigs: their files are those installed, their commands run."""

from pathlib import Path
import re
import shlex

import numpy as np
import pytest
import yaml

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.resources import config_path
from tendon_ros.cli.main import main
from tendon_ros.diagnose.session import diagnose
from tendon_ros.model.instrument_file import load_instrument

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / 'docs' / 'rigs').glob('*.md'))
#: takes long, and has tests of its own
NOT_RUN = {'diagnose'}
#: rigs without a motor encoder
BY_TORQUE = {'belt_by_voltage'}


def blocks(page):
    return [yaml.safe_load(text) for text in re.findall(r'```yaml\n(.*?)```', page, re.DOTALL)]


def contained(part, whole):
    """Tell whether a mapping says nothing that another one does not say."""
    if isinstance(part, dict):
        return all(key in whole and contained(value, whole[key]) for key, value in part.items())
    return part == whole


@pytest.mark.parametrize('page', PAGES, ids=lambda p: p.stem)
def test_what_a_page_shows_stands_in_the_files(page):
    instrument, mapping = blocks(page.read_text())
    for shown, file in (
        (instrument, config_path(f'instruments/{page.stem}.yaml')),
        (mapping, config_path(f'imports/{page.stem}.yaml')),
    ):
        assert contained(shown, yaml.safe_load(file.read_text()))


@pytest.mark.parametrize('page', PAGES, ids=lambda p: p.stem)
def test_every_command_runs(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for folder in ('docs', 'config'):
        (tmp_path / folder).symlink_to(ROOT / folder)
    verbs = []
    for line in re.findall(r'^    tendon (.*)$', page.read_text(), re.MULTILINE):
        verb, *rest = shlex.split(line)
        verbs.append(verb)
        assert verb in NOT_RUN or main([verb, *rest]) == 0, capsys.readouterr().err
    every = ['import', 'info', 'check', 'simulate', 'estimate', 'diagnose']
    assert verbs == [v for v in every if v != 'estimate' or page.stem not in BY_TORQUE]


@pytest.mark.parametrize('page', PAGES, ids=lambda p: p.stem)
def test_a_recording_fits_its_instrument(page):
    one = load_instrument(page.stem)
    mapping = load_mapping(config_path(f'imports/{page.stem}.yaml'))
    [run] = import_runs(page.with_suffix('.csv'), mapping)
    measured = {name for name in run.channels if not name.startswith('setpoint/')}
    assert measured <= {sensor.channel for sensor in one.sensors}
    work = 0.0
    for motor in one.motors:
        joint = f'actuator/pulley_{motor.pulley}'
        if page.stem in BY_TORQUE:
            work += float(np.abs(run[f'{joint}/effort'].value).sum())
            continue
        angle = run[f'{joint}/position']
        assert np.ptp(angle.value) > 0.2
        effort = run[f'{joint}/effort'].at(angle.time[1:])
        work += float(np.sum(effort * np.diff(angle.value)))
    assert work > 0.0  # torques point along the motion: friction takes what the motors give


@pytest.mark.parametrize(('rig', 'place'), [('driven_axis', 'axis'), ('pendulum_arm', 'arm')])
def test_of_a_single_body_the_friction_is_found(rig, place):
    """What the pages say of the simulated recordings; those of many bodies take longer."""
    mapping = load_mapping(config_path(f'imports/{rig}.yaml'))
    runs = [*import_runs(ROOT / 'docs' / 'rigs' / f'{rig}.csv', mapping)]
    found = diagnose(runs, load_instrument(rig), jobs=2, plan=False).diagnosis
    assert [(c.effect, c.place) for c in found.causes] == [('coulomb_friction', f'pulley_{place}')]
    assert found.verdict == 'explained'


def test_the_tachometer_keeps_its_clock():
    mapping = load_mapping(config_path('imports/two_motor_belt.yaml'))
    [run] = import_runs(ROOT / 'docs' / 'rigs' / 'two_motor_belt.csv', mapping)
    speed, angle = run['pulley/pulley_roller/velocity'], run['actuator/pulley_left/position']
    assert not set(speed.time) & set(angle.time)
    slope = np.gradient(angle.value, angle.time)
    assert np.corrcoef(np.abs(np.interp(speed.time, angle.time, slope)), speed.value)[0, 1] > 0.99
