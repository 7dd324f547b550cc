"""
What the nodes achieve over DDS: rate held, jitter, CPU, latency from measurement to estimate.

Starts simulator and estimator as processes of their own, listens as a third one and matches
stamps. ``python -m bench.nodes [SECONDS]`` prints the figures as JSON.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
import random
import subprocess
import sys
import time
from typing import Any

#: ticks of the kernel's clock for CPU time in a second
_TICKS = os.sysconf('SC_CLK_TCK')


def measure(seconds: float = 20.0, rate: float = 500.0) -> dict[str, Any]:
    """
    Run simulator and estimator and watch them.

    :param seconds: how long to watch, after both have started [s].
    :param rate: of the simulator [Hz].
    :return: figures by name, with units in the names.
    """
    os.environ['ROS_DOMAIN_ID'] = str(random.randrange(1, 100))
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    python = [sys.executable, '-m']
    nodes = {
        'simulator': [*python, 'tendon_ros.nodes.simulator', '--rate', str(float(rate))],
        'estimator': [*python, 'tendon_ros.nodes.estimator'],
    }
    running = {name: subprocess.Popen(command) for name, command in nodes.items()}
    try:
        return _watch({name: process.pid for name, process in running.items()}, seconds)
    finally:
        for process in running.values():
            process.terminate()
        for process in running.values():
            process.wait(10)


def _watch(pids: dict[str, int], seconds: float) -> dict[str, Any]:
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.serialization import deserialize_message
    from std_msgs.msg import Header

    rclpy.init()
    node = rclpy.create_node('bench')
    arrivals: dict[str, dict[int, int]] = {'measured': {}, 'estimated': {}}

    def note(what: str, cdr: bytes) -> None:
        now = time.time_ns()
        stamp = deserialize_message(cdr, Header).stamp
        arrivals[what][stamp.sec * 10**9 + stamp.nanosec] = now

    from geometry_msgs.msg import WrenchStamped
    from sensor_msgs.msg import JointState

    node.create_subscription(
        JointState, '/instrument/actuator/measured_js',
        lambda cdr: note('measured', cdr), 1000, raw=True,
    )  # fmt: skip
    node.create_subscription(
        WrenchStamped, '/instrument/body/measured_cf',
        lambda cdr: note('estimated', cdr), 1000, raw=True,
    )  # fmt: skip
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        _spin(executor, lambda: len(arrivals['estimated']) > 200, 120.0)
        for seen in arrivals.values():
            seen.clear()
        before, begin = {name: _cpu(pid) for name, pid in pids.items()}, time.monotonic()
        _spin(executor, lambda: False, seconds)
        passed = time.monotonic() - begin
        cpu = {name: (_cpu(pid) - before[name]) / passed for name, pid in pids.items()}
    finally:
        node.destroy_node()
        rclpy.shutdown()
    return _figures(arrivals['measured'], arrivals['estimated'], cpu, passed)


def _spin(executor: Any, done: Any, seconds: float) -> None:
    end = time.monotonic() + seconds
    while not done() and time.monotonic() < end:
        executor.spin_once(timeout_sec=0.1)


def _cpu(pid: int) -> float:
    """Return the CPU time that a process has used [s]."""
    fields = Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def _figures(
    measured: dict[int, int], estimated: dict[int, int], cpu: dict[str, float], seconds: float
) -> dict[str, Any]:
    import numpy as np

    stamps = np.array(sorted(measured))
    came = np.array([measured[s] for s in stamps.tolist()])
    gaps = np.diff(came) * 1e-6
    nominal = float(np.median(np.diff(stamps))) * 1e-6
    both = sorted(measured.keys() & estimated.keys())
    late = np.array([estimated[s] - measured[s] for s in both]) * 1e-6
    age = np.array([estimated[s] - s for s in both]) * 1e-6
    return {
        'watched [s]': round(seconds, 2),
        'rate held [Hz]': round((len(stamps) - 1) / (came[-1] - came[0]) * 1e9, 3),
        'span of stamps [s]': round(float(stamps[-1] - stamps[0]) * 1e-9, 3),
        'longest interval [ms]': round(float(gaps.max()), 2),
        'missing stamps': int(np.sum(np.round(np.diff(stamps) * 1e-6 / nominal) - 1)),
        'interval jitter p50 [ms]': round(float(np.percentile(np.abs(gaps - nominal), 50)), 4),
        'interval jitter p99 [ms]': round(float(np.percentile(np.abs(gaps - nominal), 99)), 4),
        'estimates for measurements [%]': round(100.0 * len(both) / max(len(stamps), 1), 2),
        'measurement to estimate p50 [ms]': round(float(np.percentile(late, 50)), 4),
        'measurement to estimate p99 [ms]': round(float(np.percentile(late, 99)), 4),
        'stamp to estimate p50 [ms]': round(float(np.percentile(age, 50)), 4),
        'stamp to estimate p99 [ms]': round(float(np.percentile(age, 99)), 4),
        **{f'CPU of {name} [% of a core]': round(100.0 * used, 1) for name, used in cpu.items()},
    }


if __name__ == '__main__':
    print(json.dumps(measure(*map(float, sys.argv[1:2])), indent=2))
