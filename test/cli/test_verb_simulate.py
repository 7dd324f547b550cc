"""``tendon simulate`` says in one line what it cannot do, before it simulates."""

import pytest

from tendon_ros.bags.reader import read_recording
from tendon_ros.cli.main import main

WORDS = ['--instrument', 'single_body', '--trajectory', 'step', '--set', 'duration=0.1 s']


def test_a_bag_is_replaced_where_that_is_allowed(tmp_path):
    words = ['simulate', *WORDS, '--engine', 'plain', '--out', str(tmp_path / 'bag')]
    assert main([*words, '--namespace', '/arm_1/tool']) == 0
    assert main(words) == 2
    assert read_recording(tmp_path / 'bag').metadata['namespace'] == '/arm_1/tool'
    assert main([*words, '--overwrite']) == 0
    assert read_recording(tmp_path / 'bag').metadata['namespace'] == '/instrument'


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['--out', 'x', '--seed', '-1'], '--seed -1: give 0 or more'),
        (['--out', 'text.txt'], 'text.txt: is no bag'),
        (['--out', 'link'], 'link: is a link'),
        (['--out', 'work'], 'work: is no bag that could be replaced (thesis.tex)'),
        (['--out', 'text.txt/x'], 'text.txt is a file, not a folder'),
        (['--out', 'x', '--namespace', 'a b'], "namespace 'a b': ROS cannot use it"),
        (['--out', 'x', '--namespace', 'arm/1st'], 'ROS cannot use it'),
        (['--out', 'x', '--namespace', 'arm//tool'], 'ROS cannot use it'),
    ],
)
def test_mistakes_are_one_line(tmp_path, monkeypatch, capsys, words, said):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr('tendon_ros.model.session.simulate', pytest.fail)
    (tmp_path / 'text.txt').write_text('mine')
    (tmp_path / 'work').mkdir()
    (tmp_path / 'work' / 'thesis.tex').write_text('years')
    (tmp_path / 'link').symlink_to('work')
    assert main(['simulate', *WORDS, '--overwrite', *words]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count('\n') == 1
    assert (tmp_path / 'text.txt').read_text() == 'mine'
    assert (tmp_path / 'work' / 'thesis.tex').read_text() == 'years'
