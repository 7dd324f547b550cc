"""docs/diagnosis.md says the numbers and words that the code uses."""

from pathlib import Path
from typing import get_args

import pytest

from tendon_ros.cli.verb_diagnose import WHAT_IS_HERE
from tendon_ros.diagnose import prepare, rounds, search, session
from tendon_ros.diagnose.result import Verdict
from tendon_ros.identify import binning, segment, tolerance

PAGE = (Path(__file__).parents[2] / 'docs' / 'diagnosis.md').read_text()
TEXT = ' '.join(PAGE.split())


@pytest.mark.parametrize(
    'words',
    [
        f'bins of {1000.0 * binning.USUAL_BIN:g} ms',
        f'first {segment.SETTLING:g} s',
        f'a standard deviation of {100.0 * tolerance.MEASURED:g} %',
        f'dampings of {100.0 * tolerance.DAMPING:g} %',
        f'One block of {prepare.BLOCK:g} s',
        f'named from {session.NAMED:g} on',
    ],
)
def test_numbers(words):
    assert words in TEXT


def test_counts_in_words():
    names = {3: 'three', 4: 'four', 6: 'six', 10: 'Ten'}
    places = {6: 'sixth'}
    assert f'{names[int(tolerance.REACH)]} deviations at most' in TEXT
    assert f's in {names[prepare.KEPT]} is never fitted' in TEXT
    assert f'from {names[prepare.WHOLE]} recordings on' in TEXT
    assert f'{names[rounds.MOST]} causes at most' in TEXT
    assert f'{names[search.ROUNDS].capitalize()} rounds at most' in TEXT
    assert f'from the {places[rounds.MANY + 1]} on' in TEXT


def test_verdicts_and_files():
    for verdict in get_args(Verdict):
        assert f'`{verdict}`' in PAGE
    for line in WHAT_IS_HERE.splitlines():
        assert f'`{line.split(":")[0]}`' in PAGE
