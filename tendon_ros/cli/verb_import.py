"""``tendon import``: foreign recordings as bags."""

from __future__ import annotations

import argparse
from pathlib import Path
import sys

HELP = 'turn an npz, CSV, MAT or JSON file into bags, as a mapping file says'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('file', metavar='FILE', help='npz, CSV, MAT or JSON file')
    parser.add_argument(
        '--mapping',
        required=True,
        metavar='MAP.yaml',
        help='what is what; a file, or the name of one that comes with the package',
    )
    parser.add_argument(
        '--out',
        required=True,
        metavar='DIR|BAG',
        help='the bag where one run is imported; a folder of bags named by run where several are',
    )
    parser.add_argument(
        '--select', nargs='+', default=[], metavar='KEY', help='only these runs of the file'
    )
    parser.add_argument(
        '--storage',
        choices=('mcap', 'sqlite3'),
        help='default: what the ending of BAG says, else mcap',
    )
    parser.add_argument('--namespace', default='/instrument', help='of the topics written')
    parser.add_argument('--overwrite', action='store_true', help='replace bags that are there')


def run(args: argparse.Namespace) -> None:
    """
    Write one bag a run.

    :param args: parsed arguments.
    """
    from rich.console import Console
    from rich.progress import track

    from tendon_ros.bags.importing import import_runs, run_keys
    from tendon_ros.bags.mapping import load_mapping
    from tendon_ros.bags.place import check_bag_output
    from tendon_ros.bags.topics import check_namespace
    from tendon_ros.bags.writer import FILE_STORAGE, write_recording
    from tendon_ros.base.errors import OutputError

    mapping = load_mapping(args.mapping)
    keys = list(dict.fromkeys(args.select)) or run_keys(args.file, mapping)
    out = Path(args.out)
    ending = FILE_STORAGE.get(out.suffix)
    if ending is not None and args.storage not in (None, ending):
        raise OutputError(
            f'{out}: its ending says {ending}, --storage {args.storage}; leave out one of them'
        )
    if ending is not None and len(keys) > 1:
        raise OutputError(f'{out}: one file for {len(keys)} runs; give a folder, or --select one')
    check_namespace(args.namespace)
    odd = [key for key in keys if key in ('', '..') or Path(key).name != key]
    if odd and len(keys) > 1:
        raise OutputError(
            f'{args.file}: run {odd[0]!r} is no name of a bag in {out}; give the run another name '
            'in the file, or --select it alone, with an --out of its own'
        )
    for key in keys:
        place = out if len(keys) == 1 else out / key
        check_bag_output(place, [Path(args.file)], overwrite=args.overwrite)
    console = Console(stderr=True)
    runs = import_runs(args.file, mapping, keys)
    for recording in track(
        runs, 'importing', total=len(keys), console=console, disable=not console.is_terminal
    ):
        for warning in recording.warnings:
            print(f'warning: {warning}', file=sys.stderr)
        path = write_recording(
            recording,
            out if len(keys) == 1 else out / recording.name,
            namespace=args.namespace,
            storage=args.storage or ending or 'mcap',
            overwrite=args.overwrite,
        )
        print(path, flush=True)
