"""Large effects whose small difference imitates another one are no causes."""

from dataclasses import replace
import math
from types import SimpleNamespace

import numpy as np
import pytest

from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose.belief import belief
from tendon_ros.diagnose.cancelling import absorbed, conspiring, undoing, undone
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import IDLE
from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.valleys import started
from tendon_ros.identify.candidate import Candidate

WAVE = np.sin(np.linspace(0.0, 20.0, 400))
OTHER = np.cos(np.linspace(0.0, 31.0, 400))


@pytest.mark.parametrize(
    ('changes', 'rows'),
    [
        ([WAVE, OTHER], ()),
        ([WAVE, WAVE], ()),
        # one takes back a fifth of the other
        ([WAVE, -0.2 * WAVE], ()),
        ([WAVE, 1.5 * OTHER - WAVE], ()),
        ([WAVE, 0.2 * OTHER - WAVE], (0, 1)),
        ([10.0 * OTHER, WAVE, 0.2 * OTHER - WAVE], (1, 2)),
        # three of which no two undo each other alone
        ([WAVE, OTHER, -WAVE - OTHER], (0, 1, 2)),
        ([np.zeros(400), WAVE, 0.1 * OTHER - WAVE], (1, 2)),
        ([np.zeros(400), np.zeros(400)], ()),
    ],
)
def test_little_stays_of_what_is_undone(changes, rows):
    assert undone([np.array(changes)], [math.inf]) == set(rows)


@pytest.mark.parametrize(
    ('shrinks', 'stays', 'rows'),
    [
        # a softer contact gives back what an offset presses, and the two explain to the last bit
        (0.35, 1e-6, set()),
        (0.35, 1e-4, {0, 1}),
        # less is made up by two that are not so far apart, and next to nothing of that stays
        (0.5, 1e-4, set()),
        (0.5, 1e-3, {0, 1}),
        # what is hardly there at all is no proof of anything
        (0.2, 1e-6, {0, 1}),
    ],
)
def test_opposed_causes_that_leave_nothing_are_believed(shrinks, stays, rows):
    changes = np.array([100.0 * WAVE, shrinks * 100.0 * OTHER - 100.0 * WAVE])
    left = stays * float(np.sum(changes**2))
    assert undone([changes], [left]) == rows
    # nor does it matter what others leave of a channel that these two do nothing to
    elsewhere = [changes, np.zeros((2, 400))], [left, 1e6 * left]
    assert undone(*elsewhere) == rows
    # but by guessed numbers all channels hang together
    assert undone(*elsewhere, tied=True) == {0, 1}


@pytest.mark.parametrize(
    ('channels', 'rows'),
    [
        # a cell whose gain is imitated by all that pushes it and by the gain of the motor
        (
            [[9 * WAVE, 9 * OTHER, -9 * WAVE - 9 * OTHER], [9 * WAVE, 9 * OTHER, 0 * WAVE]],
            (0, 1, 2),
        ),
        # tied by one channel after the other
        (
            [
                [9 * WAVE, -9 * WAVE, 0 * WAVE, 40 * OTHER],
                [0 * WAVE, 9 * OTHER, -9 * OTHER, 0 * WAVE],
            ],
            (0, 1, 2),
        ),
        # two may meet by chance, and so may what noise hides
        ([[9 * WAVE, -9 * WAVE, 9 * OTHER]], ()),
        ([[0.3 * WAVE, 0.3 * OTHER, -0.3 * WAVE - 0.3 * OTHER]], ()),
        ([[9 * WAVE, 9 * OTHER, -6 * WAVE - 6 * OTHER]], ()),
        ([], ()),
    ],
)
def test_nothing_is_left_of_those_that_conspire(channels, rows):
    assert conspiring([np.array(changes) for changes in channels]) == set(rows)


@pytest.mark.parametrize(
    ('second', 'which'),
    [
        # a cable that slips gives an offset's tension back, but before it did the offset was alone
        (Candidate('cable_slip', 'cable_12'), set()),
        (Candidate('pretension', 'cable_12'), {0, 1}),
    ],
)
def test_what_happens_at_a_time_undoes_nothing_that_lasts(monkeypatch, second, which):
    causes = (Candidate('encoder_offset', 'encoder_L'), second)
    changes = [WAVE, 0.2 * OTHER - WAVE]
    monkeypatch.setattr('tendon_ros.diagnose.cancelling.change', lambda _p, _s, k: changes[k])
    assert undoing(*made_up(causes)) == which


@pytest.mark.parametrize(('guessed', 'which'), [(False, {0, 1}), (True, set())])
def test_what_a_guess_does_as_well_is_no_opposition(monkeypatch, guessed, which):
    # friction asks for more torque and a limit for less; the unknown torque constant does both
    causes = (Candidate('coulomb_friction', 'pulley_M'), Candidate('torque_bias', 'motor_M'))
    changes = [WAVE + 0.3 * OTHER, 0.1 * OTHER - WAVE]
    monkeypatch.setattr('tendon_ros.diagnose.cancelling.change', lambda _p, _s, k: changes[k])
    problem, state = made_up(causes)
    problem.tolerances = (SimpleNamespace(guessed=guessed),)
    problem.prior = lambda _model: np.zeros(1)
    state.slope = WAVE[:, None]
    assert undoing(problem, state) == which


def test_those_whose_rest_alone_is_opposed_do_not_undo_each_other(monkeypatch):
    # both are mostly what an unknown torque constant does as well
    causes = (Candidate('torque_saturation', 'motor_M'), Candidate('joint_spring', 'pulley_M'))
    changes = [WAVE + 0.2 * OTHER, WAVE - 0.2 * OTHER]
    monkeypatch.setattr('tendon_ros.diagnose.cancelling.change', lambda _p, _s, k: changes[k])
    problem, state = made_up(causes)
    problem.tolerances = (SimpleNamespace(guessed=True),)
    problem.prior = lambda _model: np.zeros(1)
    state.slope = WAVE[:, None]
    assert undoing(problem, state) == set()


@pytest.mark.parametrize(('doubt', 'which'), [(1.0, {0, 1}), (10.0, set())])
def test_what_is_large_where_it_is_doubted_is_not_undone(monkeypatch, doubt, which):
    # two frictions are opposed before the tip touches, and not where both do most
    causes = (Candidate('coulomb_friction', 'pulley_1'), Candidate('coulomb_friction', 'pulley_3'))
    late = np.arange(len(WAVE)) >= 380
    changes = [WAVE, np.where(late, OTHER, 0.2 * OTHER - WAVE)]
    monkeypatch.setattr('tendon_ros.diagnose.cancelling.change', lambda _p, _s, k: changes[k])
    problem, state = made_up(causes)
    problem.doubted = np.where(late, doubt**2, 1.0)
    assert undoing(problem, state) == which


def made_up(causes):
    """Return a problem without tolerances, and a state with some causes."""
    state = SimpleNamespace(
        model=SimpleNamespace(causes=causes), left=WAVE, slope=np.zeros((len(WAVE), 0))
    )
    problem = SimpleNamespace(
        channels=lambda: {'torque': np.ones(len(WAVE), dtype=np.bool_)},
        structured_by_channel=lambda left: {'torque': (float(left @ left), len(left))},
        tolerances=(),
        prior=lambda _model: np.zeros(0),
        doubted=np.ones(len(WAVE)),
    )
    return problem, state


@pytest.fixture(scope='module')
def imitated(bench, measured_on):
    """Return a search that ended with two friction torques and two torques that nearly cancel."""
    run = measured_on(bench, ('coulomb_friction', 'pulley_3', {'torque': 0.1}))
    ready = prepared([run], bench)
    problem = ready.problem
    model = problem.empty.joined(Candidate('coulomb_friction', 'pulley_3'), {'torque': 0.1})
    model = model.joined(Candidate('torque_bias', 'motor_L'), {'torque': 0.4})
    model = model.joined(Candidate('gravity', 'pulley_L'), {'torque': 0.4, 'phase': -np.pi / 2.0})
    final = problem.fitted(model, rounds=0)
    every = range(final.slope.shape[1])
    final = replace(final, slope=problem.slope(final.model, final.left, every))
    without = [problem.fitted(model.without(k), rounds=0) for k in range(3)]
    start = problem.fitted(problem.empty)
    return ready, Found(states=[start, final], rivals=[[], [], []], without=without)


def test_causes_that_undo_each_other_are_not_named(imitated):
    ready, found = imitated
    assert undoing(ready.problem, found.final) == {1, 2}
    judged = belief(ready, found)
    friction, *others = judged.weighed
    assert friction.chance >= NAMED
    assert [w.chance <= IDLE for w in others] == [True, True]
    assert set(judged.named) == {0}
    assert not judged.companies


def test_what_stays_is_what_the_others_leave_without_them(imitated):
    ready, found = imitated
    hidden = ready.problem.fitted(found.final.model.without(1, 2), rounds=6, accuracy=1e-2)
    channels = ready.problem.structured_by_channel(hidden.left).values()
    means = [power / count for power, count in channels]
    for weighed in belief(ready, found).weighed:
        assert min(means) < weighed.signs.left < max(means)
        assert weighed.signs.left < 0.1 * ready.problem.structured(found.final.left)


@pytest.mark.parametrize(
    ('own', 'guessed', 'moved', 'missed', 'rows'),
    [
        (0.05, True, -0.2, 0.05, {0}),
        (0.05, False, -0.2, 0.05, set()),
        (0.3, True, -0.2, 0.3, set()),
        (1.0, True, -0.2, 1.0, set()),
        # a number that could do it, and has not gone where it undoes it
        (0.05, True, 0.2, 0.05, set()),
        (0.05, True, 0.0, 0.05, set()),
        # it could by its slope, and a fit without the cause shows that it cannot
        (0.05, True, -0.2, 0.5, set()),
    ],
)
def test_what_guesses_do_as_well_is_undone_by_them(own, guessed, moved, missed, rows):
    gain = Candidate('encoder_gain', 'encoder_M')
    model = SimpleNamespace(causes=(gain,))
    problem = SimpleNamespace(
        tolerances=(SimpleNamespace(guessed=guessed),),
        prior=lambda _model: np.array([0.0, 1e-3]),
        pack=lambda _model: np.array([0.7, moved]),
    )
    # the gain does what the number does, and a part of its own
    slope = np.column_stack([WAVE + own * OTHER, 5.0 * WAVE])
    state = SimpleNamespace(model=model, slope=slope, left=0.0 * WAVE)
    without = SimpleNamespace(left=0.7 * missed * OTHER)
    assert absorbed(problem, state, [without]) == rows


def test_an_encoder_is_no_cause_where_only_the_bend_of_a_weight_tells_of_it():
    # a spring that grows with the third power, and a gain of three would bend the weight as much
    case = made(607, 36, Settings(bench='arm', channels=('motor',)))
    assert [e['effect'] for e in case.label['effects']] == ['unknown_cubic_spring']
    ready = prepared(list(case.recordings.values()), case.instrument)
    gain = Candidate('encoder_gain', 'encoder_M')
    steps = Steps(ready.problem, [gain], 1, lambda *_: None)
    start = started(steps)
    state = steps.settled(start.model.joined(gain, {'gain': 2.0}))
    assert state.cost < start.cost - 0.3 * len(start.left)
    found = Found([start, state], [[]], [start])
    assert absorbed(ready.problem, state, [start]) == {0}
    assert belief(ready, found).weighed[0].chance < NAMED
