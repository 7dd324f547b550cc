"""The cable that comes with the package is what the command makes; tables are read."""

import pytest

from tendon_ros.base.resources import config_path
from tendon_ros.cli.main import main
from tendon_ros.model.cable import elongation_at, tension_at


def test_installed_cable_is_what_the_command_gives(tmp_path, capsys):
    out = tmp_path / 'sava_1027.yaml'
    assert main(['cable', '--out', str(out)]) == 0
    assert out.read_text() == config_path('cables/sava_1027.yaml').read_text()
    assert '109 points, to 197.8 N at 2.16 mm' in capsys.readouterr().out


def test_other_pretension_and_forces(tmp_path, curve_of):
    out = tmp_path / 'other.yaml'
    forces = '2 deg: 4.51 N, 4 deg: 12.25 N, 6 deg: 27.64 N'
    given = ['--pretension', '6 N', '--forces', forces, '--radius', '20 mm', '--arm', '40 mm']
    assert main(['cable', '--out', str(out), *given, '--loops', '2', '--up-to', '150 N']) == 0
    curve = curve_of(out)
    preload = elongation_at(curve, 6.0)
    delta = 0.02 * 0.10471975511965978 / 2
    net = tension_at(curve, preload + delta) - tension_at(curve, preload - delta)
    assert net * 0.02 / 0.04 == pytest.approx(27.64, rel=1e-4)
    assert curve.tension[-1] >= 150.0


def test_tension_test(tmp_path, curve_of):
    table, out = tmp_path / 'test.csv', tmp_path / 'mine.yaml'
    table.write_text('elongation_mm,force_N\n0,0\n0.5,5\n1,20\n')
    assert main(['cable', '--table', str(table), '--out', str(out)]) == 0
    curve = curve_of(out)
    assert curve.elongation == (0.0, 5e-4, 1e-3)
    assert curve.tension == (0.0, 5.0, 20.0)
    assert 'test.csv' in out.read_text()


@pytest.mark.parametrize(
    ('given', 'said'),
    [
        (['--pretension', '5'], "--pretension: '5' has no unit"),
        (['--pretension', '-5 N'], "--pretension: '-5 N' must be positive"),
        (['--forces', '1 deg'], "--forces: '1 deg' is no pair"),
        (['--forces', '1 deg: 1 N'], 'forces: 1 given'),
        (['--loops', '0'], '--loops: 0 must be at least 1'),
        (['--up-to', '5 N'], '--up-to: 5 N does not exceed the pretension of 5 N'),
        (['--table', 'none.csv'], 'none.csv: cannot be read'),
    ],
)
def test_mistakes_are_one_line(tmp_path, capsys, given, said):
    assert main(['cable', '--out', str(tmp_path / 'x.yaml'), *given]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count('\n') == 1


def test_nowhere_to_write(tmp_path, capsys):
    (tmp_path / 'file').write_text('')
    assert main(['cable', '--out', str(tmp_path / 'file' / 'x.yaml')]) == 2
    assert 'is a file, not a folder' in capsys.readouterr().err


def test_a_file_is_replaced_only_where_that_is_allowed(tmp_path, capsys):
    out = tmp_path / 'new' / 'x.yaml'
    assert main(['cable', '--out', str(out)]) == 0
    out.write_text('mine')
    assert main(['cable', '--out', str(out)]) == 2
    assert out.read_text() == 'mine'
    assert '--overwrite' in capsys.readouterr().err
    assert main(['cable', '--out', str(out), '--overwrite']) == 0
    assert 'elongation' in out.read_text()


def test_the_table_that_is_read_is_not_replaced(tmp_path, capsys):
    table = tmp_path / 'test.csv'
    table.write_text('elongation_mm,force_N\n0,0\n0.5,5\n1,20\n')
    assert main(['cable', '--table', str(table), '--out', str(table), '--overwrite']) == 2
    assert 'which is read' in capsys.readouterr().err
    assert table.read_text().startswith('elongation_mm')
