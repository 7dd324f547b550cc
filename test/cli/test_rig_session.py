"""The demonstration's folder: of what lies in it, only its own bag is replaced."""

import pytest

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.base.errors import SimulationError
from tendon_ros.cli import rig_session
from tendon_ros.cli.main import main


@pytest.fixture
def no_nodes(monkeypatch):
    """Let no node start: what is tested comes before."""

    def refuse(name, arguments, folder):
        raise SimulationError(f'{name}: not started')

    monkeypatch.setattr(rig_session, '_Process', refuse)


@pytest.fixture
def live(tmp_path):
    """Return the folder of the demonstration's bag, with a file of the user in it."""
    folder = tmp_path / 'live'
    folder.mkdir()
    (folder / 'notes.txt').write_text('mine')
    return folder


@pytest.mark.usefixtures('no_nodes')
def test_a_bag_of_an_earlier_demonstration_is_replaced_and_nothing_else(live, capsys):
    BagWriter(live / 'rig_bag').close()
    assert main(['demo', '--out', str(live.parent)]) == 2
    assert 'recorder: not started' in capsys.readouterr().err
    assert [path.name for path in live.iterdir()] == ['notes.txt']


@pytest.mark.usefixtures('no_nodes')
def test_a_folder_that_is_no_bag_is_kept(live, capsys):
    (live / 'rig_bag').mkdir()
    (live / 'rig_bag' / 'thesis.tex').write_text('mine')
    assert main(['demo', '--out', str(live.parent)]) == 2
    assert 'is no bag that could be replaced' in capsys.readouterr().err
    assert (live / 'rig_bag' / 'thesis.tex').exists()
