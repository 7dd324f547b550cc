"""Processes that work on cases do not outlive the one that started them."""

from pathlib import Path
import signal
import subprocess
import sys
import time

import pytest

MAIN = """
import os
from pathlib import Path
import signal
import time

from tendon_ros.blind.store import each


def told(path):
    Path(path).write_text(str(os.getpid()), encoding='utf-8')
    time.sleep(600.0)


if __name__ == '__main__':
    # what a shell runs in the background ignores Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)
    each(told, [(name,) for name in '0123'], 2, None)
"""


def alive(process):
    """Return whether a process runs; one that nobody has waited for does not."""
    try:
        said = Path(f'/proc/{process}/stat').read_text(encoding='utf-8')
    except OSError:
        return False
    return said.rsplit(')', 1)[1].split()[0] != 'Z'


def until(happens, seconds=60.0):
    """Return whether something happens in time."""
    end = time.monotonic() + seconds
    while not happens() and time.monotonic() < end:
        time.sleep(0.05)
    return happens()


@pytest.mark.skipif(not Path('/proc/self').is_dir(), reason='asks the system who is alive')
@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_who_is_stopped_takes_its_workers_along(number, tmp_path):
    script = tmp_path / 'main.py'
    script.write_text(MAIN, encoding='utf-8')
    with subprocess.Popen([sys.executable, str(script)], cwd=tmp_path) as run:
        files = [tmp_path / name for name in '01']
        assert until(lambda: all(f.is_file() and f.read_text() for f in files))
        workers = [int(f.read_text()) for f in files]
        assert all(alive(w) for w in workers)
        run.send_signal(number)
        try:
            run.wait(60.0)
        finally:
            run.kill()
    assert until(lambda: not any(alive(w) for w in workers))
    assert not (tmp_path / '2').exists()
