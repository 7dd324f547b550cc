"""Delays: what all sensors share is the clock's, and who alone has none is early."""

from dataclasses import replace

import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.clock import early, early_words, told_apart
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

TORQUE = 'actuator/pulley_body/effort'


def test_what_all_sensors_are_late_by_is_the_clock(measured_on):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '4 s'), ('amplitude', '30 deg')))
    problem = prepared([run], body).problem
    one = problem.empty.joined(Candidate('sensor_delay', 'encoder_body'), {'time': 0.012})
    assert told_apart(problem, one) is None
    both = one.joined(Candidate('sensor_delay', 'torque_body'), {'time': 0.008})
    apart = told_apart(problem, both)
    assert apart.causes == one.causes
    assert apart.values(0)['time'] == pytest.approx(0.004)


@pytest.mark.parametrize(
    ('filtered', 'left'), [(0.0, {0: 4.0}), (0.25, {0: 5.0, 1: 2.0}), (1.0, None)]
)
def test_what_a_filter_makes_late_is_no_clock(measured_on, filtered, left):
    body = load_instrument('single_body')
    run = measured_on(body, settings=(('duration', '4 s'), ('amplitude', '30 deg')))
    problem = prepared([run], body).problem
    smoothed = Candidate('sensor_delay', 'torque_body', opened=('filtered',))
    model = problem.empty
    for cause, more in (
        (Candidate('sensor_delay', 'encoder_body'), {'time': 0.011 if filtered else 0.012}),
        (smoothed, {'time': 0.008, 'filtered': filtered}),
    ):
        model = model.joined(cause, more)
    apart = told_apart(problem, model)
    if left is None:
        assert apart is None
        return
    found = {k: 1e3 * apart.values(k)['time'] for k in range(len(apart.causes))}
    assert found == pytest.approx(left)
    if filtered:
        assert apart.values(1)['filtered'] == 1.0


@pytest.fixture(scope='module')
def problem(bench, measured_on):
    return prepared([measured_on(bench)], bench).problem


def delayed(problem, **late):
    """Return a model whose sensors are late [ms], a spring beside them."""
    model = problem.empty.joined(
        Candidate('joint_spring', 'pulley_3'), {'stiffness': 0.1, 'rest': 0.0}
    )
    for sensor, time in late.items():
        model = model.joined(Candidate('sensor_delay', sensor), {'time': 1e-3 * time})
    return model


def test_who_alone_is_not_late_is_early(problem):
    others = {'encoder_M': 26.0, 'encoder_L': 26.3, 'torque_M': 25.0, 'load_cell': 25.7}
    others |= {f'encoder_{n}': 26.0 for n in (1, 2, 3)}
    found = early(problem, delayed(problem, **others))
    assert found.sensors == ('torque_L',)
    assert found.time == pytest.approx(0.026)
    assert found.late == frozenset(range(1, 8))
    assert 'all sensors but torque_L are late by 26 ms' in early_words(found)


@pytest.mark.parametrize(
    'changed',
    [
        {'torque_M': 14.0},  # that is no shared time
        {'torque_M': None, 'load_cell': None},  # all encoders, by one bus
        {'load_cell': None},  # two of several kinds
        {'encoder_M': None, 'encoder_L': None, 'encoder_1': None, 'encoder_2': None},  # too many
    ],
)
def test_others_that_are_late_are_late(problem, changed):
    late = dict.fromkeys(('encoder_M', 'encoder_L', 'torque_M', 'load_cell'), 26.0)
    late |= {f'encoder_{n}': 26.0 for n in (1, 2, 3)}
    late = {k: v for k, v in (late | changed).items() if v is not None}
    assert early(problem, delayed(problem, **late)) is None
    assert early(problem, delayed(problem)) is None


def test_what_a_logger_makes_late_is_used_and_not_named(measured_on):
    light = load_instrument('single_body')
    body = replace(light, pulleys=(replace(light.pulleys[0], inertia=0.05),))
    run = measured_on(
        body,
        ('coulomb_friction', 'pulley_body', {'torque': 0.3}),
        settings=(('duration', '12 s'), ('amplitude', '30 deg')),
    )
    # read a hundred times a second, the torque 4 ms after the angle
    polled = []
    for channel in run.channels.values():
        every = max(1, round(0.01 / channel.sampling))
        after = round(0.004 / channel.sampling) if channel.name == TORQUE else 0
        at = slice(4 * every, None, every)
        earlier = slice(4 * every - after, None, every)
        count = min(len(channel.time[at]), len(channel.value[earlier]))
        polled.append(
            Channel(channel.name, channel.time[at][:count], channel.value[earlier][:count])
        )
    late = replace(run, channels={c.name: c for c in polled})
    diagnosis = diagnose([late], body, plan=False).diagnosis
    assert [(c.effect, c.place) for c in diagnosis.causes] == [('coulomb_friction', 'pulley_body')]
    assert ('sensor_delay', 'torque_body') in [(c.effect, c.place) for c in diagnosis.beside]
    assert any('less than half of the time between samples' in note for note in diagnosis.left_out)
    assert diagnosis.verdict == 'explained'
