"""``tendon estimate`` writes where it was told to, and checks that before it reads a bag."""

from pathlib import Path
import shutil

import numpy as np
import pytest

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.recording import Channel
from tendon_ros.cli.main import build_parser, main
from tendon_ros.estimate import METHODS
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory
from tendon_ros.nodes import estimator


@pytest.fixture(scope='module')
def recorded():
    """Return a tenth of a second of a rig."""
    rig = load_instrument('bench_rig')
    settings = {'amplitude': '2 deg', 'duration': '0.1 s'}
    return simulate(rig, chosen_trajectory('step', rig.motor_names, settings), engine='plain')


@pytest.fixture
def bag(recorded, tmp_path):
    return write_recording(recorded, tmp_path / 'bag', namespace='/arm/left')


def estimate(*words):
    """Run the command; return its status."""
    return main(['estimate', *map(str, words), '--instrument', 'bench_rig'])


def test_a_csv_is_replaced_where_that_is_allowed(bag, tmp_path, capsys):
    out = tmp_path / 'x.csv'
    out.write_text('mine')
    assert estimate(bag, '--out', out) == 2
    assert f'{out}: exists' in capsys.readouterr().err
    assert out.read_text() == 'mine'
    assert estimate(bag, '--out', out, '--overwrite') == 0
    assert 'estimate/force [N]' in out.read_text()


def test_estimates_stay_in_the_namespace_of_the_bag(bag, tmp_path):
    assert estimate(bag, '--out', tmp_path / 'new' / 'estimated') == 0
    estimated = read_recording(tmp_path / 'new' / 'estimated')
    assert estimated.metadata['namespace'] == '/arm/left'
    assert 'estimate/force' in estimated


def test_joints_without_names_go_by_their_order_as_in_the_node(bag, nameless, tmp_path):
    assert estimate(bag, '--out', tmp_path / 'x.csv') == 0
    assert estimate(nameless(bag), '--out', tmp_path / 'y.csv') == 0
    named, unnamed = (
        np.genfromtxt(tmp_path / name, delimiter=',', names=True)['estimateforce_N']
        for name in ('x.csv', 'y.csv')
    )
    assert named.size > 10
    np.testing.assert_array_equal(unnamed, named)


def test_several_bags_go_into_a_folder(bag, tmp_path):
    other = shutil.copytree(bag, tmp_path / 'other')
    assert estimate(bag, other, '--out', tmp_path / 'all') == 0
    assert {p.name for p in (tmp_path / 'all').iterdir()} == {'bag', 'other'}


@pytest.mark.parametrize(
    ('bags', 'out', 'said'),
    [
        (['bag', 'deep/bag'], 'all', 'for both bag and deep/bag'),
        (['bag', './bag/'], 'all', 'for both bag and bag'),
        (['bag', 'other'], 'x.csv', 'one file for 2 bags; give a folder'),
        (['bag', 'other'], 'x.mcap', 'one file for 2 bags; give a folder'),
        (['bag', 'nowhere'], 'all', 'nowhere: does not exist'),
        (['bag', 'torn'], 'all', 'torn: no metadata.yaml'),
        (['bag', 'other'], 'estimated', 'estimated/other: is no bag that could be replaced'),
        (['bag'], 'bag', 'bag: would replace bag/bag.mcap, which is read'),
        (['bag/bag.mcap'], 'bag', 'bag: would replace bag/bag.mcap, which is read'),
        (['bag'], 'bag/bag.mcap', 'which is read'),
        (['bag'], 'text.txt/e', 'text.txt is a file, not a folder'),
        (['bag'], 'text.txt', 'text.txt: is no bag that could be replaced'),
    ],
)
def test_places_are_checked_first(bag, tmp_path, monkeypatch, capsys, bags, out, said):
    monkeypatch.chdir(tmp_path)
    for name in ('deep/bag', 'other', 'torn'):
        shutil.copytree(bag, name)
    (tmp_path / 'torn' / 'metadata.yaml').unlink()
    (tmp_path / 'text.txt').write_text('mine')
    (tmp_path / 'estimated' / 'other').mkdir(parents=True)
    (tmp_path / 'estimated' / 'other' / 'notes.txt').write_text('mine')
    before = {p: p.read_bytes() for p in tmp_path.rglob('*') if p.is_file()}
    assert estimate(*bags, '--out', out, '--overwrite') == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count('\n') == 1
    assert {p: p.read_bytes() for p in tmp_path.rglob('*') if p.is_file()} == before


def test_channels_may_have_spaces_between_them(bag, tmp_path):
    rig = load_instrument('bench_rig')
    names = [s.channel for s in rig.sensors if s.channel.startswith('actuator/')]
    channels = ' , '.join(names)
    assert estimate(bag, '--out', tmp_path / 'x.csv', '--channels', channels) == 0


def test_what_the_node_takes_is_taken_here(bag, tmp_path):
    rig = load_instrument('bench_rig')
    channels = ','.join(s.channel for s in rig.sensors if s.channel.startswith('actuator/'))
    assert estimate(bag, '--out', tmp_path / 'x.csv', '--channels', f'{channels},') == 0
    assert estimate(bag, '--out', tmp_path / 'y.csv', '--wander', '0') == 0
    assert estimate(bag, '--out', tmp_path / 'z.csv') == 0
    assert (tmp_path / 'y.csv').read_text() == (tmp_path / 'z.csv').read_text()


def test_the_page_and_the_help_say_what_is_taken_without_a_method(capsys):
    words = ['estimate', 'bag', '--instrument', 'bench_rig', '--out', 'x']
    ours = build_parser().parse_args(words).method
    [theirs] = [one.default for one in estimator.PROGRAM.settings if one.name == 'method']
    page = (Path(__file__).parents[2] / 'docs' / 'estimation.md').read_text()
    assert f'`tendon estimate` takes `{ours}`' in page
    assert f'The node takes `{theirs}`' in page
    assert main(['estimate', '--help']) == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert f'{ours} (default)' in said
    assert f"{theirs} (the node's)" in said
    assert all(name in said for name in METHODS)


def test_what_is_left_out_of_a_bag_is_told(recorded, tmp_path, capsys):
    motor = recorded['actuator/pulley_M/position']
    value = motor.value.copy()
    value[20] = 100.0
    wild = recorded.with_channels([Channel(motor.name, motor.time, value)])
    bag = write_recording(wild, tmp_path / 'wild')
    assert estimate(bag, '--out', tmp_path / 'x.csv') == 0
    said = capsys.readouterr().err
    assert f'warning: wild: 1 of {len(value)} measurements left out, the first at ' in said
