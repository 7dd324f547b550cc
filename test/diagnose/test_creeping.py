"""Where friction holds, a pulley stands where chance has it: there bins may count less."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose import creeping, search_passes
from tendon_ros.diagnose.creeping import beside_chance, left_to_chance
from tendon_ros.diagnose.form import creep_profile, form_profile
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.sticking import sticking

RUBS = Candidate('coulomb_friction', 'pulley_3')
GAIN = Candidate('torque_gain', 'motor_M')
SAID = 'looking again: where friction holds, much of what stays is chance'


@pytest.fixture(scope='module')
def pressed(bench, measured_on):
    """Return a way to a recording in contact, with holds in which so much friction of 3 holds."""
    return lambda torque: measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': torque}),
        trajectory='paper_fig12',
        settings=(),
        touching=True,
    )


@pytest.fixture(scope='module')
def rubbing(pressed):
    """Return one with much friction."""
    return pressed(0.3)


@pytest.fixture(scope='module')
def holding(bench, rubbing):
    """Return that recording made ready."""
    return prepared([rubbing], bench)


def fits(problem, *causes):
    """Return the file's fit, and one with causes, with its derivatives."""
    model = problem.empty
    for cause, values in causes:
        model = model.joined(cause, values)
    start = problem.fitted(problem.empty, rounds=0)
    return start, problem.fitted(model, rounds=1)


def test_only_friction_creeps_and_only_where_it_holds(holding):
    problem = holding.problem
    start, state = fits(problem, (RUBS, {'torque': 0.3}))
    crept = creep_profile(problem, start, state)
    [held] = sticking(problem, state)
    assert 0.1 < np.mean(held) < 0.9
    assert np.max(crept[held]) > 1.0
    assert not crept[~held].any()
    start, state = fits(problem, (GAIN, {'gain': 1.1}))
    assert not creep_profile(problem, start, state).any()


def test_a_bin_counts_the_less_the_more_laws_may_get_wrong_of_it(holding):
    problem = holding.whole
    start, state = fits(problem, (RUBS, {'torque': 0.3}))
    allowing = holding.allowing(start.model, state.model)
    state = problem.centred(problem.fitted(state.model, rounds=0))
    wrong = form_profile(problem, start, state)
    whole = allowing.whole
    assert np.allclose(whole.doubted, 1.0 + wrong)
    left = problem.left(state.model)
    assert np.allclose(whole.left(state.model), left / np.sqrt(whole.doubted))
    # noise is what it was, and so is what was held out
    for was, now in zip(problem.rollouts.segments, whole.rollouts.segments, strict=True):
        for a, b in zip(was.measured, now.measured, strict=True):
            assert np.array_equal(a.noise, b.noise)
    assert [m.tolist() for m in allowing.held.masks] == [m.tolist() for m in holding.held.masks]
    # without a cause nothing changes
    same = holding.allowing(start.model, start.model).whole
    assert np.all(same.doubted == 1.0)


@pytest.mark.parametrize(
    ('there', 'off', 'looks_again'),
    [
        (True, 4.0, True),
        # where friction turns, it is no chance
        (False, 4.0, False),
        # its law may be wrong by as much
        (True, 1.2, False),
    ],
)
def test_much_that_stays_where_friction_holds_asks_for_another_look(
    holding, monkeypatch, there, off, looks_again
):
    said, doubted = [], []

    class Searching:
        """Ends with the friction, and leaves something where it holds, or where it turns."""

        def __init__(self, problem: Problem, *_):
            self.problem = problem
            doubted.append(float(np.max(problem.doubted)))

        def run(self):
            start, state = fits(self.problem, (RUBS, {'torque': 0.3}))
            [held] = sticking(self.problem, state)
            left = np.where(held == there, off, 0.0)
            return Found(states=[start, replace(state, left=left)])

    monkeypatch.setattr(search_passes, 'Search', Searching)
    search_passes.Looks(
        holding, [RUBS], 1, lambda what, _done: said.append(what), None, Patience(600.0)
    ).taken()
    assert (SAID in said) is looks_again
    assert doubted[0] == 1.0
    assert (max(doubted) > 2.0) is looks_again


def test_where_holds_leave_little_sizes_are_what_they_were(bench, pressed):
    ready = prepared([pressed(0.1)], bench)
    start, right = fits(ready.problem, (RUBS, {'torque': 0.1}))
    assert beside_chance(ready, start.model, right) == (ready, right)


def test_sizes_are_fitted_beside_what_holds_leave_to_chance(bench, rubbing, holding):
    """What a hold is off by chance moves a size, unless it is doubted."""
    start, right = fits(holding.problem, (RUBS, {'torque': 0.3}))
    cell = rubbing.channels['load_cell/force']
    once, again = (np.abs(cell.time - about) < 0.75 for about in (3.75, 8.75))
    elsewhere = Channel(cell.name, cell.time, cell.value + 1.0 * once - 1.0 * again)
    ready = prepared([rubbing.with_channels([elsewhere])], bench)
    problem = ready.problem
    plain = problem.fitted(right.model)
    assert left_to_chance(problem, problem.fitted(start.model, rounds=0), plain)
    doubting, careful = beside_chance(ready, start.model, plain)
    assert np.any(doubting.problem.doubted > 1.0)
    off, less = (abs(fit.model.values(0)['torque'] - 0.3) for fit in (plain, careful))
    assert less < 0.5 * off


def test_sizes_stay_where_doubts_foretell_no_more(holding, monkeypatch):
    start, right = fits(holding.problem, (RUBS, {'torque': 0.3}))
    monkeypatch.setattr(creeping, 'left_to_chance', lambda *_: True)
    monkeypatch.setattr(creeping, 'foretells', lambda *_: False)
    assert beside_chance(holding, start.model, right) == (holding, right)
    monkeypatch.setattr(creeping, 'foretells', lambda *_: True)
    doubting, careful = beside_chance(holding, start.model, right)
    # within what its law may be wrong by
    assert careful.model.values(0)['torque'] == pytest.approx(0.3, rel=0.06)
    assert np.any(doubting.problem.doubted > 1.0)


def test_only_what_rubs_is_left_to_chance(holding, monkeypatch):
    start, gained = fits(holding.problem, (GAIN, {'gain': 1.1}))
    monkeypatch.setattr(creeping, 'left_to_chance', lambda *_: True)
    assert beside_chance(holding, start.model, gained) == (holding, gained)
