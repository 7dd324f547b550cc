"""A torque that lost its sign, on a body of which nothing is known."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose import search_passes
from tendon_ros.diagnose.asking import BELOW, lost, may_be_signless, signed
from tendon_ros.diagnose.beyond import beyond_laws
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.naming import judged
from tendon_ros.diagnose.patience import Patience
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.diagnose.session import diagnose
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.starting import Starting
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_axis/effort'
SIGN = Candidate('sensor_rectified', 'torque_axis')
SPRING = ('joint_spring', 'pulley_axis', {'stiffness': 0.5, 'rest': -0.1})
LOST = ('sensor_rectified', 'torque_axis', {'rectified': 1.0})
#: what takes long to ask of a whole case and is not in it
BESIDE = (
    'asymmetric_friction', 'backlash', 'cable_creep', 'disturbance', 'eccentricity',
    'presliding_friction', 'sensor_delay', 'torque_ripple', 'torque_saturation',
)  # fmt: skip


@pytest.fixture(scope='module')
def axis():
    return load_instrument('driven_axis')


@pytest.fixture(scope='module')
def recorded(axis, measured_on):
    """Return what records an axis of twice the inertia, with effects."""
    heavy = replace(axis, pulleys=tuple(replace(p, inertia=2.0 * p.inertia) for p in axis.pulleys))
    settings = (('duration', '8 s'), ('amplitude', '40 deg'))
    return lambda *effects: measured_on(heavy, *effects, settings=settings)


@pytest.mark.parametrize(('effects', 'told'), [((SPRING,), False), ((SPRING, LOST), True)])
def test_what_reads_below_zero_has_its_sign(axis, recorded, effects, told):
    problem = prepared([recorded(*effects)], axis).problem
    assert may_be_signless(problem, SIGN) is told
    assert not may_be_signless(problem, Candidate('joint_spring', 'pulley_axis'))


@pytest.mark.parametrize(('effects', 'seen'), [((SPRING,), True), ((SPRING, LOST), False)])
def test_a_sign_that_readings_show_is_not_lost(axis, recorded, effects, seen):
    problem = prepared([recorded(*effects)], axis).problem
    candidates = everyone(axis, [EFFORT])
    assert signed(problem, candidates) == [SIGN] * seen
    # the page says why it is none
    bare = Found(states=[problem.fitted(problem.empty)], rivals=[], without=[])
    rows = judged(bare, [], [], candidates, {}, (), signed(problem, candidates))
    [why] = [row.why_not for row in rows if row.effect == SIGN.effect]
    assert (why == 'its readings go below zero by more than noise') is seen


def test_what_noise_makes_negative_shows_no_sign(axis, measured_on):
    sensors = tuple(replace(s, noise=0.15) if s.channel == EFFORT else s for s in axis.sensors)
    loud = replace(axis, sensors=sensors)
    settings = (('duration', '8 s'), ('amplitude', '40 deg'))
    problem = prepared([measured_on(loud, SPRING, LOST, settings=settings)], loud).problem
    [read] = [m.value for m in problem.rollouts.segments[0].measured]
    assert np.nanmin(read) < -BELOW * np.ptp(read[np.isfinite(read)])
    assert signed(problem, everyone(loud, [EFFORT])) == []


def test_a_load_cell_may_be_biased_below_zero(bench, measured_on):
    low = ('load_cell_bias', 'load_cell', {'force': -1.0})
    run = measured_on(bench, low, touching=True)
    problem = prepared([run], bench).problem
    lone = [Candidate('sensor_rectified', 'load_cell')]
    assert signed(problem, lone) == lone
    assert signed(problem, [*lone, Candidate('load_cell_bias', 'load_cell')]) == []


def test_noise_about_zero_is_no_sign(axis, recorded):
    run = recorded(SPRING, LOST)
    effort = run[EFFORT]
    noisy = effort.value + 4e-3 * np.random.default_rng(2).standard_normal(effort.value.size)
    assert noisy.min() < 0.0
    problem = prepared([run.with_channels([Channel(EFFORT, effort.time, noisy)])], axis).problem
    assert may_be_signless(problem, SIGN)


def test_who_can_only_press_has_no_sign_to_lose(bench, measured_on):
    problem = prepared([measured_on(bench, touching=True)], bench).problem
    assert not may_be_signless(problem, Candidate('sensor_rectified', 'load_cell'))


def test_a_lost_sign_is_found_beside_a_spring(axis, recorded):
    run = recorded(SPRING, LOST)
    problem = prepared([run], axis).problem
    found = Search(problem, everyone(axis, sorted(run.channels)), 1).run()
    causes = found.final.model.causes
    assert {(c.effect, c.place) for c in causes} == {LOST[:2], SPRING[:2]}
    spring = found.final.model.values(next(k for k, c in enumerate(causes) if c != SIGN))
    # the torque constant is a guess, so that sizes are not told; the angle at rest is
    assert spring['rest'] == pytest.approx(-0.1, abs=0.01)


def test_a_ripple_has_its_period_beside_a_lost_sign(axis, recorded):
    ripple = ('torque_ripple', 'motor_axis', {'amplitude': 0.1, 'cycles': 24.0, 'phase': 0.3})
    problem = prepared([recorded(SPRING, ripple, LOST)], axis).problem
    state = problem.fitted(lost(problem.empty, SIGN).joined(Candidate(*SPRING[:2]), SPRING[2]))
    begun = Starting(problem, state).of(Candidate(*ripple[:2]))
    assert begun[0][1]['cycles'] == pytest.approx(24.0, abs=1.0)


@pytest.mark.parametrize(('right', 'again'), [(False, True), (True, False)])
def test_where_much_stays_the_search_begins_again_beside_the_lost_sign(
    axis, recorded, monkeypatch, right, again
):
    run = recorded(SPRING, LOST)
    ready = prepared([run], axis)
    said, begun_from = [], []

    class Searching:
        """Ends where it would have gone astray, unless it begins beside the sign."""

        def __init__(self, problem, candidates, jobs, report, memory, begun, *_):
            self.problem, self.begun = problem, begun
            begun_from.append(begun)

        def run(self):
            model = self.problem.empty
            if right or (self.begun is not None and SIGN in self.begun.causes):
                model = lost(model, SIGN).joined(Candidate(*SPRING[:2]), SPRING[2])
            else:
                model = model.joined(
                    Candidate('gravity', 'pulley_axis'), {'torque': 0.1, 'phase': 0.0}
                )
            fits = [self.problem.fitted(one) for one in (self.problem.begun, model)]
            return Found(states=fits)

    monkeypatch.setattr(search_passes, 'Search', Searching)
    candidates = everyone(axis, sorted(run.channels))
    _, found = search_passes.Looks(
        ready, candidates, 1, lambda what, _done: said.append(what), None, Patience(600.0)
    ).taken()
    assert SIGN in found.final.model.causes
    assert ('looking again: a sensor may have lost its sign' in said) is again
    assert begun_from[0] is None


def test_a_sign_that_nobody_needs_begins_no_search(axis, recorded, monkeypatch):
    # so weak that most of the torque is the inertia's: its sign cannot be made up
    run = recorded(('joint_spring', 'pulley_axis', {'stiffness': 0.1, 'rest': 0.0}))
    ready = prepared([run], axis)
    said = []

    class Searching:
        """Goes astray."""

        def __init__(self, problem, *_):
            self.problem = problem

        def run(self):
            wrong = Candidate('torque_ripple', 'motor_axis')
            model = self.problem.empty.joined(wrong, find(wrong.effect).typical)
            start = self.problem.fitted(self.problem.begun)
            return Found(states=[start, self.problem.fitted(model, rounds=0)])

    monkeypatch.setattr(search_passes, 'Search', Searching)
    monkeypatch.setattr(search_passes, 'signless', lambda *_: [SIGN])
    found = Searching(ready.problem).run()
    assert beyond_laws(ready.problem, found.start, found.final)
    search_passes.Looks(
        ready, [SIGN], 1, lambda what, _done: said.append(what), None, Patience()
    ).taken()
    assert 'looking again: a sensor may have lost its sign' not in said


def test_a_lost_sign_hides_no_friction_from_the_search():
    """Numbers that were fitted to a torque without sign say of no friction what it does."""
    settings = Settings(
        bench='arm', strata=('two_three', 'unknown', 'withheld'), channels=('motor',)
    )
    case = made(650, 3, settings)
    runs = [case.recordings[name] for name in ('fast', 'slow')]
    found = diagnose(runs, case.instrument, withhold=BESIDE, jobs=1, plan=False)
    told = {(c.effect, c.place) for c in found.diagnosis.causes}
    assert told == {(e['effect'], e['place']) for e in case.label['effects']}
    assert len(told) == 3


def test_a_sign_is_asked_beside_what_was_found_without_it(axis, recorded, monkeypatch):
    """Beside a constant torque next to nothing turns round, so that it is found first."""
    bias = ('torque_bias', 'motor_axis', {'torque': 0.1})
    run = recorded(bias, LOST)
    begun_from = []

    class Searching:
        """Finds the bias, and the sign only where it begins beside both."""

        def __init__(self, problem, candidates, jobs, report, memory, begun, *_):
            self.problem, self.begun = problem, begun
            begun_from.append(frozenset() if begun is None else frozenset(begun.causes))

        def run(self):
            model = self.problem.empty
            if self.begun is not None and len(self.begun.causes) == 2:
                model = lost(model, SIGN)
            model = model.joined(Candidate(*bias[:2]), bias[2])
            start = self.problem.fitted(self.problem.begun)
            # without its sign, guesses would go anywhere along with it
            return Found(states=[start, self.problem.fitted(model, rounds=0)])

    monkeypatch.setattr(search_passes, 'Search', Searching)
    _, found = search_passes.Looks(
        prepared([run], axis),
        everyone(axis, sorted(run.channels)),
        1,
        lambda *_: None,
        None,
        Patience(600.0),
    ).taken()
    assert set(found.final.model.causes) == {SIGN, Candidate(*bias[:2])}
    assert begun_from[-1] == set(found.final.model.causes)
