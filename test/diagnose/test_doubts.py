"""What makes a verdict itself doubtful."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.doubts import (
    absurd_words,
    brief_words,
    ended_words,
    lost_words,
    scaled_words,
    unheard_words,
    weak_words,
)
from tendon_ros.diagnose.evidence import Moved
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_body/effort'


def test_a_channel_that_no_recording_keeps_is_said_with_the_verdict(measured_on):
    body = load_instrument('single_body')
    run = measured_on(body)
    rest = {name: channel for name, channel in run.channels.items() if name != EFFORT}
    without = replace(run, channels=rest)
    [said] = unheard_words([run, run], [without, without], body)
    assert said.startswith(f'{EFFORT} could not be judged')
    # one recording tells enough, and what never came is missed by nobody
    assert not unheard_words([run, run], [run, without], body)
    assert not unheard_words([without], [without], body)


@pytest.mark.parametrize(('times', 'said'), [(100.0, True), (3.0, False)])
@pytest.mark.parametrize('found', [(), (Candidate('torque_gain', 'motor_body'), {'gain': 50.0})])
def test_far_less_torque_than_the_motion_takes_makes_one_doubt_a_column(
    measured_on, times, said, found
):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '6 s'), ('amplitude', '30 deg')))
    effort = run[EFFORT]
    ready = prepared([run.with_channels([replace(effort, value=effort.value / times)])], body)
    model = ready.problem.empty.joined(*found) if found else ready.problem.empty
    words = weak_words(ready, model)
    assert bool(words) is said
    assert all('times weaker' in one and EFFORT in one for one in words)


def test_a_weight_that_is_not_there_is_no_wrong_column(measured_on):
    """It is what the file has too much, and found as that."""
    body = load_instrument('single_body')
    weight = EffectUse('gravity', 'pulley_body', {'torque': 2.0, 'phase': 1.0})
    heavy = replace(body, effects=(weight,))
    ready = prepared([measured_on(body)], heavy)
    measured = [s.channel for s in heavy.sensors]
    [another] = [c for c in everyone(heavy, measured) if c.effect == 'gravity']
    empty = ready.problem.empty
    assert weak_words(ready, empty)
    assert not weak_words(ready, empty.joined(another, {'torque': 0.0, 'phase': 1.0}))


@pytest.mark.parametrize(('times', 'far'), [(1.0, False), (1.06, False), (57.3, True)])
def test_an_angle_in_degrees_is_no_encoder_that_is_off(measured_on, times, far):
    rig = load_instrument('bench_rig')
    inner = 'pulley/pulley_2/position'
    run = measured_on(rig)
    turned = replace(run[inner], value=times * run[inner].value)
    ready = prepared([run.with_channels([turned])], rig)
    model = ready.problem.empty
    assert bool(lost_words(ready, model)) is far
    assert all(said.startswith(f'{inner} varies by ') for said in lost_words(ready, model))
    # where a gain makes up for it, that gain is what cannot be
    found = model.joined(Candidate('encoder_gain', 'encoder_2'), {'gain': min(times, 5.0)})
    assert bool(scaled_words(found)) is far
    # but where another effect does as well, it rather is that one
    assert not scaled_words(found, found.causes)


@pytest.mark.parametrize(
    ('value', 'ci95', 'guessed', 'said'),
    [
        (0.04, (0.02, 0.14), True, True),
        (30.0, (20.0, 45.0), True, True),
        (0.04, (0.02, 0.14), False, False),
        (2.5, (2.0, 3.0), True, False),
        # what is hardly known may be anything
        (0.04, (0.001, 1.4), True, False),
    ],
)
def test_a_guess_that_is_far_off_makes_one_doubt_a_unit(value, ci95, guessed, said):
    one = Moved('pulley_body', 'inertia', value, ci95, '1', guessed)
    assert one.absurd == said
    assert len(absurd_words([one])) == said


@pytest.mark.parametrize(('knocks', 'told'), [((), []), ((4.0,), ['3.5']), ((2.2, 4.1, 6.3), [])])
def test_what_happened_once_is_said_where_most_of_what_stays_lies(
    measured_on, spoilt, knocks, told
):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '8 s'),))

    def knocked(time, torque):
        at = sum((np.exp(-(((time - t) / 0.02) ** 2)) for t in knocks), np.zeros(time.size))
        return time, torque + 2.0 * at

    ready = prepared(spoilt((run,), EFFORT, knocked), body)
    words = brief_words(ready, ready.whole.empty)
    assert [w.split(' lies between ')[1].split()[0] for w in words] == told


@pytest.mark.parametrize(('off', 'said'), [(0.0, False), (2.4, False), (2.97, True)])
def test_a_number_at_the_end_of_its_tolerance_is_said(off, said):
    moved = Moved('motor_drive', 'torque_gain', 0.915, (0.91, 0.92), '1', off=off)
    words = ended_words([moved])
    assert bool(words) is said
    assert all(w.startswith('the torque gain of motor_drive has moved to the end') for w in words)


def test_many_numbers_at_the_ends_of_their_tolerances_are_one_doubt():
    moved = [Moved(f'pulley_{n}', 'inertia', 1.09, (1.08, 1.1), '1', off=3.0) for n in range(1, 6)]
    (word,) = ended_words(moved)
    assert word.startswith('5 numbers of the file have moved to the ends of their tolerances')
    assert word.endswith('(inertia of pulley_1, inertia of pulley_2, inertia of pulley_3, '
                         'inertia of pulley_4, inertia of pulley_5)')  # fmt: skip
    assert len(ended_words(moved[:3])) == 3
