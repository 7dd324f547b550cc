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
    :raises ReportError: where a file cannot be written.
    """
    from rich.console import Console
    from rich.table import Table

    from tendon_ros.cli.progress import shown
    from tendon_ros.report.paper_page import HEADER, reproduce, statement_table

    with shown('the paper') as update:

        def progress(title: str, done: float) -> None:
            update(done)
            print(title, flush=True)

        statements = reproduce(args.out, progress)
    found = statement_table(statements)
    table = Table(box=None, pad_edge=False)
    for title in HEADER:
        table.add_column(title, overflow='fold')
    for row in found.rows:
        table.add_row(*row)
    Console(markup=False, highlight=False).print(table)
    failed = sum(not s.holds for s in statements)
    print(f'{len(statements) - failed} statements hold, {failed} do not; {args.out}/index.html')
