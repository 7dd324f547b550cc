"""A search whose time is up ends with what it has, and says what that leaves out."""

import math

import pytest

from tendon_ros.diagnose import patience as clocked
from tendon_ros.diagnose.belief import belief
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate

COULOMB = Candidate('coulomb_friction', 'pulley_3')
GAIN = Candidate('torque_gain', 'motor_L')


def test_it_runs_out_once_and_for_all(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(clocked.time, 'monotonic', lambda: now[0])
    patience = Patience(60.0)
    assert not patience.over
    assert not patience.late
    assert patience.words([COULOMB]) == []
    now[0] += 22.0  # half of which it looks for causes
    assert patience.late
    assert not patience.over
    assert 'cut short' in patience.words([])[0]
    assert not patience.half
    now[0] += 9.0
    assert patience.half
    patience = Patience(60.0)
    now[0] += 43.0  # seven tenths of it are the search's
    # nobody has asked since: nothing was left out
    assert patience.words([]) == []
    assert patience.over
    [told] = patience.words([COULOMB])
    assert '1 min' in told
    assert 'coulomb_friction at pulley_3' in told
    assert '--minutes' in told
    assert 'coulomb_friction' not in patience.words([])[0]
    assert not patience.ended
    now[0] += 18.0
    assert patience.ended
    assert 'what would separate' in patience.words([])[1]
    now[0] = 0.0
    assert patience.over
    assert patience.ended


def test_without_a_limit_it_never_does():
    assert not Patience().over
    assert not Patience(math.inf).over


@pytest.fixture(scope='module')
def rubbing(bench, measured_on):
    return measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.1}))


def test_what_no_rival_has_met_is_not_named(bench, rubbing):
    ready = prepared([rubbing], bench)
    begun = ready.problem.empty.joined(COULOMB, {'torque': 0.08})
    cut = Search(ready.problem, [COULOMB, GAIN], 1, begun=begun, patience=Patience(-1.0)).run()
    assert list(cut.final.model.causes) == [COULOMB]
    assert cut.unmet == [COULOMB]
    assert belief(ready, cut).weighed[0].chance < NAMED
    whole = Search(ready.problem, [COULOMB, GAIN], 1, begun=begun).run()
    assert whole.unmet == []
    assert belief(ready, whole).weighed[0].chance >= NAMED


def test_a_diagnosis_that_had_no_time_says_so(bench, rubbing):
    began = []
    outcome = diagnose(
        [rubbing], bench, jobs=1, plan=False, seconds=-1.0,
        report=lambda what, _done: began.append(what),
    )  # fmt: skip
    assert not any(what.startswith(('looking for causes', 'challenging')) for what in began)
    assert any('--minutes' in line for line in outcome.diagnosis.left_out)
    assert outcome.diagnosis.causes == ()
    assert outcome.diagnosis.verdict == 'unexplained'
