"""A push that stands for something else leaves much, and the search begins again without it."""

import pytest

from tendon_ros.diagnose import search_passes
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.fit import Problem

SLIP = ('cable_slip', 'cable_L3', {'jump': 5e-4, 'time': 3.0})
PUSH = ('disturbance', 'pulley_2', {'torque': -0.5, 'start': 3.0, 'duration': 2.0})
SAID = 'looking again: without what was taken for an event'


@pytest.fixture(scope='module')
def slipped(bench, measured_on):
    """Return a recording in which a cable slipped, ready for a search."""
    run = measured_on(bench, SLIP, touching=True)
    return prepared([run], bench), everyone(bench, sorted(run.channels))


@pytest.mark.parametrize(
    ('first', 'second', 'ends', 'again'),
    [
        (PUSH, SLIP, SLIP, True),
        # no better without it
        (PUSH, None, PUSH, True),
        # nothing is left to ask for
        (SLIP, None, SLIP, False),
    ],
)
def test_a_push_that_leaves_much_is_done_without(slipped, monkeypatch, first, second, ends, again):
    ready, candidates = slipped
    said, asked = [], []

    class Searching:
        """Ends with one cause, with another one where it may not have it, or where it begins."""

        def __init__(self, problem: Problem, among, jobs, report, memory, begun, *_):
            self.problem, self.begun = problem, begun
            self.whole = len(among) == len(candidates)
            asked.append({(c.effect, c.place) for c in among})

        def run(self):
            model = self.problem.empty
            cause = first if self.whole else second
            if self.begun is not None:
                model = self.begun
            elif cause is not None:
                model = model.joined(Candidate(*cause[:2]), cause[2])
            fits = [self.problem.fitted(one) for one in (self.problem.begun, model)]
            return Found(states=fits)

    monkeypatch.setattr(search_passes, 'Search', Searching)
    _, found = search_passes.Looks(
        ready, candidates, 1, lambda what, _done: said.append(what), None, Patience(600.0)
    ).taken()
    assert [(c.effect, c.place) for c in found.final.model.causes] == [ends[:2]]
    assert (SAID in said) is again
    assert (asked[0] - asked[1] == {PUSH[:2]}) if again else len(asked) == 1
