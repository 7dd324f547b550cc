"""Who has stood meets again only the rivals that came near, and those that were replaced."""

import pytest

from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.found import best_of, Found
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.screening import Screen

COULOMB = Candidate('coulomb_friction', 'pulley_3')
WRONG = Candidate('viscous_friction', 'pulley_3')
DAMPED = Candidate('viscous_friction', 'pulley_L')
FAR = Candidate('torque_bias', 'motor_M')


class Asked(Steps):
    """Steps that note whom they are asked to screen."""

    def __init__(self, problem, candidates):
        super().__init__(problem, candidates, 1, lambda *_: None)
        self.among = []

    def screened(self, screen, leave=(), among=None):
        self.among.append((leave, among))
        return super().screened(screen, leave, among)


def test_who_takes_a_place_meets_who_had_it_and_not_everybody(bench, measured_on):
    run = measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': 0.05}),
        ('viscous_friction', 'pulley_L', {'damping': 0.6}),
    )
    problem = prepared([run], bench).problem
    begun = problem.empty.joined(DAMPED, {'damping': 0.6}).joined(WRONG, {'damping': 0.1})
    found = Found()
    found.states += [problem.fitted(problem.empty), problem.fitted(begun)]
    steps = Asked(problem, [COULOMB, WRONG, DAMPED, FAR])
    Challenge(steps, {}).of(found)
    assert set(found.final.model.causes) == {COULOMB, DAMPED}
    asked = [among for leave, among in steps.among if leave == [WRONG]]
    assert asked == [None]  # everybody, the first time
    [again] = [among for leave, among in steps.among if leave == [COULOMB]]
    assert WRONG in again
    assert FAR not in again


@pytest.mark.parametrize(('elsewhere', 'stays'), [(COULOMB, COULOMB), (WRONG, WRONG)])
def test_who_foretells_worse_takes_no_place(bench, measured_on, elsewhere, stays):
    """What was held out has another friction than what is fitted: there it has the last word."""
    sizes = {COULOMB: {'torque': 0.05}, WRONG: {'damping': 0.1}}

    def rubbing(which):
        run = measured_on(bench, (which.effect, which.place, sizes[which]))
        return prepared([run], bench).problem

    problem = rubbing(COULOMB)
    found = Found()
    wrong = problem.empty.joined(WRONG, sizes[WRONG])
    found.states += [problem.fitted(problem.empty), problem.fitted(wrong)]
    steps = Steps(problem, [COULOMB, WRONG], 1, lambda *_: None)
    found.proposals = best_of(steps.screened(Screen(problem, found.start)))
    Challenge(steps, {}, rubbing(elsewhere)).of(found)
    assert found.final.model.causes == (stays,)


def test_a_brief_challenge_finds_who_is_far_better_with_fewer_fits(bench, measured_on):
    run = measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.05}))
    problem = prepared([run], bench).problem
    candidates = everyone(bench, sorted(run.channels))
    fitted = {}
    for brief in (False, True):
        found = Found()
        wrong = problem.empty.joined(WRONG, {'damping': 0.1})
        found.states += [problem.fitted(problem.empty), problem.fitted(wrong)]
        steps = Steps(problem, candidates, 1, lambda *_: None)
        found.proposals = best_of(steps.screened(Screen(problem, found.start)))
        Challenge(steps, {}).of(found, brief=brief)
        assert found.final.model.causes == (COULOMB,)
        fitted[brief] = len(found.rivals[0])
    assert fitted[True] < fitted[False]


class Once:
    """Patience that has run out after the first question."""

    def __init__(self):
        self.asked = 0

    @property
    def over(self):
        self.asked += 1
        return self.asked > 1


@pytest.mark.parametrize('turned', [False, True])
def test_where_time_is_short_what_is_missed_most_is_challenged(bench, measured_on, turned):
    much, little = {'torque': 0.2}, {'torque': 0.04}
    run = measured_on(
        bench, ('coulomb_friction', 'pulley_3', much), ('coulomb_friction', 'pulley_L', little)
    )
    problem = prepared([run], bench).problem
    small = Candidate('coulomb_friction', 'pulley_L')
    both = [(COULOMB, much), (small, little)]
    model = problem.empty
    for cause, values in reversed(both) if turned else both:
        model = model.joined(cause, values)
    found = Found()
    found.states += [problem.fitted(problem.empty), problem.fitted(model)]
    steps = Steps(problem, [COULOMB, small, FAR], 1, lambda *_: None, Once())
    Challenge(steps, {}).of(found, brief=True)
    assert found.unmet == [small]


BIASED = Candidate('torque_bias', 'motor_L')


@pytest.mark.parametrize(
    ('there', 'causes'),
    [
        # after a reversal friction builds up about the bias
        (
            [
                ('presliding_friction', 'pulley_L', {'torque': 0.2, 'angle': 2e-3}),
                ('torque_bias', 'motor_L', {'torque': 0.15}),
            ],
            {Candidate('coulomb_friction', 'pulley_L'), BIASED},
        ),
        (
            [('asymmetric_friction', 'pulley_L', {'forward': 0.05, 'backward': 0.35})],
            {Candidate('asymmetric_friction', 'pulley_L')},
        ),
    ],
)
def test_friction_that_differs_by_direction_is_told_from_a_bias(bench, measured_on, there, causes):
    problem = prepared([measured_on(bench, *there)], bench).problem
    wrong = Candidate('asymmetric_friction', 'pulley_L')
    begun = problem.empty.joined(wrong, {'forward': 0.05, 'backward': 0.35})
    found = Found()
    found.states += [problem.fitted(problem.empty), problem.fitted(begun)]
    friction = Candidate('coulomb_friction', 'pulley_L')
    steps = Steps(problem, [friction, wrong, BIASED], 1, lambda *_: None)
    Challenge(steps, {}).of(found)
    assert set(found.final.model.causes) == causes


def test_who_is_dropped_at_once_has_not_taken_the_place(bench, measured_on, monkeypatch):
    run = measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.05}))
    problem = prepared([run], bench).problem
    start = problem.fitted(problem.empty)
    state = problem.fitted(problem.empty.joined(COULOMB, {'torque': 0.05}))
    found = Found(states=[start, state])
    steps = Steps(problem, [COULOMB, WRONG], 1, lambda *_: None)
    challenge = Challenge(steps, {})
    better = problem.fitted(problem.empty.joined(WRONG, {'damping': 0.1}))
    monkeypatch.setattr(challenge, '_better', lambda *_: better)
    monkeypatch.setattr(steps, 'pruned', lambda *_: start)
    challenge.of(found)
    assert found.final.model.causes == (COULOMB,)
    assert found.final.cost < 1.01 * state.cost
