"""A recording that has a bit of everything, and a way to write messages as foreign drivers do."""

from contextlib import contextmanager
import resource

import numpy as np
import pytest

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.base.recording import Channel, Recording


@pytest.fixture
def recording():
    """Return half a second at 500 Hz, with joints that have different fields."""
    rng = np.random.default_rng(7)
    # whole nanoseconds, as a bag keeps them
    time = np.arange(250) * 2_000_003 / 1e9
    late = (np.arange(84) * 6_000_009 + 400_000) / 1e9

    def channel(name, stamps=time):
        return Channel(name, stamps, rng.normal(size=stamps.size))

    names = (
        'actuator/pulley_M/position',
        'actuator/pulley_M/effort',
        'actuator/pulley_L/position',
        'setpoint/pulley_M/position',
        'pulley/pulley_1/position',
        'pulley/pulley_1/velocity',
        'estimate/pulley_1/position',
        'estimate/force',
        'estimate/force_std',
    )
    channels = [channel(name) for name in names]
    channels.append(channel('load_cell/force', late))
    channels.append(channel('load_cell/torque', late))
    return Recording(
        'run',
        {c.name: c for c in channels},
        epoch_ns=1_700_000_000_123_456_789,
        metadata={'seed': '7', 'note': 'θ'},
    )


@pytest.fixture
def refused_beyond():
    """Return a context in which the system refuses files of more than so many bytes."""

    @contextmanager
    def limit(size):
        before, most = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (before, most))

    return limit


@pytest.fixture
def bag_of(tmp_path):
    """Return a function that writes serialised messages of the motors as a bag."""

    def write(messages, topic='/instrument/actuator/measured_js', name='bag'):
        path = tmp_path / name
        with BagWriter(path) as bag:
            bag.add_topic(topic, 'sensor_msgs/msg/JointState')
            for i, cdr in enumerate(messages):
                bag.write_raw(topic, cdr, 1_700_000_000_000_000_000 + i)
        return path

    return write
