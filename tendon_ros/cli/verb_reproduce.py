"""``tendon reproduce``: the paper's figures and numbers from this model."""

from __future__ import annotations

import argparse
from pathlib import Path

HELP = "run the paper's experiments: figures, and a table of its numbers beside ours"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument(
        '--out',
        type=Path,
        required=True,
        metavar='DIR',
        help='folder for figures (PNG), table.csv, table.md and index.html',
    )


def run(args: argparse.Namespace) -> None:
    """
    Run the experiments, write the files, print the table.

    :param args: parsed arguments.
    :raises OutputError: where nothing can be written there.
    :raises ReportError: where a file cannot be written.
    """
    from tendon_ros.base.outputs import check_output
    from tendon_ros.cli.progress import shown
    from tendon_ros.report.paper_page import HEADER, reproduce, statement_table

    # what an earlier run has left there is replaced
    check_output(args.out / 'index.html', overwrite=True)
    with shown('the paper') as update:

        def progress(title: str, done: float) -> None:
            update(done)
            print(title, flush=True)

        statements = reproduce(args.out, progress)
    rows = statement_table(statements).rows
    # remarks are long; here only those that say why something does not hold, the rest is in files
    short = [HEADER[:-1], *(row[:-1] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*short, strict=True)]
    print()
    for line, statement in zip(short, (None, *statements), strict=True):
        cells = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        print('  '.join(cells).rstrip())
        if statement is not None and not statement.holds:
            print(f'{"":{widths[0]}}  {statement.note}')
    failed = sum(not s.holds for s in statements)
    print(f'\n{len(statements) - failed} statements hold, {failed} do not: {args.out}/index.html')
