"""Channels that another recorder took are put on the motors' clock; what a force may do is not."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose.intake import admitted
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_L/effort'
WIDE = (('duration', '12 s'), ('amplitude', '6 deg'))


def moved(run, name, by):
    """Return a recording of which one channel's clock is ahead [s]."""
    return run.with_channels([Channel(name, run[name].time + by, run[name].value)])


@pytest.fixture(scope='module')
def bench_run(bench, measured_on):
    friction = ('coulomb_friction', 'pulley_L', {'torque': 0.05})
    return measured_on(bench, friction, settings=WIDE)


@pytest.mark.parametrize('by', [0.3, -0.4, 1.1])
def test_what_another_recorder_took_is_moved_and_said(bench, bench_run, by):
    intake = admitted([moved(bench_run, EFFORT, by)], bench)
    [run] = intake.recordings
    time = np.linspace(3.0, 9.0, 500)
    put_back, true = (one[EFFORT].at(time) for one in (run, bench_run))
    assert np.std(put_back - true) < 0.2 * np.std(true)
    [said] = [text for text in intake.left_out if 'another recorder' in text]
    assert said.startswith(f'free: {EFFORT} is {abs(by):.1f}'[:-1])
    assert ('late' if by > 0.0 else 'early') in said
    for name in run.channels.keys() - {EFFORT}:
        assert np.array_equal(run[name].at(time), bench_run[name].at(time))


@pytest.mark.parametrize('by', [0.0, 0.03])
def test_a_sensor_may_be_late(bench, bench_run, by):
    late = moved(bench_run, EFFORT, by)
    intake = admitted([late], bench)
    assert intake.recordings[0][EFFORT].time[0] == late[EFFORT].time[0]
    assert not any('recorder' in text for text in intake.left_out)


def test_one_tone_comes_again_and_tells_no_clock(measured_on):
    """Friction is a quarter of a period ahead of a weight, and so is a clock that is off."""
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.4})
    tone = (('duration', '10 s'), ('amplitude', '40 deg'), ('frequency', '0.7 Hz'))
    run = measured_on(body, friction, trajectory='sine', settings=tone)
    name = 'actuator/pulley_body/effort'
    for by in (0.0, 0.3):
        one = moved(run, name, by)
        [kept] = admitted([one], body).recordings
        assert kept[name].time[0] == one[name].time[0]


def test_a_push_is_no_other_clock(bench, measured_on):
    """Looked for at another place, it would be left behind, and the rest may fit by chance."""
    push = ('disturbance', 'pulley_L', {'torque': -0.8, 'start': 2.6, 'duration': 1.1})
    settings = (('duration', '14 s'), ('amplitude', '6 deg'), ('seed', '2'))
    run = measured_on(bench, push, settings=settings, without=('pulley/', 'load_cell', 'setpoint'))
    off = zip((1.8, 0.6, 1.5, 0.6, 1.7), (0.5, 1.8, 0.6, 1.9, 0.5), strict=True)
    guessed = tuple(
        replace(p, inertia=heavy * p.inertia, damping=viscous * p.damping)
        for p, (heavy, viscous) in zip(bench.pulleys, off, strict=True)
    )
    [kept] = admitted([run], replace(bench, pulleys=guessed)).recordings
    assert kept[EFFORT].time[0] == run[EFFORT].time[0]


def test_friction_of_an_inner_pulley_is_no_other_clock():
    """It turns round later than any motor does, by somewhat more than a sensor may be late."""
    case = made(662, 7, Settings(bench='guessed'))
    assert [e['effect'] for e in case.label['effects']] == ['coulomb_friction']
    intake = admitted([case.recordings['free']], case.instrument)
    assert not any('recorder' in text for text in intake.left_out)
