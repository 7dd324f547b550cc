"""``tendon export``: a bag as CSV."""

from __future__ import annotations

import argparse
import sys

HELP = 'write the channels of a bag as CSV, for PlotJuggler or a spreadsheet'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('bag', metavar='BAG', help='folder, .mcap or .db3 file')
    parser.add_argument(
        '--out',
        required=True,
        metavar='FILE.csv|DIR',
        help='one wide file on the union of all stamps, or a folder with one file a group',
    )
    parser.add_argument('--namespace', help='instrument, where the bag holds several')
    parser.add_argument('--overwrite', action='store_true', help='replace files that are there')


def run(args: argparse.Namespace) -> None:
    """
    Write the files and name them.

    :param args: parsed arguments.
    """
    from tendon_ros.bags.export import export_csv
    from tendon_ros.bags.reader import read_recording

    recording = read_recording(args.bag, args.namespace)
    for warning in recording.warnings:
        print(f'warning: {warning}', file=sys.stderr)
    for path in export_csv(recording, args.out, overwrite=args.overwrite):
        print(path)
