"""
Play a recording to the estimator node: it should say what the batch says.

``python -m bench.played BAG --instrument FILE.yaml [--channels A,B] [--rate 50]`` publishes the
measurements of a bag over DDS with their own stamps, in their own time, to an estimator in a
process of its own, listens as a third one, and compares with ``estimate_recording``.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import os
import random
import subprocess
import sys
import time
from typing import Any

import numpy as np

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.topics import place_of
from tendon_ros.estimate import build_observer, estimate_recording, Measurement
from tendon_ros.estimate.offline import measurements
from tendon_ros.model.instrument_file import load_instrument

METHOD = 'static_balance'


def play(
    said: Sequence[Measurement], command: Sequence[str], patience: float = 120.0
) -> dict[int, tuple[float, float]]:
    """
    Publish measurements to a node and collect what it says.

    :param said: the measurements; channels of one topic go into one message.
    :param command: that starts the node.
    :param patience: until it is ready [s].
    :return: force [N] and torque [N m] of the estimated wrench by stamp [ns].
    """
    os.environ['ROS_DOMAIN_ID'] = str(random.randrange(1, 100))
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    from geometry_msgs.msg import WrenchStamped
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from sensor_msgs.msg import JointState

    rclpy.init()
    running = subprocess.Popen(command)
    node = rclpy.create_node('player')
    found: dict[int, tuple[float, float]] = {}

    def note(message: Any) -> None:
        stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        found[stamp] = message.wrench.force.y, message.wrench.torque.z

    heard = node.create_subscription(WrenchStamped, '/instrument/body/measured_cf', note, 1000)
    topics = sorted({place_of(name)[0] for name in said[0].values})
    senders = {t: node.create_publisher(JointState, f'/instrument/{t}', 500) for t in topics}
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        end = time.monotonic() + patience
        while not (
            heard.get_publisher_count()
            and all(s.get_subscription_count() for s in senders.values())
        ):
            executor.spin_once(timeout_sec=0.1)
            if time.monotonic() > end or running.poll() is not None:
                sys.exit('the estimator did not start')
        begun, first = time.monotonic(), said[0].stamp_ns
        for one in said:
            due = begun + 1e-9 * (one.stamp_ns - first)
            while (ahead := due - time.monotonic()) > 0.0:
                executor.spin_once(timeout_sec=min(ahead, 0.005))
            for topic, sender in senders.items():
                sender.publish(_message(JointState(), topic, one))
        end = time.monotonic() + 2.0
        while len(found) < len(said) and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.1)
    finally:
        node.destroy_node()
        rclpy.shutdown()
        running.terminate()
        running.wait(10)
    return found


def _message(message: Any, topic: str, one: Measurement) -> Any:
    """Fill a message with what a measurement says on a topic."""
    rows: dict[str, dict[str, float]] = {}
    for name, value in one.values.items():
        if place_of(name)[0] == topic:
            _, pulley, field = name.split('/')
            rows.setdefault(pulley, {})[field] = float(value)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(one.stamp_ns, 10**9)
    message.name = list(rows)
    for field in ('position', 'velocity', 'effort'):
        if all(field in row for row in rows.values()):
            setattr(message, field, [row[field] for row in rows.values()])
    return message


def main() -> None:
    """Play, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('bag')
    parser.add_argument('--instrument', required=True)
    parser.add_argument('--channels', default='', help='with commas; those of the method if none')
    parser.add_argument('--rate', type=float, default=50.0, help='of measurements [Hz]')
    args = parser.parse_args()
    instrument = load_instrument(args.instrument)
    channels = [c for c in args.channels.split(',') if c] or None
    recording = read_recording(args.bag)
    observer = build_observer(instrument, METHOD, channels=channels)
    said = list(measurements(recording, observer.needs, args.rate))
    batch = estimate_recording(recording, observer, rate=args.rate)
    [quantity] = {n for n in ('force', 'torque') if f'estimate/{n}' in batch}
    estimate = batch[f'estimate/{quantity}']
    command = [sys.executable, '-m', 'tendon_ros.nodes.estimator', '--instrument', args.instrument,
               '--method', METHOD, '--channels', ','.join(observer.needs)]  # fmt: skip
    found = play(said, command)
    stamps = [m.stamp_ns for m in said]
    live = np.array([found.get(s, (np.nan, np.nan))[quantity == 'torque'] for s in stamps])
    came = np.isfinite(live)
    print(f'{came.sum()} estimates for {len(said)} measurements')
    if not came.any():
        sys.exit('nothing to compare')
    off = np.abs(live - estimate.value)[came].max()
    print(f'largest difference from the batch {off:.3g}, of {np.ptp(estimate.value):.3g}')


if __name__ == '__main__':
    main()
