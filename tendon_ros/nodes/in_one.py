"""
Simulator, estimator and trajectory in one process: ``python -m tendon_ros.nodes.in_one``.

The same nodes as in processes of their own, with the same topics; they share one executor.
"""

from __future__ import annotations

from collections.abc import Sequence
import sys

from tendon_ros.base.command_line import MISTAKE, Parser
from tendon_ros.base.errors import TendonError
from tendon_ros.nodes import estimator, simulator, trajectory
from tendon_ros.nodes.launcher import run, split_ros_arguments
from tendon_ros.nodes.settings import add_options, given_options

#: a thread that wakes must not wait for another one's turn to end, by default 5 ms [s]
TURN = 2e-4

PROGRAMS = (simulator.PROGRAM, estimator.PROGRAM, trajectory.PROGRAM)


def run_in_one(argv: Sequence[str] | None = None) -> int:
    """
    Run the three nodes until the trajectory is done or a signal comes.

    :param argv: arguments; None for those of the process.
    :return: the exit status.
    """
    own, ros = split_ros_arguments(sys.argv[1:] if argv is None else argv)
    parser = Parser(prog='in_one', description=__doc__)
    # An option that several nodes have goes to each of them; others belong to one.
    known = {one.name: one for program in PROGRAMS for one in program.settings}
    add_options(parser, known.values())
    args = parser.parse_args(own)
    sys.setswitchinterval(TURN)
    try:
        chosen = [(program, given_options(args, program.settings)) for program in PROGRAMS]
        return run(chosen, ros)
    except TendonError as error:
        sys.stderr.write(f'in_one: {" ".join(str(error).split())}\n')
        return MISTAKE


if __name__ == '__main__':
    sys.exit(run_in_one())
