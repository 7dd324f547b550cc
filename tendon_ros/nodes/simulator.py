"""``simulator``: an instrument that lives on ROS topics as the real one would."""

from __future__ import annotations

from collections.abc import Sequence
import sys

from tendon_ros.nodes.launcher import Program, start
from tendon_ros.nodes.settings import ENGINE, INSTRUMENT, Setting

PROGRAM = Program(
    name='simulator',
    help='Simulate an instrument in real time: publish what its sensors measure, take commands.',
    settings=(
        INSTRUMENT,
        Setting('rate', 500.0, 'how often to publish', 'Hz', 1.0, 2000.0),
        Setting('seed', -1, "of the sensors' noise; -1 leaves all noise off", '', -1, 2**31 - 1),
        Setting('contact', True, 'whether the contacts of the instrument are in the way'),
        Setting('move_speed', 0.5, 'speed that move_jp reaches', 'rad/s', 1e-3, 100.0),
        ENGINE,
    ),
    made_by='simulator_node:SimulatorNode',
)


def main(argv: Sequence[str] | None = None) -> int:
    """
    Run the node.

    :param argv: arguments; None for those of the process.
    :return: the exit status.
    """
    return start(PROGRAM, argv)


if __name__ == '__main__':
    sys.exit(main())
