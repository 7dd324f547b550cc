"""A verb that is told to end takes along every process that it started."""

import os
from pathlib import Path
import random
import signal
import subprocess
import sys
import time

import pytest

from tendon_ros.bags.reader import read_recording

pytest.importorskip('rclpy')

#: how long anything may take on a busy machine, a first compilation included [s]
LONG = 300.0


class Verb:
    """A verb that runs, with all processes that come of it."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [sys.executable, '-m', 'tendon_ros.cli.main', *map(str, arguments)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    @property
    def alive(self):
        """Return its processes that run; one that nobody has waited for does not."""
        found = []
        for path in Path('/proc').glob('[0-9]*/stat'):
            try:
                state, _, group = path.read_text().rsplit(')', 1)[1].split()[:3]
            except OSError:
                continue
            if int(group) == self.process.pid and state != 'Z':
                found.append(int(path.parent.name))
        return found

    def wait_for(self, file, words):
        """Wait until a file says something."""
        end = time.monotonic() + LONG
        while not (file.is_file() and words in file.read_text()):
            assert self.process.poll() is None, self.process.stderr.read()
            assert time.monotonic() < end, f'{file}: {words!r} was not said'
            time.sleep(0.05)


@pytest.fixture
def verb(monkeypatch):
    """Return a function that runs a verb in a network of its own; nothing is left of it."""
    if not Path('/proc/self').is_dir():
        pytest.skip('asks the system who is alive')
    monkeypatch.setenv('ROS_DOMAIN_ID', str(random.randrange(1, 100)))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    running = []

    def start(*arguments):
        running.append(Verb(*arguments))
        return running[-1]

    yield start
    for one in running:
        if one.alive:
            os.killpg(one.process.pid, signal.SIGKILL)
        one.process.wait()
        one.process.stderr.close()


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGINT])
def test_a_recorder_that_is_told_to_end_closes_its_bag(verb, tmp_path, number):
    one = verb('record', '--out', tmp_path / 'bag', '--namespace', 'nobody')
    end = time.monotonic() + LONG
    while 'recording /nobody' not in one.process.stderr.readline():
        assert time.monotonic() < end
    one.process.send_signal(number)
    assert one.process.wait(LONG) == 0
    assert one.alive == []
    assert 'messages on' in one.process.stderr.read()
    assert (tmp_path / 'bag' / 'metadata.yaml').is_file()


def test_a_demo_that_is_told_to_end_takes_its_nodes_along(verb, tmp_path):
    one = verb('demo', '--out', tmp_path)
    one.wait_for(tmp_path / 'live' / 'trajectory.log', 's, 1 times, at')
    assert len(one.alive) == 5
    one.process.terminate()
    assert one.process.wait(LONG) == 1
    assert one.alive == []
    assert one.process.stderr.read() == 'tendon: interrupted\n'
    assert read_recording(tmp_path / 'live' / 'rig_bag')['actuator/pulley_M/position'].time.size
