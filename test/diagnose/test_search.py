"""A search that begins with what an earlier one found goes on from there."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose import search as searching
from tendon_ros.diagnose.asking import asked_again, TRACE
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.screening import Screen
from tendon_ros.model.instrument_file import load_instrument

COULOMB = Candidate('coulomb_friction', 'pulley_3')
GAIN = Candidate('torque_gain', 'motor_L')
WRONG = Candidate('torque_bias', 'motor_M')


@pytest.mark.parametrize(
    'earlier',
    [((COULOMB, {'torque': 0.08}),), ((COULOMB, {'torque': 0.05}), (WRONG, {'torque': 0.05}))],
)
def test_it_keeps_what_holds_and_finds_the_rest(bench, measured_on, earlier):
    run = measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': 0.1}),
        ('torque_gain', 'motor_L', {'gain': 1.1}),
    )
    problem = prepared([run], bench).problem
    begun = problem.empty
    for candidate, values in earlier:
        begun = begun.joined(candidate, {p.name: p.neutral for p in candidate.parameters} | values)
    said = []
    search = Search(
        problem, [COULOMB, GAIN, WRONG], 1, lambda what, _done: said.append(what), begun=begun
    )
    found = search.run()
    assert set(found.final.model.causes) == {COULOMB, GAIN}
    # the first round is the earlier search's
    assert 'looking for causes, round 1' not in said
    assert 'looking for causes, round 2' in said


STRIBECK = Candidate('stribeck_friction', 'pulley_3')


@pytest.mark.parametrize(
    ('effect', 'values'),
    [
        ('coulomb_friction', {'torque': 0.1}),
        # a third of it falls
        ('stribeck_friction', {'static': 0.1, 'sliding': 0.2, 'speed': 0.03}),
    ],
)
def test_friction_is_what_holds_the_other_or_is_held_by_it(bench, measured_on, effect, values):
    problem = prepared([measured_on(bench, (effect, 'pulley_3', values))], bench).problem
    found = Search(problem, [COULOMB, STRIBECK], 1).run()
    [cause] = found.final.model.causes
    assert cause.effect == effect
    assert found.final.model.values(0) == pytest.approx(values, rel=0.1)
    assert STRIBECK not in [rival.candidate for rival in found.rivals[0]]


def test_the_same_effect_elsewhere_is_no_worse_than_where_the_cause_would_lead(bench, measured_on):
    slips = [Candidate('cable_slip', f'cable_{name}') for name in ('m1', '12', 'L3')]
    true = {'jump': 4e-4, 'time': 1.6}
    motors_only = ('pulley/', 'load_cell')
    run = measured_on(bench, ('cable_slip', 'cable_12', true), touching=True, without=motors_only)
    problem = prepared([run], bench).problem
    found = Search(problem, slips, 1).run()
    [cause] = found.final.model.causes
    values = found.final.model.values(0)
    assert values['time'] == pytest.approx(1.6, abs=0.1)
    rivals = {rival.candidate: rival.fit for rival in found.rivals[0]}
    for other in set(slips) - {cause}:
        fit = problem.fitted(problem.empty.joined(other, values), rounds=20)
        # in time bins make the misfit a staircase, on which fits end a hundredth apart
        assert rivals[other].cost <= 1.02 * fit.cost


def test_a_late_sensor_is_asked_again_once_others_make_it_jump(measured_on):
    axis = load_instrument('driven_axis')
    run = measured_on(axis, settings=(('duration', '6 s'), ('amplitude', '40 deg')))
    problem = prepared([run], axis).problem
    late, heavy = Candidate('sensor_delay', 'torque_axis'), Candidate('inertia', 'pulley_axis')
    screen = Screen(problem, problem.fitted(problem.empty), {})
    # beside guesses of inertia and damping alone, late is another inertia
    silent = [replace(p, own=0.0) for c in (late, heavy) for p in screen.proposals(c)]
    assert len(silent) > 1
    assert asked_again([late, heavy], silent) == (late,)
    heard = [replace(p, own=1.1 * TRACE) for p in silent]
    assert asked_again([late, heavy], heard) == (late, heavy)


def test_what_a_challenge_drops_again_and_again_is_looked_for_once(
    bench, measured_on, monkeypatch
):
    run = measured_on(
        bench,
        ('coulomb_friction', 'pulley_3', {'torque': 0.1}),
        ('torque_gain', 'motor_L', {'gain': 1.1}),
    )
    problem = prepared([run], bench).problem
    begun = problem.empty.joined(COULOMB, {'torque': 0.1})
    said = []

    class Dropping:
        """Finds each time that the gain is not needed."""

        def __init__(self, *_):
            pass

        def of(self, found, *, brief):
            causes = found.final.model.causes
            if GAIN in causes:
                kept = found.final.model.without(causes.index(GAIN))
                found.states[-1] = problem.fitted(kept)
            found.without = [found.start] * len(found.final.model.causes)

    monkeypatch.setattr(searching, 'Challenge', Dropping)
    found = Search(
        problem, [COULOMB, GAIN], 1, lambda what, _done: said.append(what), begun=begun
    ).run()
    assert found.final.model.causes == (COULOMB,)
    assert 'looking for causes, round 2' in said
    assert 'looking for causes, round 4' not in said
