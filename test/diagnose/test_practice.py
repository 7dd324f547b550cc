"""Practice cases of another simulator with known truth; all ten: ``python -m bench.practice``."""

import json

import pytest

from bench.practice import answers

#: a quick one
CASES = ['case_01']


@pytest.mark.parametrize('case', CASES)
def test_answered_right(practice, quick, monkeypatch, case):
    monkeypatch.setattr('bench.practice.diagnose', quick)
    labels = json.loads((practice / 'labels.json').read_text())
    [answer] = answers(practice, {case: labels[case]}, jobs=2)
    causes = answer.diagnosis.causes
    assert answer.right, (answer.truth, answer.diagnosis.verdict, causes)
    for gap in answer.diagnosis.gap:
        assert gap.after < 1.5 * gap.noise_floor
