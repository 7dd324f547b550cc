"""``tendon record``: run the recorder node."""

from __future__ import annotations

import argparse
import subprocess
import sys

HELP = 'record a live instrument to a bag until Ctrl-C or for --duration; needs ROS 2'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments of the verb.

    :param parser: the verb's own parser.
    """
    parser.add_argument('--out', metavar='BAG', help='the bag to write; it must not exist')
    parser.add_argument(
        '--duration', metavar='SECONDS', type=float, help='stop so long after the first message'
    )
    parser.add_argument('--topics', metavar='LIST', help='more topics to record, by commas')
    parser.add_argument(
        '--storage', choices=('mcap', 'sqlite3'), help='storage of the bag (default mcap)'
    )
    parser.add_argument(
        '--namespace', metavar='NS', help='of the instrument (default /instrument)'
    )


def run(args: argparse.Namespace) -> None:
    """
    Run the node and leave with its exit status.

    :param args: the parsed arguments.
    """
    command = [sys.executable, '-m', 'tendon_ros.nodes.recorder']
    for name in ('out', 'duration', 'topics', 'storage'):
        value = getattr(args, name)
        if value is not None:
            command += [f'--{name}', str(value)]
    if args.namespace is not None:
        command += ['--ros-args', '-r', f'__ns:=/{args.namespace.strip("/")}']
    # A node of its own process: Ctrl-C reaches it directly, and it closes the bag itself.
    process = subprocess.Popen(command)
    while True:
        try:
            sys.exit(process.wait())
        except KeyboardInterrupt:
            continue
