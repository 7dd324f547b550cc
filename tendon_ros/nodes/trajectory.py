"""``trajectory``: drive the motors along a named profile or a CSV file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import sys

from tendon_ros.model.trajectory_choice import profiles, settings
from tendon_ros.nodes.launcher import Program, start
from tendon_ros.nodes.settings import INSTRUMENT, Setting


def _profile_settings() -> Iterator[Setting]:
    """Yield the settings of every profile as ``<profile>.<setting>``; lists become texts."""
    for profile in profiles():
        for name, (default, sheet) in settings(profile).items():
            text = f'{profile}: {sheet.meaning}'
            if isinstance(default, tuple):
                joined = ','.join(str(part) for part in default)
                yield Setting(f'{profile}.{name}', joined, f'{text}, by commas', sheet.unit)
            else:
                yield Setting(
                    f'{profile}.{name}', default, text, sheet.unit, sheet.low, sheet.high
                )


PROGRAM = Program(
    name='trajectory',
    help='Drive the motors of an instrument along a named profile or a CSV file.',
    settings=(
        INSTRUMENT,
        Setting('trajectory', 'paper_fig12', f'CSV file, or one of {", ".join(profiles())}'),
        Setting('rate', 500.0, 'how often to command', 'Hz', 1.0, 2000.0),
        Setting('repeats', 1, 'how often to run it; 0 for ever', '', 0, 10**6),
        Setting(
            'approach',
            1.0,
            'time of the smooth way from where the motors are to the first point, longer where '
            'speed_limit asks for it; 0 for none',
            's',
            0.0,
            100.0,
        ),
        Setting('exit_when_done', True, 'leave with status 0 after the last point'),
        Setting(
            'patience',
            0.0,
            'give up with status 2 where nothing is measured, or nobody takes commands, for so '
            'long; 0 waits for ever',
            's',
            0.0,
            3600.0,
        ),
        *_profile_settings(),
    ),
    made_by='trajectory_node:TrajectoryNode',
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
