"""Screening: what was put in is proposed first, with about its size."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.screening import Screen, Seen
from tendon_ros.identify.starting import Starting
from tendon_ros.model.instrument_file import load_instrument

#: what was put in, and what else it may be mistaken for before anything is fitted
INJECTED = [
    (('torque_gain', 'motor_L', {'gain': 0.9}), set()),
    (
        ('coulomb_friction', 'pulley_3', {'torque': 0.1}),
        {
            (f'{kind}_friction', 'pulley_3')
            for kind in ('tension', 'stribeck', 'asymmetric', 'presliding')
        },
    ),
    (('encoder_gain', 'encoder_2', {'gain': 1.03}), {('eccentricity', 'pulley_2')}),
    (('cable_slip', 'cable_12', {'jump': 2e-4, 'time': 3.0}), set()),
]


def screened(bench, run):
    problem = prepared([run], bench).problem
    screen = Screen(problem, problem.fitted(problem.empty))
    found = []
    for candidate in everyone(bench, sorted(run.channels)):
        found += [screen.corrected(p) for p in screen.proposals(candidate)[:1]]
    return sorted(found, key=lambda p: -p.gain)


@pytest.mark.parametrize(('effect', 'alike'), INJECTED, ids=[e[0][0] for e in INJECTED])
def test_what_was_put_in_comes_first(bench, measured_on, effect, alike):
    ranked = screened(bench, measured_on(bench, effect))
    first = [(p.candidate.effect, p.candidate.place) for p in ranked[:10]]
    assert effect[:2] in first
    assert first[0] in alike | {effect[:2]}
    own = next(p for p in ranked if (p.candidate.effect, p.candidate.place) == effect[:2])
    for name, value in effect[2].items():
        assert own.values[name] == pytest.approx(value, rel=0.3)


def test_a_limit_that_cuts_only_peaks_is_proposed_for_most_of_what_it_does(
    bench, sound_run, measured_on
):
    largest = np.abs(sound_run['actuator/pulley_L/effort'].value).max()
    limit = ('torque_saturation', 'motor_L', {'limit': 0.85 * largest, 'knee': 0.05})
    problem = prepared([measured_on(bench, limit)], bench).problem
    state = problem.fitted(problem.empty)
    candidate = Candidate(*limit[:2])
    limited = problem.fitted(problem.empty.joined(candidate, limit[2]), rounds=0)
    assert state.cost > 2.0 * limited.cost
    best = Screen(problem, state).proposals(candidate)[0]
    assert best.gain > 0.7 * (state.cost - limited.cost)


def test_a_size_of_nothing_changes_nothing(bench, sound_run):
    """A preload that would leave a cable slack may be the one that the fit has come to."""
    problem = prepared([sound_run], bench).problem
    screen = Screen(problem, problem.fitted(problem.empty))
    loose = screen.proposals(Candidate('pretension', 'cable_12'))[0]
    changes = screen._changes(replace(loose, z=loose.base), [0.0] * len(loose.sizes))
    assert changes is not None
    assert not changes.any()


def test_sound_data_propose_nothing_worth_much(bench, sound_run):
    ranked = screened(bench, sound_run)
    samples = 5000
    assert ranked[0].gain < 0.02 * samples


def test_what_leaves_no_trace_is_not_proposed(bench, measured_on):
    problem = prepared([measured_on(bench, without=('pulley/', 'load_cell'))], bench).problem
    screen = Screen(problem, problem.fitted(problem.empty))
    # nothing is touched, so the wall's stiffness does nothing
    assert screen.proposals(Candidate('contact_stiffness', 'contact')) == []


def test_what_was_seen_with_a_sign_tells_nothing_once_it_is_lost(bench, measured_on):
    """Half of the time a bias does the opposite of it."""
    bias = ('torque_bias', 'motor_L', {'torque': 0.1})
    lost = ('sensor_rectified', 'torque_L', {'rectified': 1.0})
    problem = prepared([measured_on(bench, bias, lost)], bench).problem
    seen: Seen = {}
    candidate = Candidate(*bias[:2])
    Screen(problem, problem.fitted(problem.empty, rounds=0), seen).proposals(candidate)
    signless = problem.empty.joined(Candidate(*lost[:2]), lost[2])
    [best] = Screen(problem, problem.fitted(signless, rounds=0), seen).proposals(candidate)
    assert best.values['torque'] == pytest.approx(0.1, rel=0.3)


def test_what_was_seen_of_a_late_torque_tells_nothing_once_more_is_known_to_act(
    bench, measured_on
):
    """By the file alone the torque that is late is another one."""
    late = ('sensor_delay', 'torque_L', {'time': 0.012})
    friction = ('coulomb_friction', 'pulley_L', {'torque': 0.3})
    problem = prepared([measured_on(bench, late, friction)], bench).problem
    candidate = Candidate(*late[:2])
    seen: Seen = {}
    Screen(problem, problem.fitted(problem.empty, rounds=0), seen).proposals(candidate)
    rubbing = problem.empty.joined(Candidate(*friction[:2]), friction[2])
    state = problem.fitted(rubbing, rounds=0)
    assert Screen(problem, state, seen).proposals(candidate) == Screen(problem, state).proposals(
        candidate
    )


def test_a_size_that_can_only_grow_is_not_made_smaller(bench, measured_on):
    rig_drives = ('coulomb_friction', 'pulley_3', {'torque': 0.1})
    run = measured_on(bench, rig_drives)
    # the file claims the friction that the machine has, twice over
    problem = prepared([run], bench).problem
    state = problem.fitted(
        problem.empty.joined(Candidate('coulomb_friction', 'pulley_3'), {'torque': 0.2}), rounds=0
    )
    for p in Screen(problem, state).proposals(Candidate('tension_friction', 'pulley_3')):
        assert p.values['coefficient'] >= 0.0


def test_a_preload_is_asked_about_where_it_leaves_a_cable_slack(measured_on):
    """With straight cables and no friction it leaves no trace before: no size is typical."""
    belt = load_instrument('two_motor_belt')
    known = {k: v for k, v in belt.tolerances.items() if not k.endswith('pretension')}
    belt = replace(belt, tolerances=known)
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    slack = ('pretension', 'cable_upper', {'scale': 0.08})
    run = measured_on(belt, slack, settings=settings)
    problem = prepared([run], belt).problem
    start = problem.fitted(problem.empty)
    candidate = Candidate('pretension', 'cable_upper')
    sizes = [values['scale'] for _, values in Starting(problem, start).of(candidate)]
    assert sizes[0] == 0.7
    assert len(sizes) > 1
    screen = Screen(problem, start)
    best = screen.proposals(candidate)[0]
    assert best.gain > 0.05 * start.cost
    # half of the way there nothing is slack: it is proposed as it was tried
    assert any(best.values['scale'] == pytest.approx(size) for size in sizes)
    assert best.values['scale'] < 0.65
    assert screen.corrected(best) == best
