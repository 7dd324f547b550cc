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
from tendon_ros.identify.effort import Effort

COULOMB = Candidate('coulomb_friction', 'pulley_3')
GAIN = Candidate('torque_gain', 'motor_L')


class Spent(Effort):
    """Seconds of one core, as told."""

    seconds = 0.0


def test_it_runs_out_by_what_is_spent_once_and_for_all():
    effort = Spent()
    effort.seconds = 1000.0  # before its time
    patience = Patience(60.0, effort)
    assert not patience.over
    assert not patience.late
    assert patience.words([COULOMB]) == []
    effort.seconds += 2 * 22.0  # of two cores; in a part of it it looks for causes
    assert patience.late
    assert not patience.over
    assert 'cut short' in patience.words([])[0]
    assert not patience.half
    effort.seconds += 2 * 15.0
    assert patience.half
    patience = Patience(60.0, effort)
    effort.seconds += 2 * 49.0  # eight tenths of it are the search's
    # nobody has asked since: nothing was left out
    assert patience.words([]) == []
    assert patience.over
    [told] = patience.words([COULOMB])
    assert '1 min' in told
    assert 'coulomb_friction at pulley_3' in told
    assert '--minutes' in told
    assert 'clock' not in told
    assert 'coulomb_friction' not in patience.words([])[0]
    assert not patience.ended
    effort.seconds += 2 * 12.0
    assert patience.ended
    assert 'what would separate' in patience.words([])[1]
    effort.seconds = 0.0
    assert patience.over
    assert patience.ended


def test_the_clock_ends_it_on_a_machine_that_is_far_too_slow(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(clocked.time, 'monotonic', lambda: now[0])
    patience = Patience(60.0)
    now[0] += 2 * 60.0
    assert not patience.over
    now[0] += 30.0
    assert patience.over
    [told] = patience.words([])
    assert 'the clock ended it' in told


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


def test_a_busy_machine_changes_nothing(bench, rubbing):
    """What a search may do is counted in steps of the model, on however many threads."""
    spent = []
    for jobs in (1, 2):
        ready = prepared([rubbing], bench, jobs)
        effort = ready.problem.rollouts.effort
        patience = Patience(2.0, effort)
        begun = ready.problem.empty.joined(COULOMB, {'torque': 0.08})
        everyone_ = [COULOMB, GAIN]
        Search(ready.problem, everyone_, jobs, begun=begun, patience=patience).run()
        spent.append(effort.seconds)
    assert spent[0] > 0.0
    assert spent[0] == spent[1]


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
