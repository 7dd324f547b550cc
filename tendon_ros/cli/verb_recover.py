"""``tendon recover``: a bag whose writer was killed."""

from __future__ import annotations

import argparse

HELP = 'make a readable bag of one whose writer was killed or that was cut off'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('bag', metavar='BAG', help='folder, .mcap or .db3 file; stays as it is')
    parser.add_argument('--out', required=True, metavar='BAG', help='the new bag')


def run(args: argparse.Namespace) -> None:
    """
    Recover, and say what was found.

    :param args: parsed arguments.
    """
    from tendon_ros.bags.recover import recover

    summary = recover(args.bag, args.out)
    state = 'its end is missing or damaged' if summary.damaged else 'nothing was missing'
    print(f'{summary.out}: {summary.messages} messages recovered; {state}')
    for topic, count in sorted(summary.counts.items()):
        print(f'  {count:8d} {topic}')
