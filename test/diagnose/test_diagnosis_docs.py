"""The pages on the diagnosis say the numbers and words that the code uses."""

from pathlib import Path
from typing import get_args

import pytest

from tendon_ros.cli.verb_diagnose import WHAT_IS_HERE
from tendon_ros.diagnose import prepare, rounds, search, session
from tendon_ros.diagnose.result import Verdict
from tendon_ros.identify import binning, segment, tolerance

DOCS = Path(__file__).parents[2] / 'docs'
GUIDE = (DOCS / 'diagnosis.md').read_text()
METHOD = (DOCS / 'diagnosis_method.md').read_text()
#: without line ends
IN_GUIDE, IN_METHOD = (' '.join(page.split()) for page in (GUIDE, METHOD))


@pytest.mark.parametrize(
    'words',
    [
        f'a standard deviation of {100.0 * tolerance.MEASURED:g} %',
        f'dampings of {100.0 * tolerance.DAMPING:g} %',
        f'named from {session.NAMED:g} on',
    ],
)
def test_numbers_of_both(words):
    assert words in IN_GUIDE
    assert words in IN_METHOD


@pytest.mark.parametrize(
    'words',
    [
        f'bins of {1000.0 * binning.USUAL_BIN:g} ms',
        f'first {segment.SETTLING:g} s',
        f'One block of {prepare.BLOCK:g} s',
    ],
)
def test_numbers_of_the_method(words):
    assert words in IN_METHOD


def test_counts_in_words():
    names = {3: 'three', 4: 'four', 6: 'six', 10: 'Ten', 12: 'twelve'}
    places = {6: 'sixth'}
    for page in (IN_GUIDE, IN_METHOD):
        assert f'{names[int(tolerance.REACH)]} deviations at most' in page
        assert f'{names[rounds.MOST]} causes at most' in page
    assert f's in {names[prepare.KEPT]} is never fitted' in IN_METHOD
    assert f'from {names[prepare.WHOLE]} recordings on' in IN_METHOD
    assert f'{names[search.ROUNDS].capitalize()} rounds at most' in IN_METHOD
    assert f'from the {places[rounds.MANY + 1]} on' in IN_METHOD
    assert f'ends with {names[search.FORETELL]} causes' in IN_METHOD
    assert f'{names[rounds.MOST]} causes at most, {names[search.FORETELL]} where' in IN_GUIDE


def test_verdicts_and_files():
    for verdict in get_args(Verdict):
        assert f'`{verdict}`' in GUIDE
    for line in WHAT_IS_HERE.splitlines():
        assert f'`{line.split(":")[0]}`' in GUIDE
