"""``estimator``: the operating force and the inner pulleys from what the motors measure."""

from __future__ import annotations

from collections.abc import Sequence
import sys

from tendon_ros.estimate import METHODS
from tendon_ros.nodes.launcher import Program, start
from tendon_ros.nodes.settings import ENGINE, INSTRUMENT, Setting

PROGRAM = Program(
    name='estimator',
    help='Estimate the operating force and the inner pulleys, a message for each measurement.',
    settings=(
        INSTRUMENT,
        Setting(
            'method',
            'contact_angle',
            '; '.join(f'{name}: {text}' for name, text in METHODS.items()),
            choices=tuple(METHODS),
        ),
        Setting(
            'channels',
            '',
            'for static_balance: channels to use instead of the motors, with commas between them, '
            'such as pulley/pulley_spindle/position,pulley/pulley_spindle/effort',
        ),
        Setting(
            'wander',
            0.0,
            'how far the force wanders in a second, in N or N m, where that is known (not for '
            'contact_angle); 0: nothing is known of it',
            low=0.0,
        ),
        ENGINE,
    ),
    made_by='estimator_node:EstimatorNode',
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
