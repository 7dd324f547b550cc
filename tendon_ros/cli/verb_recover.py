"""``tendon recover``: a bag whose writer was killed."""

from __future__ import annotations

import argparse

HELP = 'make a readable bag of one whose writer was killed or that was cut off'

#: what is said of a bag that was damaged, of one that was not, and of one that does not tell
STATES = {
    True: 'its end is missing or damaged',
    False: 'nothing was missing',
    None: 'nothing in it is damaged, but nothing tells whether its end is there',
}


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
    print(f'{summary.out}: {summary.messages} messages recovered; {STATES[summary.damaged]}')
    for topic, count in sorted(summary.counts.items()):
        print(f'  {count:8d} {topic}')
