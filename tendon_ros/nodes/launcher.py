"""
Start nodes: read the command line, bring ROS up, spin until told to stop, and leave cleanly.

SIGINT and SIGTERM only set a flag here, so that nothing is torn in the middle of a step or a
write; every node then closes what it has open, and the exit status is 0. The main thread does
nothing but wait for that flag, because Python runs signal handlers in no other thread.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
import os
import signal
import sys
import threading
from typing import Any

from tendon_ros import __version__
from tendon_ros.base.command_line import DONE, MISTAKE, Parser
from tendon_ros.base.errors import TendonError
from tendon_ros.nodes.settings import add_options, given_options, Setting, Value

#: how long nodes that are told to stop may go on to get ready [s]
GRACE = 1.0


@dataclass(frozen=True)
class Program:
    """
    A node that can be started.

    ``made_by`` is ``module:Class`` below :mod:`tendon_ros.nodes`; it is imported only when ROS is
    wanted. ``events``: whether it may run in the executor for events, which has no message infos.
    """

    name: str
    help: str
    settings: tuple[Setting, ...]
    made_by: str
    events: bool = True


def start(program: Program, argv: Sequence[str] | None = None) -> int:
    """
    Run one node in this process.

    :param program: the node.
    :param argv: arguments; None for those of the process.
    :return: the exit status.
    """
    own, ros = split_ros_arguments(sys.argv[1:] if argv is None else argv)
    parser = Parser(
        prog=program.name,
        description=program.help,
        epilog='Every option is also a ROS parameter; behind --ros-args stand what ROS takes: '
        '--params-file FILE, -p NAME:=VALUE, -r __ns:=/NAMESPACE.',
    )
    parser.add_argument('--version', action='version', version=f'tendon_ros {__version__}')
    add_options(parser, program.settings)
    try:
        args = parser.parse_args(own)
        return run([(program, given_options(args, program.settings))], ros)
    except TendonError as error:
        return _mistake(program.name, error)


def run(programs: Sequence[tuple[Program, Mapping[str, Value]]], ros: Sequence[str]) -> int:
    """
    Run nodes in this process until one has finished or a signal comes.

    :param programs: each node with the parameters that the command line sets.
    :param ros: arguments for ROS, beginning with ``--ros-args``; empty for none.
    :return: the exit status.
    :raises TendonError: where a node cannot start with what it was given.
    """
    try:
        import rclpy
        from rclpy.signals import SignalHandlerOptions
        from rclpy.utilities import try_shutdown
    except ImportError as error:
        raise TendonError(
            f'ROS 2 is not there ({error}); source its setup.bash, or pip install '
            "'ros-jazzy-rclpy[fastrtps]' ros-jazzy-common-interfaces with Python 3.12"
        ) from None
    stop, ready = threading.Event(), threading.Event()

    def on_signal(*_: object) -> None:
        stop.set()
        if not ready.is_set():
            # A kernel that is being compiled cannot be interrupted, and there is nothing to close.
            timer = threading.Timer(GRACE, lambda: ready.is_set() or os._exit(DONE))
            timer.daemon = True
            timer.start()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)
    try:
        rclpy.init(args=list(ros), signal_handler_options=SignalHandlerOptions.NO)
    except Exception as error:  # rclpy has no common base for what arguments can do to it
        raise TendonError(
            f'ROS does not take its arguments: {" ".join(str(error).split())}'
        ) from None
    nodes: list[Any] = []
    try:
        for program, given in programs:
            module, name = program.made_by.split(':')
            maker = getattr(import_module(f'tendon_ros.nodes.{module}'), name)
            nodes.append(maker(given))
        ready.set()
        return _spin(nodes, stop, events=all(program.events for program, _ in programs))
    finally:
        ready.set()
        for node in nodes:
            node.close()
        for node in nodes:
            node.destroy_node()
        try_shutdown()


def split_ros_arguments(argv: Sequence[str]) -> tuple[list[str], list[str]]:
    """
    Separate a node's own arguments from those of ROS.

    :param argv: ``OWN... --ros-args ROS... [-- OWN...]``.
    :return: own arguments, and those of ROS beginning with ``--ros-args``.
    """
    own: list[str] = []
    ros: list[str] = []
    target = own
    for word in argv:
        if word == '--ros-args':
            target = ros
        if word == '--' and target is ros:
            target = own
            continue
        target.append(word)
    return own, ros


def _spin(nodes: Sequence[Any], stop: threading.Event, *, events: bool) -> int:
    """Serve callbacks in a thread until a signal comes, a node has finished or one failed."""
    executor = _executor(events=events)
    for node in nodes:
        executor.add_node(node)
    failures: list[BaseException] = []

    def serve() -> None:
        try:
            while not stop.is_set():
                # A bounded wait: the untimed spin of the executor for events does not work.
                executor.spin_once(timeout_sec=0.1)
        except BaseException as error:
            failures.append(error)
            stop.set()

    thread = threading.Thread(target=serve, name='executor')
    for node in nodes:
        node.begin()
    thread.start()
    while not stop.wait(0.05):
        failures += [node.failure for node in nodes if node.failure is not None]
        if failures or any(node.finished for node in nodes):
            stop.set()
    thread.join()
    executor.shutdown()
    for failure in failures:
        raise failure
    return DONE


def _executor(*, events: bool) -> Any:
    """Return the executor that costs least: at 1 kHz the one for events takes half the CPU."""
    from rclpy.executors import SingleThreadedExecutor

    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor()
    return EventsExecutor() if events else SingleThreadedExecutor()


def _mistake(name: str, error: TendonError) -> int:
    sys.stderr.write(f'{name}: {" ".join(str(error).split())}\n')
    return MISTAKE
