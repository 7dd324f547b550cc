"""What a long task says of its progress."""

from tendon_ros.cli.progress import told


def test_progress_never_goes_back(capsys):
    with told() as report:
        for what, done in (('searching', 0.5), ('searching again', 0.3), ('judging', 0.8)):
            report(what, done)
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().err.splitlines()]
    assert lines == [['50%', 'searching'], ['50%', 'searching again'], ['80%', 'judging']]
