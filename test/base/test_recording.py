"""Recordings as values."""

import pickle

import numpy as np

from tendon_ros.base.recording import Channel, Recording


def test_a_recording_travels_to_another_process_unchanged() -> None:
    time = np.array([0.0, 0.1, 0.3])
    channel = Channel('pulley/finger/position', time, np.sin(time))
    sent = Recording('one', {channel.name: channel}, 17, {'seed': '3'}, ('cut',))

    got = pickle.loads(pickle.dumps(sent))

    assert (got.name, got.epoch_ns, got.warnings) == ('one', 17, ('cut',))
    assert dict(got.metadata) == {'seed': '3'}
    arrived = got[channel.name]
    assert arrived.unit == 'rad'
    np.testing.assert_array_equal(arrived.time, time)
    np.testing.assert_array_equal(arrived.value, channel.value)
    assert not arrived.value.flags.writeable
