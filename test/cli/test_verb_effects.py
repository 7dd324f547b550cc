"""``tendon effects`` prints the catalogue, a data sheet, or writes the page."""

import argparse

import pytest

from tendon_ros.base.errors import EffectError, OutputError
from tendon_ros.cli import verb_effects
from tendon_ros.effects import catalogue
from tendon_ros.report.effects_page import page


def run(*words):
    """Run the verb as the command line would."""
    parser = argparse.ArgumentParser()
    verb_effects.add_arguments(parser)
    verb_effects.run(parser.parse_args(words))


def test_list(capsys):
    run()
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(catalogue())
    assert any('Backlash (motor, coupling)' in line for line in lines)


def test_one(capsys):
    run('gravity')
    out = capsys.readouterr().out
    assert 'tau = -torque * sin(theta - phase)' in out
    assert '| `torque` | N m |' in out


def test_unknown():
    with pytest.raises(EffectError, match=r"no effect 'gravitty'; there are"):
        run('gravitty')


def test_markdown(tmp_path, capsys):
    run('--markdown', str(tmp_path / 'effects.md'))
    assert (tmp_path / 'effects.md').read_text(encoding='utf-8') == page()
    assert f'{len(catalogue())} effects' in capsys.readouterr().out


def test_markdown_replaces_only_what_it_may(tmp_path):
    path = tmp_path / 'effects.md'
    path.write_text('mine')
    with pytest.raises(OutputError, match='exists'):
        run('--markdown', str(path))
    assert path.read_text() == 'mine'
    run('--markdown', str(path), '--overwrite')
    assert path.read_text(encoding='utf-8') == page()


def test_one_and_page_exclude_each_other(capsys):
    with pytest.raises(SystemExit):
        run('gravity', '--markdown', 'x')
    assert 'not allowed with' in capsys.readouterr().err
