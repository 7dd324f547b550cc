"""A mistake in the arguments is one line."""

import pytest

from tendon_ros.base.command_line import MISTAKE, Parser


def test_a_mistake_is_one_line_that_says_where_to_look(capsys):
    with pytest.raises(SystemExit) as left:
        Parser(prog='simulator').parse_args(['--rte', '5'])
    assert left.value.code == MISTAKE == 2
    said = capsys.readouterr().err
    assert said == 'simulator: unrecognized arguments: --rte 5; see `simulator --help`\n'
