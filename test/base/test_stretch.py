"""Stretches: what is asked of a recording, and nothing else, on its own clock."""

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.base.stretch import Stretch, within


def recorded(name, begins=0.5, seconds=10.0):
    time = begins + np.arange(0.0, seconds, 0.1)
    late = time[time > begins + 6.0]
    channels = [Channel('a/x/position', time, 2.0 * time), Channel('a/y/position', late, 0 * late)]
    return Recording(name, {c.name: c for c in channels}, epoch_ns=7)


def cut(recordings, *texts):
    return within(recordings, [Stretch.parsed(text) for text in texts])


def test_nothing_asked_is_nothing_cut():
    whole = [recorded('one')]
    assert within(whole, []) == whole


def test_a_stretch_begins_its_own_clock():
    [found] = cut([recorded('one')], '2:4')
    channel = found['a/x/position']
    assert channel.time[0] == pytest.approx(0.0)
    assert channel.time[-1] == pytest.approx(1.9)
    assert channel.value[0] == pytest.approx(5.0)
    assert found.epoch_ns == 7 + 2_500_000_000
    assert found.name == 'one, 2 to 4 s'
    # what says nothing in that time is not there
    assert 'a/y/position' not in found


def test_two_stretches_leave_out_what_is_between():
    found = cut([recorded('one')], '7:', ':6')
    assert [r.name for r in found] == ['one, 0 to 6 s', 'one, 7 to 9.9 s']
    assert sum(len(r['a/x/position'].time) for r in found) == 90


def test_a_named_stretch_is_of_that_recording_alone():
    found = cut([recorded('one'), recorded('two'), recorded('three')], 'two=1:3', '0:5', 'two=4:')
    assert [r.name.partition(',')[0] for r in found] == ['one', 'two', 'two', 'three']
    assert cut([recorded('one'), recorded('two')], 'two=1:3')[0].name == 'one'


@pytest.mark.parametrize(
    ('texts', 'said'),
    [
        (['2'], 'FROM:TO'),
        (['4:2'], 'FROM:TO'),
        (['-1:2'], 'FROM:TO'),
        (['nan:2'], 'FROM:TO'),
        (['a:b'], 'FROM:TO'),
        (['=1:2'], 'FROM:TO'),
        (['two=1:2'], "no recording 'two'; there are one"),
        (['20:30'], 'lasts 9.9 s'),
        (['0:5', '4:8'], 'share seconds'),
    ],
)
def test_a_stretch_that_there_is_not_is_told(texts, said):
    with pytest.raises(RecordingError, match=said):
        cut([recorded('one')], *texts)
