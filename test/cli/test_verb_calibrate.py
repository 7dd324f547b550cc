"""``tendon calibrate`` writes a file that works, and refuses in one line what it cannot do."""

import pytest

from tendon_ros.bags.writer import write_recording
from tendon_ros.cli.main import main
from tendon_ros.model.instrument_file import load_instrument

WEIGHT = 'effects:\n- {effect: gravity, place: pulley_body, parameters: {torque: 0.2 N*m}}\n'


@pytest.fixture
def files(measured_on, tmp_path):
    """Return a bag of a body with a weight, and a file with another weight."""
    body = load_instrument('single_body')
    run = measured_on(
        body,
        ('gravity', 'pulley_body', {'torque': 0.3, 'phase': 0.0}),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )
    write_recording(run, tmp_path / 'weight')
    (tmp_path / 'first.yaml').write_text(f'base: single_body\n{WEIGHT}')
    return tmp_path / 'weight', tmp_path / 'first.yaml'


def test_writes_a_file_and_says_what_differs(files, tmp_path, capsys):
    bag, first = files
    out = tmp_path / 'second.yaml'
    words = ['calibrate', str(bag), '--instrument', str(first), '--out', str(out)]
    assert main(words) == 0
    assert 'differs here    Gravity on pulley body: torque 0.3' in capsys.readouterr().out
    [gravity] = [e for e in load_instrument(out).effects if e.effect == 'gravity']
    assert gravity.parameters['torque'] == pytest.approx(0.3, rel=0.01)


def test_joints_without_names_go_by_their_order(files, nameless, tmp_path, capsys):
    bag, first = files
    out = tmp_path / 'second.yaml'
    words = ['calibrate', str(nameless(bag)), '--instrument', str(first), '--out', str(out)]
    assert main(words) == 0
    assert 'torque 0.3' in capsys.readouterr().out


def test_a_bag_of_another_rig_is_refused(files, tmp_path, capsys):
    bag, _ = files
    words = ['calibrate', str(bag), '--instrument', 'paper_rig', '--out', str(tmp_path / 'x.yaml')]
    assert main(words) == 2
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert 'does not fit' in error
    assert not (tmp_path / 'x.yaml').exists()


def test_files_of_the_user_are_kept(files, tmp_path, capsys, monkeypatch):
    bag, first = files
    monkeypatch.setattr('tendon_ros.diagnose.calibrate.calibrate', pytest.fail)
    (tmp_path / 'mine.yaml').write_text('mine')
    for out, more, said in (
        (first, ['--overwrite'], 'which is read'),
        (tmp_path / 'mine.yaml', [], 'exists'),
        (first / 'x.yaml', [], 'is a file, not a folder'),
    ):
        words = ['calibrate', str(bag), '--instrument', str(first), '--out', str(out), *more]
        assert main(words) == 2
        assert said in capsys.readouterr().err
    assert first.read_text().startswith('base')
    assert (tmp_path / 'mine.yaml').read_text() == 'mine'
