"""``monitor``: does the model still say what is measured, and if not, where and why."""

from __future__ import annotations

from collections.abc import Sequence
import sys

from tendon_ros.nodes.launcher import Program, start
from tendon_ros.nodes.settings import INSTRUMENT, Setting

PROGRAM = Program(
    name='monitor',
    help='Compare measurement and model as they stream, and warn when the gap grows.',
    settings=(
        INSTRUMENT,
        Setting('window', 6.0, 'length of the motion that is compared', 's', 1.0, 60.0),
        Setting(
            'warm_up',
            2.0,
            'first part of a window that does not count: how friction was left before it is not '
            'known',
            's',
            0.3,
            30.0,
        ),
        Setting('period', 1.0, 'from one comparison to the next', 's', 0.2, 60.0),
        Setting(
            'warn_ratio',
            2.0,
            'times what is explained, or times the noise where that is more, a gap may reach',
            '',
            1.0,
            100.0,
        ),
        Setting(
            'learn',
            10.0,
            'motion that teaches what gap is explained; 0 for the noise alone',
            's',
            0.0,
            3600.0,
        ),
        Setting(
            'diagnosis',
            '',
            'diagnosis.json whose gap after its effects is what is explained, in place '
            'of learning',
        ),
        Setting('screen_period', 10.0, 'from one search for causes to the next', 's', 1.0, 3600.0),
    ),
    made_by='monitor_node:MonitorNode',
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
