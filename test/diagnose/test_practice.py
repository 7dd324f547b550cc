"""Practice cases of another simulator with known truth; all ten: ``python -m bench.practice``."""

import json

import pytest

from bench.practice import answers

#: quick ones: nothing but small errors, friction seen by the motors alone
CASES = ['case_01', 'case_06']


@pytest.mark.parametrize('case', CASES)
def test_answered_right_and_in_time(practice, quick, monkeypatch, case):
    monkeypatch.setattr('bench.practice.diagnose', quick)
    labels = json.loads((practice / 'labels.json').read_text())
    [answer] = answers(practice, {case: labels[case]}, jobs=2)
    causes = answer.diagnosis.causes
    assert answer.right, (answer.truth, answer.diagnosis.verdict, causes)
    for gap in answer.diagnosis.gap:
        assert gap.after < 1.5 * gap.noise_floor
    # 60 s are promised on two cores of their own
    assert answer.seconds < 120.0
