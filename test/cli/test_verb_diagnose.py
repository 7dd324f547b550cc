"""``tendon diagnose`` writes what it promises, and refuses in one line what it cannot do."""

import json

import pytest

from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import TendonError
from tendon_ros.cli.main import build_parser, main
from tendon_ros.diagnose.result import Diagnosis
from tendon_ros.model.instrument_file import load_instrument

BODY = ['--instrument', 'single_body']


@pytest.fixture(scope='module')
def bag(measured_on, tmp_path_factory):
    """Return a bag of one driven body with a weight on it."""
    body = load_instrument('single_body')
    run = measured_on(
        body,
        ('gravity', 'pulley_body', {'torque': 0.3, 'phase': 0.3}),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )
    path = tmp_path_factory.mktemp('bags') / 'weight'
    write_recording(run, path)
    return path


def said(capsys, *words):
    """Run the command; return its status, and what stands on stdout and stderr."""
    try:
        status = main(['diagnose', *map(str, words)])
    except SystemExit as stop:
        status = stop.code
    streams = capsys.readouterr()
    return status, streams.out, streams.err


def test_joints_without_names_go_by_their_order(bag, nameless, tmp_path, monkeypatch):
    class SeenError(TendonError):
        pass

    def seen(recordings, *_, **__):
        raise SeenError(','.join(sorted(recordings[0].channels)))

    monkeypatch.setattr('tendon_ros.diagnose.session.diagnose', seen)
    words = ['diagnose', str(nameless(bag)), *BODY, '--out', str(tmp_path / 'found')]
    args = build_parser().parse_args(words)
    with pytest.raises(
        SeenError, match='actuator/pulley_body/effort,actuator/pulley_body/position'
    ):
        args.run(args)


def test_writes_what_it_promises(bag, tmp_path, capsys):
    out = tmp_path / 'found'
    status, text, progress = said(capsys, bag, *BODY, '--out', out)
    assert status == 0
    data = json.loads((out / 'diagnosis.json').read_text())
    found = Diagnosis.model_validate(data)
    assert found.verdict == 'explained'
    [cause] = found.causes
    pairs = {(cause.effect, cause.place), *((c.effect, c.place) for c in cause.indistinguishable)}
    assert ('gravity', 'pulley_body') in pairs
    patched = load_instrument(str(out / 'instrument.yaml'))
    assert (cause.effect, cause.place) in {(e.effect, e.place) for e in patched.effects}
    status, _, _ = said(capsys, bag, '--instrument', out / 'instrument.yaml', '--out', out / 'b')
    assert status == 0
    assert json.loads((out / 'b/diagnosis.json').read_text())['verdict'] == 'no_gap'
    page = (out / 'report.html').read_text()
    assert page.lstrip().lower().startswith('<!doctype html')
    assert 'src="http' not in page
    assert 'href="http' not in page.split('<body')[0]
    assert not (out / 'unfinished.json').exists()
    # what is left in the folder is explained there
    told = (out / 'README.txt').read_text()
    assert all(p.name in told for p in out.iterdir() if p.name not in ('README.txt', 'b'))
    assert 'report.html' in text
    assert 'looking for causes, round 1' in progress
    assert '%' in progress
    assert 'looking for' not in text


def test_only_the_seconds_that_are_asked_for_are_looked_at(bag, tmp_path, monkeypatch):
    seen = []

    def looks(recordings, *_, **__):
        seen.extend(recordings)
        raise TendonError('seen')

    monkeypatch.setattr('tendon_ros.diagnose.session.diagnose', looks)
    words = [str(bag), *BODY, '--out', str(tmp_path / 'found'), '--only', ':2', '--only', '3:']
    args = build_parser().parse_args(['diagnose', *words])
    with pytest.raises(TendonError, match='seen'):
        args.run(args)
    assert [r.name for r in seen] == ['weight, 0 to 2 s', 'weight, 3 to 6 s']
    assert all(r['actuator/pulley_body/effort'].time[0] == 0.0 for r in seen)


def test_withheld_on_the_command_line(bag, tmp_path, capsys):
    words = ['--withhold', 'backlash', '--withhold', 'joint_spring@pulley_body']
    status, _, _ = said(capsys, bag, *BODY, '--out', tmp_path / 'x', *words)
    assert status == 0
    rows = json.loads((tmp_path / 'x/diagnosis.json').read_text())['candidates']
    assert not {'backlash', 'joint_spring'} & {row['effect'] for row in rows}


@pytest.mark.parametrize(
    ('words', 'says'),
    [
        (['nowhere', *BODY, '--out', 'x'], 'nowhere'),
        (['BAG', '--instrument', 'no_such_rig', '--out', 'x'], 'no_such_rig'),
        (['BAG', *BODY, '--out', 'x', '--withhold', 'gravitas'], 'gravitas'),
        (['BAG', *BODY, '--out', 'x', '--withhold', 'gravity@pulley_9'], 'pulley_9'),
        (['BAG', *BODY, '--out', 'x', '--jobs', '0'], '--jobs 0'),
        (['BAG', *BODY, '--out', 'x', '--jobs', 'many'], 'many'),
        (['BAG', *BODY, '--out', 'x', '--minutes', '-1'], '--minutes -1'),
        (['BAG', *BODY, '--out', 'x', '--minutes', 'nan'], '--minutes nan'),
        (['BAG', *BODY, '--out', 'x', '--only', '5'], "--only '5'"),
        (['BAG', *BODY, '--out', 'x', '--only', '40:50'], 'lasts 6.0 s'),
        (['BAG', *BODY], '--out'),
        (['BAG', *BODY, '--out', 'a_file/x'], 'a_file'),
        ([*BODY, '--out', 'x'], 'BAG'),
        (['BAG', '--instrument', 'bench_rig', '--out', 'x'], 'pulley_'),
    ],
)
def test_mistakes_are_told_in_one_line(bag, tmp_path, monkeypatch, capsys, words, says):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'a_file').write_text('not a folder')
    status, text, error = said(capsys, *(bag if word == 'BAG' else word for word in words))
    assert status == 2
    assert text == ''
    [line] = [row for row in error.splitlines() if not row.lstrip().startswith('0%')]
    assert says in line
    assert 'Traceback' not in error


def test_an_interrupt_is_no_answer_and_no_traceback(bag, tmp_path, monkeypatch, capsys):
    from tendon_ros.diagnose import search

    def stopped(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(search.Search, 'run', stopped)
    try:
        status = main(['diagnose', str(bag), *BODY, '--out', str(tmp_path / 'x')])
    except KeyboardInterrupt:
        pytest.fail('Ctrl-C came through')
    assert status not in (0, 2)
    assert 'Traceback' not in capsys.readouterr().err
    assert not (tmp_path / 'x/diagnosis.json').exists()


def stops_where_it_would_diagnose(monkeypatch):
    def stopped(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr('tendon_ros.diagnose.session.diagnose', stopped)


def test_what_a_user_made_is_kept(bag, tmp_path, monkeypatch, capsys):
    stops_where_it_would_diagnose(monkeypatch)
    out = tmp_path / 'work'
    out.mkdir()
    for name in ('README.txt', 'instrument.yaml', 'diagnosis.json'):
        file = out / name
        file.write_text('{"mine": 1}')
        status, _, error = said(capsys, bag, *BODY, '--out', out)
        assert (status, f'{file}: exists' in error) == (2, True)
        assert file.read_text() == '{"mine": 1}'
        status, _, _ = said(capsys, bag, *BODY, '--out', out, '--overwrite')
        assert status == 1  # it got as far as diagnosing
        file.unlink()


def test_the_instrument_that_is_read_is_kept(bag, tmp_path, monkeypatch, capsys):
    stops_where_it_would_diagnose(monkeypatch)
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'instrument.yaml').write_text('base: single_body\n')
    words = [bag, '--instrument', 'instrument.yaml', '--out', '.', '--overwrite']
    status, _, error = said(capsys, *words)
    assert (status, 'which is read' in error) == (2, True)


@pytest.mark.parametrize(
    ('name', 'left'),
    [
        ('diagnosis.json', {'schema': 1, 'verdict': 'no_gap', 'causes': []}),
        ('unfinished.json', {'key': '', 'models': [], 'weighed': None}),
    ],
)
def test_its_own_files_are_replaced_unasked(bag, tmp_path, monkeypatch, capsys, name, left):
    stops_where_it_would_diagnose(monkeypatch)
    (tmp_path / name).write_text(json.dumps(left))
    (tmp_path / 'README.txt').write_text('from an earlier version')
    status, _, _ = said(capsys, bag, *BODY, '--out', tmp_path)
    assert status == 1


def test_a_failure_leaves_no_word_of_files_that_are_not_there(bag, tmp_path, monkeypatch, capsys):
    stops_where_it_would_diagnose(monkeypatch)
    assert said(capsys, bag, *BODY, '--out', tmp_path / 'x')[0] == 1
    assert not (tmp_path / 'x' / 'README.txt').exists()
