"""``recorder``: everything that is said about an instrument, as it was sent, into a bag."""

from __future__ import annotations

from collections.abc import Sequence
import sys

from tendon_ros.nodes.launcher import Program, start
from tendon_ros.nodes.settings import Setting

PROGRAM = Program(
    name='recorder',
    help='Record the topics of an instrument to a bag; SIGINT and SIGTERM close it.',
    settings=(
        Setting('out', '', 'folder of the bag, which must not exist; empty for the time of day'),
        Setting(
            'duration',
            0.0,
            'close the bag after so long; 0 records until told to stop',
            's',
            0.0,
            1e7,
        ),
        Setting(
            'topics',
            '',
            'more topics to record, by commas, besides those of the contract; relative ones '
            'belong to the instrument',
        ),
        Setting('storage', 'mcap', 'storage of the bag', choices=('mcap', 'sqlite3')),
        Setting('compress', True, 'compress an MCAP'),
    ),
    made_by='recorder_node:RecorderNode',
    events=False,  # that executor gives no message infos, which is where losses are seen
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
