"""Nodes as processes of their own, and a client that talks to them over DDS."""

import os
import random
import signal
import subprocess
import sys
import threading
import time

import pytest

#: how long anything may take on a busy machine, a first compilation included [s]
LONG = 180.0


@pytest.fixture(scope='session')
def domain():
    """Give each process of the tests a network of its own, and make wrong field types an error."""
    pytest.importorskip('rclpy')
    worker = int(os.environ.get('PYTEST_XDIST_WORKER', 'gw0').removeprefix('gw'))
    wanted = {
        'ROS_DOMAIN_ID': str(10 * random.randrange(1, 10) + worker % 10),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'ROS_PYTHON_CHECK_FIELDS': '1',
    }
    with pytest.MonkeyPatch.context() as patch:
        for name, value in wanted.items():
            patch.setenv(name, value)
        yield wanted


class Started:
    """A node that runs, with what it says."""

    def __init__(self, module, arguments, cwd):
        command = [sys.executable, '-m', f'tendon_ros.nodes.{module}', *map(str, arguments)]
        self.process = subprocess.Popen(
            command, cwd=cwd, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        self.lines = []
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line)

    @property
    def said(self):
        return ''.join(self.lines)

    def wait_for(self, text, count=1, seconds=LONG):
        """Wait until a text was said so often."""
        end = time.monotonic() + seconds
        while self.said.count(text) < count:
            assert time.monotonic() < end, f'{text!r} was not said:\n{self.said}'
            assert self.process.poll() is None or self.said.count(text) >= count, self.said
            time.sleep(0.02)

    def stop(self, number=signal.SIGTERM):
        """Send a signal and return the exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        return self.result()

    def result(self, seconds=LONG):
        """Return the exit status."""
        try:
            return self.process.wait(seconds)
        finally:
            self.process.kill()
            self._thread.join()
            self.process.stdout.close()


@pytest.fixture(scope='session')
def launched(domain):
    """Return a function that starts a node; all are stopped in the end."""
    running = []

    def start(module, *arguments, cwd=None):
        running.append(Started(module, arguments, cwd))
        return running[-1]

    yield start
    for one in running:
        one.stop()


@pytest.fixture
def start(launched):
    """Return a function that starts a node; those of this test are stopped after it."""
    mine = []

    def start_one(module, *arguments, cwd=None):
        mine.append(launched(module, *arguments, cwd=cwd))
        return mine[-1]

    yield start_one
    for one in mine:
        one.stop()


class Client:
    """A node of the test: listens, publishes, calls."""

    def __init__(self):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self.context = rclpy.Context()
        self.context.init(domain_id=int(os.environ['ROS_DOMAIN_ID']))
        self.node = rclpy.create_node('test', context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self._going = True
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self):
        while self._going:
            self.executor.spin_once(timeout_sec=0.05)

    def hear(self, topic, kind):
        """Return a list that fills with the messages of a topic."""
        heard = []
        self.node.create_subscription(kind, topic, heard.append, 200)
        return heard

    def publisher(self, topic, kind, qos=10):
        """Return a publisher that somebody listens to."""
        made = self.node.create_publisher(kind, topic, qos)
        self.wait(lambda: made.get_subscription_count() > 0, f'nobody listens to {topic}')
        return made

    def wait(self, condition, why, seconds=LONG):
        """Wait until something is true."""
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, why
            time.sleep(0.005)

    def call(self, service, kind, request):
        """Return the answer of a service."""
        client = self.node.create_client(kind, service)
        self.wait(client.service_is_ready, f'{service} is not there')
        future = client.call_async(request)
        self.wait(future.done, f'{service} does not answer')
        return future.result()

    def close(self):
        self._going = False
        self._thread.join()
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.shutdown()


@pytest.fixture(scope='session')
def client(domain):
    """Return a client for the whole run."""
    made = Client()
    yield made
    made.close()


@pytest.fixture(scope='module')
def simulator(launched):
    """Return a running simulator that the tests of a file share; it ends with them."""
    one = launched('simulator')
    one.wait_for('ready after')
    yield one
    one.stop()
