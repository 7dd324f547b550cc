"""The command line around bags: output, one-line errors and exit statuses."""

import csv
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import tendon_ros
from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.cli import main as cli
from tendon_ros.cli.main import main, verbs

MAPPING = """
format: npz
runs: {include: '[0-9]'}
time: {column: 0}
channels:
  actuator/motor/position: {column: 1, unit: deg}
"""


@pytest.fixture
def bag(tmp_path):
    time = np.arange(100) / 500
    channels = [Channel(f'actuator/{n}/position', time, np.sin(time)) for n in ('a', 'b')]
    recording = Recording('r', {c.name: c for c in channels}, 10**18, {'seed': '5'})
    return write_recording(recording, tmp_path / 'bag')


@pytest.fixture
def foreign(tmp_path):
    table = np.stack([np.arange(50) / 100, np.arange(50.0)], axis=1)
    np.savez(tmp_path / 'runs.npz', **{'1': table, '2': table})
    (tmp_path / 'map.yaml').write_text(MAPPING)
    return tmp_path / 'runs.npz', tmp_path / 'map.yaml'


def one_line(capsys):
    captured = capsys.readouterr()
    assert captured.out == ''
    assert captured.err.count('\n') == 1
    assert 'Traceback' not in captured.err
    return captured.err


def test_the_verbs_are_found_by_their_files():
    found = verbs()
    assert {'info', 'export', 'import', 'recover'} <= set(found)
    for name, verb in found.items():
        assert verb.HELP, name
        assert '\n' not in verb.HELP


def test_version_and_help(capsys):
    assert main(['--version']) == 0
    assert capsys.readouterr().out == f'tendon {tendon_ros.__version__}\n'
    assert main(['--help']) == 0
    assert 'import' in capsys.readouterr().out
    for name in verbs():
        assert main([name, '--help']) == 0
        assert capsys.readouterr().out.startswith(f'usage: tendon {name}')


@pytest.mark.parametrize(
    'arguments',
    [[], ['dance'], ['info'], ['info', '--dance', 'x'], ['import', 'x'], ['export', 'x']],
)
def test_bad_arguments_are_one_line_and_status_2(capsys, arguments):
    assert main(arguments) == 2
    assert '--help' in one_line(capsys)


def test_info(bag, capsys):
    assert main(['info', str(bag)]) == 0
    text = capsys.readouterr().out
    assert '/instrument/actuator/measured_js' in text
    assert 'seed: 5' in text
    assert main(['info', str(bag), '--json']) == 0
    (topic,) = json.loads(capsys.readouterr().out)['topics']
    assert (topic['count'], topic['gaps']) == (100, 0)


def test_export(bag, tmp_path, capsys):
    out = tmp_path / 'x.csv'
    assert main(['export', str(bag), '--out', str(out)]) == 0
    assert capsys.readouterr().out == f'{out}\n'
    with out.open() as stream:
        assert len(list(csv.reader(stream))) == 101
    assert main(['export', str(bag), '--out', str(out)]) == 2
    assert 'exists' in one_line(capsys)


def test_import_makes_a_bag_a_run(foreign, tmp_path, capsys):
    file, mapping = foreign
    arguments = ['import', str(file), '--mapping', str(mapping), '--out']
    assert main([*arguments, str(tmp_path / 'all')]) == 0
    assert sorted(p.name for p in (tmp_path / 'all').iterdir()) == ['1', '2']
    assert main([*arguments, str(tmp_path / 'one'), '--select', '2']) == 0
    values = read_recording(tmp_path / 'one')['actuator/motor/position'].value
    np.testing.assert_allclose(values, np.radians(np.arange(50)))
    capsys.readouterr()
    assert main([*arguments, str(tmp_path / 'none'), '--select', '7']) == 2
    assert 'it has 1, 2' in one_line(capsys)
    mapping.write_text(MAPPING.replace('deg', 'kg'))
    assert main([*arguments, str(tmp_path / 'none')]) == 2
    assert f'{mapping}: channels: actuator/motor/position' in one_line(capsys)


def test_import_takes_the_storage_that_the_ending_says(foreign, tmp_path, capsys):
    file, mapping = foreign
    words = ['import', str(file), '--mapping', str(mapping), '--select', '2', '--out']
    assert main([*words, str(tmp_path / 'x.mcap'), '--storage', 'mcap']) == 0
    assert main([*words, str(tmp_path / 'x.db3')]) == 0
    assert (tmp_path / 'x.db3').read_bytes().startswith(b'SQLite')
    assert main([*words, str(tmp_path / 'bag'), '--storage', 'sqlite3']) == 0
    assert list((tmp_path / 'bag').glob('*.db3'))
    capsys.readouterr()
    assert main([*words, str(tmp_path / 'y.mcap'), '--storage', 'sqlite3']) == 2
    assert 'its ending says mcap, --storage sqlite3' in one_line(capsys)
    assert not (tmp_path / 'y.mcap').exists()


def test_import_checks_all_places_first(foreign, tmp_path, capsys):
    file, mapping = foreign
    words = ['import', str(file), '--mapping', str(mapping), '--overwrite', '--out']
    (tmp_path / 'all' / '2').mkdir(parents=True)
    (tmp_path / 'all' / '2' / 'notes.txt').write_text('mine')
    assert main([*words, str(tmp_path / 'all')]) == 2
    assert 'is no bag that could be replaced' in one_line(capsys)
    assert not (tmp_path / 'all' / '1').exists()
    assert main([*words, str(tmp_path / 'x.mcap')]) == 2
    assert 'one file for 2 runs' in one_line(capsys)


def test_recover(bag, tmp_path, capsys):
    (bag / 'metadata.yaml').unlink()
    assert main(['info', str(bag)]) == 2
    assert 'tendon recover' in one_line(capsys)
    assert main(['recover', str(bag), '--out', str(tmp_path / 'new')]) == 0
    assert '100 messages recovered; nothing was missing\n' in capsys.readouterr().out
    assert main(['recover', str(bag), '--out', str(tmp_path / 'new')]) == 2
    assert 'exists' in one_line(capsys)


def test_missing_and_damaged_bags(bag, tmp_path, capsys):
    assert main(['info', str(tmp_path / 'none')]) == 2
    assert 'does not exist' in one_line(capsys)
    file = bag / 'bag.mcap'
    file.write_bytes(file.read_bytes()[:-100])
    assert main(['export', str(bag), '--out', str(tmp_path / 'x')]) == 2
    assert f'{bag}: truncated' in one_line(capsys)


def test_several_instruments(bag, tmp_path, capsys, monkeypatch):
    both = bag.with_name('both')
    _two_instruments(both)
    assert main(['export', str(both), '--out', str(tmp_path / 'x')]) == 2
    assert '/left, /right' in one_line(capsys)
    assert main(['export', str(both), '--out', str(tmp_path / 'x'), '--namespace', 'left']) == 0


def _two_instruments(path):
    from tendon_ros.bags.bag_writer import BagWriter
    from tendon_ros.bags.encoding import joint_layout

    layout = joint_layout(['a'], ['position'])
    with BagWriter(path) as writer:
        for side in ('left', 'right'):
            topic = f'/{side}/actuator/measured_js'
            writer.add_topic(topic, 'sensor_msgs/msg/JointState')
            for cdr in layout.encode(np.arange(3), np.zeros((3, 1))):
                writer.write_raw(topic, cdr, 0)


def test_ctrl_c_is_quiet(capsys, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, 'build_parser', interrupted)
    assert main(['info', 'x']) == 1
    assert one_line(capsys) == 'tendon: interrupted\n'


def test_a_closed_pipe_is_quiet(bag):
    code = 'import sys; from tendon_ros.cli.main import main; sys.exit(main())'
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, '-c', code, 'info', str(bag)],
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        # Python itself ignores SIGPIPE; a parent that does not must not change that
        preexec_fn=lambda: signal.signal(signal.SIGPIPE, signal.SIG_DFL),
        check=False,
    )
    os.close(write)
    assert done.stderr == ''
    assert done.returncode == 1


def test_a_defect_is_not_hidden(monkeypatch):
    def broken():
        raise ZeroDivisionError

    monkeypatch.setattr(cli, 'build_parser', broken)
    with pytest.raises(ZeroDivisionError):
        main(['info', 'x'])


@pytest.mark.parametrize('key', ['../escaped', 'sub/b', '..', '/tmp/b'])
def test_no_run_is_written_outside_of_the_folder(tmp_path, capsys, key):
    file, mapping, out = tmp_path / 'x.npz', tmp_path / 'map.yaml', tmp_path / 'deep' / 'bags'
    table = np.stack([np.arange(40) * 1e-3, np.arange(40.0)], axis=1)
    np.savez(file, **{'a': table, key: table})
    mapping.write_text(MAPPING.replace('[0-9]', '*'))
    words = ['import', str(file), '--mapping', str(mapping), '--out', str(out)]
    assert main(words) == 2
    assert f'run {key!r} is no name of a bag in {out}' in capsys.readouterr().err
    assert not out.parent.exists()
