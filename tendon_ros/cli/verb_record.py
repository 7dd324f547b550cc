"""``tendon record``: run the recorder node."""

from __future__ import annotations

import argparse
import os
import sys
from typing import NoReturn

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


def run(args: argparse.Namespace) -> NoReturn:
    """
    Become the node.

    :param args: the parsed arguments.
    """
    command = [sys.executable, '-m', 'tendon_ros.nodes.recorder']
    for name in ('out', 'duration', 'topics', 'storage'):
        value = getattr(args, name)
        if value is not None:
            command += [f'--{name}', str(value)]
    if args.namespace is not None:
        command += ['--ros-args', '-r', f'__ns:=/{args.namespace.strip("/")}']
    # In place, not as a child: whatever is sent to this process the node hears, which then closes
    # the bag, and nothing stays behind that goes on to record.
    os.execv(sys.executable, command)
