"""Stamps that scatter about an even sampling, and readings that do or do not."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intake.stamps import as_sampled, even_times, followed
from tendon_ros.model.instrument_file import load_instrument

COUNT = 1e-5


def swing(time):
    return 0.4 * np.sin(5.0 * time) + 0.2 * np.sin(11.0 * time)


@pytest.fixture(scope='module')
def body():
    return load_instrument('single_body')


@pytest.fixture(scope='module')
def run(body, measured_on):
    """Return a recording of which the angle is read at known times."""
    return measured_on(body)


def stamped(run, stamps, read):
    """Return a recording of three channels: stamps of all, and when the encoder was read."""
    angle = np.round(swing(read) / COUNT) * COUNT
    channels = {
        name: replace(run[name], time=stamps, value=value)
        for name, value in (
            ('actuator/pulley_body/position', angle),
            ('actuator/pulley_body/effort', np.cos(read)),
        )
    }
    return replace(run, channels=channels)


@pytest.fixture(scope='module')
def times():
    rng = np.random.default_rng(8)
    even = 3.0 + 0.002 * np.arange(3000)
    kept = rng.uniform(size=3000) > 0.01  # one in a hundred is lost
    return even[kept], (even + rng.uniform(0.0, 2e-4, 3000))[kept]


def test_readings_that_were_on_time_are_taken_for_it(body, run, times):
    even, late = times
    [mended], [said] = as_sampled([stamped(run, late, even)], body)
    for channel in mended.channels.values():
        off = channel.time - even
        assert np.ptp(off) < 2e-5
    assert 'scatter by' in said
    assert 'encoder_body' in said
    assert 'sampled evenly' in said


def test_readings_that_were_late_keep_their_stamps(body, run, times):
    _, late = times
    given = stamped(run, late, late)
    [kept], said = as_sampled([given], body)
    assert said == []
    assert kept is given


def test_what_is_even_or_stands_still_is_left_alone(body, run, times):
    even, late = times
    assert even_times(even) is None
    assert even_times(late[:50]) is None
    still = stamped(run, late, np.full_like(late, 2.0))
    assert as_sampled([still], body) == ((still,), [])


def test_a_pause_ends_at_any_time():
    rng = np.random.default_rng(2)
    first = 0.001 * np.arange(500)
    second = first[-1] + 0.4375 + first
    late = np.concatenate([first, second]) + rng.uniform(0.0, 5e-5, 1000)
    even = even_times(late)
    assert np.std(np.diff(even)[:499]) < 1e-9
    assert abs(even[500] - even[499] - 0.4375) < 2e-5
    # a beat that wanders is none
    assert even_times(np.cumsum(rng.uniform(0.5e-3, 1.5e-3, 3000))) is None


def test_how_far_readings_follow_is_known_where_something_moves(times):
    even, late = times
    for part in (0.0, 0.3, 1.0):
        value = swing(even + part * (late - even))
        follows, known = followed(late, even, [(Channel('a', late, value), COUNT)])
        assert follows == pytest.approx(part, abs=0.06)
        assert known < 0.08
    assert followed(late, even, [(Channel('a', late, 0.0 * late), COUNT)])[1] == np.inf


def test_an_intake_has_even_stamps_and_says_so(body, run, times):
    even, late = times
    intake = admitted([stamped(run, late, even)], body)
    [mended] = intake.recordings
    assert np.ptp(mended['actuator/pulley_body/position'].time - even) < 2e-5
    assert any('sampled evenly' in text for text in intake.left_out)


def test_what_is_the_same_of_several_recordings_is_said_once(body, run, times):
    even, late = times
    several = [replace(stamped(run, late, even), name=name) for name in ('a', 'b', 'c')]
    _, [said] = as_sampled(several, body)
    assert said.startswith('a, b, c: stamps scatter by 0.06 ms about an even 2 ms')
