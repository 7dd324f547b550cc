"""``tendon info``: what is in a bag."""

from __future__ import annotations

import argparse
import json

HELP = 'show topics, counts, rates, gaps and jitter of a bag'

#: metadata longer than this is cut in the table
SHOWN = 200


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('bag', metavar='BAG', help='folder, .mcap or .db3 file')
    parser.add_argument('--json', action='store_true', help='print JSON instead of a table')


def run(args: argparse.Namespace) -> None:
    """
    Print the summary.

    :param args: parsed arguments.
    """
    from rich.console import Console
    from rich.table import Table

    from tendon_ros.bags.info import summarise

    info = summarise(args.bag)
    if args.json:
        print(json.dumps(info.as_dict(), indent=2))
        return
    table = Table(box=None, pad_edge=False)
    table.add_column('topic', overflow='fold')
    table.add_column('type', overflow='fold')
    for name in ('count', 'Hz', 's', 'jitter p99 ms', 'gaps', 'longest s', 'back', 'repeated'):
        table.add_column(name, justify='right')
    for topic in info.topics:
        table.add_row(
            topic.name + ('' if topic.clock == 'header' else ' (log time)'),
            topic.msgtype.rsplit('/', 1)[-1],
            str(topic.count),
            _number(topic.rate, '.1f'),
            f'{topic.duration:.3f}',
            _number(topic.jitter_p99 and topic.jitter_p99 * 1e3, '.3f'),
            str(topic.gaps),
            _number(topic.longest_gap, '.4f'),
            str(topic.backward),
            str(topic.repeated),
        )
    print(
        f'{info.path}: {info.storage}, {info.size / 1e6:.2f} MB, {info.messages} messages, '
        f'{info.duration:.3f} s'
    )
    # A pipe has no width of its own: give it one that breaks no line.
    console = Console(soft_wrap=False, highlight=False)
    if not console.is_terminal:
        console = Console(width=200, highlight=False)
    console.print(table)
    for key, value in sorted(info.metadata.items()):
        text = ' '.join(value.split())
        short = f'{text[:SHOWN]} ... ({len(text)} characters; --json has all)'
        print(f'{key}: {text if len(text) <= SHOWN else short}')


def _number(value: float | None, form: str) -> str:
    return '-' if value is None else format(value, form)
