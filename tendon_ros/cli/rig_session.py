"""
Run the rig as users do: simulator, estimator, recorder and trajectory as processes over DDS.

Nothing of ROS is imported here; the nodes are started by their module names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, ExitStack
import os
from pathlib import Path
import random
import shutil
import signal
import subprocess
import sys
import time

from tendon_ros.bags.place import check_bag_output
from tendon_ros.base.errors import SimulationError

#: a first start may compile for some twenty seconds on each of two cores, slow ones included [s]
PATIENCE = 300.0


class _Process:
    """A node with its log."""

    def __init__(self, name: str, arguments: Sequence[str], folder: Path) -> None:
        self.name = name
        self.log = folder / f'{name}.log'
        environment = {
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
            **os.environ,
            'PYTHONUNBUFFERED': '1',
        }
        self._file = self.log.open('w', encoding='utf-8')
        self.process = subprocess.Popen(
            [sys.executable, '-m', f'tendon_ros.nodes.{name}', *arguments],
            stdout=self._file,
            stderr=subprocess.STDOUT,
            env=environment,
        )

    def wait_for(self, words: str) -> None:
        """Return when the log says these words; raise where the node ends before."""
        end = time.monotonic() + PATIENCE
        while words not in self.log.read_text(encoding='utf-8'):
            if self.process.poll() is not None or time.monotonic() > end:
                self.fail('did not start')
            time.sleep(0.1)

    def fail(self, what: str) -> None:
        """Raise with the last line of the log."""
        lines = self.log.read_text(encoding='utf-8').strip().splitlines() or ['nothing logged']
        raise SimulationError(f'{self.name}: {what}: {lines[-1]} (log: {self.log})')

    def stop(self) -> None:
        """End the node, and wait until it has closed what it has open."""
        if self.process.poll() is None:
            # not SIGINT, which a shell lets what it runs in the background ignore
            self.process.terminate()
            try:
                self.process.wait(20.0)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self._file.close()


def record_rig(
    folder: Path, instrument: str, method: str, progress: Callable[[float], None], span: float
) -> Path:
    """
    Run the paper's trajectory on a simulated rig and record all topics.

    :param folder: for bag and logs; those of an earlier run in it are replaced, and nothing else.
    :param instrument: file or name.
    :param method: of the estimator.
    :param progress: called with the part that is done, 0 to 1.
    :param span: expected duration of the trajectory [s], for the progress alone.
    :return: the bag.
    :raises OutputError: where something is in place of the bag that is none.
    :raises SimulationError: where a node does not start or fails; names its log.
    :raises KeyboardInterrupt: on SIGTERM as on Ctrl-C, once the nodes have ended.
    """
    bag = folder / 'rig_bag'
    check_bag_output(bag, overwrite=True)
    if bag.exists():
        shutil.rmtree(bag)
    folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault('ROS_DOMAIN_ID', str(random.SystemRandom().randint(1, 100)))
    names = ('recorder', 'estimator', 'simulator')
    arguments = {
        'recorder': ['--out', str(bag)],
        'estimator': ['--instrument', instrument, '--method', method],
        'simulator': ['--instrument', instrument, '--seed', '1'],
        'trajectory': ['--instrument', instrument, '--trajectory', 'paper_fig12'],
    }
    namespace = ['--ros-args', '-r', '__ns:=/instrument']
    with _interrupted_by_sigterm(), ExitStack() as running:
        for name in names:
            node = _Process(name, [*arguments[name], *namespace], folder)
            running.callback(node.stop)
            node.wait_for('recording' if name == 'recorder' else 'ready after')
        drive = _Process('trajectory', [*arguments['trajectory'], *namespace], folder)
        running.callback(drive.stop)
        begun = time.monotonic()
        while drive.process.poll() is None:
            passed = time.monotonic() - begun
            progress(min(0.99, passed / span))
            if passed > PATIENCE:
                drive.fail('does not end')
            time.sleep(0.2)
        if drive.process.returncode != 0:
            drive.fail('failed')
        time.sleep(1.0)  # let the last measurements come through
    progress(1.0)
    return bag


@contextmanager
def _interrupted_by_sigterm() -> Iterator[None]:
    """Let SIGTERM do what Ctrl-C does: by itself it ends this process alone, not its nodes."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
