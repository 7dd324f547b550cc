"""``tendon blind``: what it refuses, and what it says."""

import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.blind.case import Settings
from tendon_ros.blind.store import make
from tendon_ros.cli.main import main


@pytest.mark.parametrize(
    ('wrong', 'said'),
    [
        (['--strata', 'easy'], 'two_three'),
        (['--channels', 'video'], 'joint'),
        (['--jobs', '0'], 'give 1 or more'),
        (['--nuisance', '-1'], 'give 0.0 or more'),
        (['--nuisance', '1'], 'is too large; give 0.1 or less'),
    ],
)
def test_wrong_arguments_are_named(wrong, said, tmp_path, capsys):
    out = tmp_path / 'out'
    assert main(['blind', 'make', '--out', str(out), '--seed', '1', '--cases', '1', *wrong]) == 2
    error = capsys.readouterr().err
    assert wrong[0] in error
    assert said in error
    assert not out.exists()


def test_the_kind_of_a_seed_is_said(tmp_path, capsys):
    make(tmp_path, 1000, 1, Settings(strata=('none',)))
    arguments = ['--seed', '1000', '--cases', '1', '--strata', 'none']
    assert main(['blind', 'make', '--out', str(tmp_path), *arguments]) == 0
    assert 'published' in capsys.readouterr().out


def test_a_folder_without_results_is_no_score(tmp_path, capsys):
    make(tmp_path, 1, 1, Settings(strata=('none',)))
    assert main(['blind', 'score', str(tmp_path), str(tmp_path / 'none')]) == 2
    assert 'tendon blind run' in capsys.readouterr().err


def test_a_folder_without_cases_is_no_run(tmp_path, capsys):
    assert main(['blind', 'run', str(tmp_path), '--out', str(tmp_path / 'r')]) == 2
    assert 'withhold.json' in capsys.readouterr().err


def test_a_case_that_was_not_diagnosed_is_said(tmp_path, capsys, monkeypatch):
    def refuse(*_, **__):
        raise RecordingError('contact: nothing moves')

    make(tmp_path, 1, 1, Settings(strata=('none',)))
    monkeypatch.setattr('tendon_ros.diagnose.session.diagnose', refuse)
    assert main(['blind', 'run', str(tmp_path), '--out', str(tmp_path / 'said')]) == 0
    said = capsys.readouterr().out
    assert 'case_0000: was not diagnosed: contact: nothing moves' in said
