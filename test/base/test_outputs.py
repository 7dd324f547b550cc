"""Results go where they can be written, and replace nothing that a user would miss."""

import os

import pytest

from tendon_ros.base.errors import OutputError
from tendon_ros.base.outputs import check_output, check_reachable


def test_a_file_is_replaced_only_where_that_is_allowed(tmp_path):
    check_output(tmp_path / 'new' / 'deep' / 'x.csv')
    assert not (tmp_path / 'new').exists()
    (tmp_path / 'x.csv').write_text('mine')
    with pytest.raises(OutputError, match=r'exists; .* --overwrite'):
        check_output(tmp_path / 'x.csv')
    check_output(tmp_path / 'x.csv', overwrite=True)
    with pytest.raises(OutputError, match='is a folder'):
        check_output(tmp_path, overwrite=True)


def test_what_is_read_is_never_replaced(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'rig.yaml').write_text('')
    (tmp_path / 'link.yaml').symlink_to('rig.yaml')
    for name in ('rig.yaml', 'link.yaml', './none/../rig.yaml'):
        with pytest.raises(OutputError, match='which is read'):
            check_output(tmp_path / name, [tmp_path.relative_to(tmp_path) / 'rig.yaml'])
    check_output(tmp_path / 'other.yaml', [tmp_path / 'rig.yaml'])


def test_what_stands_in_the_way_is_named(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(OutputError, match='file is a file, not a folder'):
        check_reachable(tmp_path / 'file' / 'deep' / 'x')
    with pytest.raises(OutputError, match='name too long'):
        check_reachable(tmp_path / ('x' * 300))


def test_a_place_that_may_not_be_written_to(tmp_path, monkeypatch):
    file = tmp_path / 'x'
    file.write_text('')
    # root, whom no permission stops, runs tests too
    monkeypatch.setattr(os, 'access', lambda path, mode: path != file)
    with pytest.raises(OutputError, match='may not be written to'):
        check_output(file, overwrite=True)
    monkeypatch.setattr(os, 'access', lambda path, mode: path != tmp_path)
    with pytest.raises(OutputError, match=f'{tmp_path} may not be written to'):
        check_reachable(tmp_path / 'deep' / 'x')
