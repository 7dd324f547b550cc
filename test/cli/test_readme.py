"""The README's commands are commands: verbs that exist, with arguments that they take."""

from pathlib import Path
import re
import shlex

import pytest

from tendon_ros.cli.main import build_parser

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / 'README.md').read_text()
LINES = re.findall(r'^    (tendon .*)$', TEXT, re.MULTILINE)


def test_there_are_some():
    assert len(LINES) >= 8
    assert any(line.startswith('tendon diagnose') for line in LINES)


@pytest.mark.parametrize('line', LINES)
def test_command_is_understood(line):
    words = shlex.split(line.split('  #')[0])
    parsed = build_parser().parse_args(words[1:])
    assert parsed.verb == words[1]


def test_every_page_that_it_names_exists():
    pages = re.findall(r'\]\(((?!http)[^)#]+)\)', TEXT)
    assert 'docs/diagnosis.md' in pages
    assert not [page for page in pages if not (ROOT / page).exists()]
