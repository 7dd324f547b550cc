"""
``tendon estimate``: the operating force from a bag.

With the same method these are the numbers that the live node gives. The node's default is another
one, which needs no torques.
"""

from __future__ import annotations

import argparse
from pathlib import Path
import sys

from tendon_ros.cli.arguments import files_read, takes_bags

#: needs no contact, and so fits every rig whose torques were recorded
METHOD = 'static_balance'
#: endings of outputs that hold one recording
ONE_FILE = ('.csv', '.mcap', '.db3')

HELP = 'estimate the operating force and the inner pulleys from a bag'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    takes_bags(parser)
    parser.add_argument(
        '--out',
        required=True,
        metavar='BAG_OR_CSV',
        help='bag or .csv to write; a folder for them where there are several bags',
    )
    parser.add_argument(
        '--method',
        default=METHOD,
        help=f"{METHOD} (default), contact_angle (the node's) or dynamic; see docs/estimation.md",
    )
    parser.add_argument(
        '--channels',
        default='',
        metavar='A,B,...',
        help='for static_balance: the channels to use, such as pulley/pulley_spindle/effort',
    )
    parser.add_argument(
        '--wander',
        type=float,
        metavar='X',
        help='how far the force wanders in a second, N or N m, where that is known: the slower it '
        'changes, the more measurements tell of it; 0: nothing is known of it',
    )
    parser.add_argument(
        '--rate',
        type=float,
        metavar='HZ',
        help='estimate no more often than this; default: always',
    )
    parser.add_argument('--overwrite', action='store_true', help='replace what is there')


def run(args: argparse.Namespace) -> None:
    """
    Estimate, write, and compare with the load cell where there is one.

    :param args: parsed arguments.
    """
    from functools import partial

    import numpy as np

    from tendon_ros.bags.export import export_csv
    from tendon_ros.bags.reader import read_recording
    from tendon_ros.bags.writer import write_recording
    from tendon_ros.base.errors import RecordingError
    from tendon_ros.base.names import names_in
    from tendon_ros.cli.progress import shown
    from tendon_ros.estimate import build_observer, estimate_recording
    from tendon_ros.estimate.score import scored
    from tendon_ros.model.instrument_file import load_instrument
    from tendon_ros.model.joints import joint_names

    if args.rate is not None and not args.rate > 0.0:
        raise RecordingError(f'--rate {args.rate:g}: must be positive')
    instrument = load_instrument(args.instrument)
    fresh = partial(
        build_observer,
        instrument,
        args.method,
        channels=names_in(args.channels) or None,
        wander=args.wander or None,
    )
    fresh()  # a mistake is told before any bag is read
    squares, samples, compared, unit = 0.0, 0, 0, ''
    for bag, out in _places(args):
        recording = read_recording(bag, args.namespace, joint_names(instrument))
        with shown(f'estimating {recording.name}') as progress:
            estimated = estimate_recording(recording, fresh(), progress, args.rate)
        for warning in estimated.warnings:
            print(f'warning: {warning}', file=sys.stderr)
        if out.suffix == '.csv':
            export_csv(estimated, out, overwrite=args.overwrite)
        else:
            space = recording.metadata['namespace']
            write_recording(estimated, out, namespace=space, overwrite=args.overwrite)
        score = scored(estimated, instrument)
        if score is None:
            print(f'{out}: no load cell in the bag to compare with')
            continue
        squares += score.samples * score.rmse**2
        samples += score.samples
        compared += 1
        unit = score.unit
        print(
            f'{out}: {score.quantity} RMSE {score.rmse:.4g} {score.unit}, bias {score.bias:+.4g}, '
            f'range {score.span:.4g}; {score.coverage:.0%} within two standard deviations',
            flush=True,
        )
    if compared > 1:
        print(f'{compared} bags together: RMSE {np.sqrt(squares / samples):.4g} {unit}')


def _places(args: argparse.Namespace) -> list[tuple[Path, Path]]:
    """Return each bag and where its estimates go, all checked before the first one is read."""
    from tendon_ros.bags.place import check_bag_output
    from tendon_ros.bags.storage import open_bag
    from tendon_ros.base.errors import OutputError
    from tendon_ros.base.outputs import check_output

    bags, out = [Path(bag) for bag in args.bag], Path(args.out)
    if len(bags) > 1 and out.suffix in ONE_FILE:
        raise OutputError(f'{out}: one file for {len(bags)} bags; give a folder')
    places: dict[Path, Path] = {}
    for bag in bags:
        place = out / bag.resolve().name if len(bags) > 1 else out
        if place in places:
            raise OutputError(
                f'{place}: for both {places[place]} and {bag}; estimate them one by one'
            )
        places[place] = bag
    read = files_read(args)
    for place, bag in places.items():
        with open_bag(bag):
            pass  # a damaged one is told now, and not after those before it
        check = check_output if place.suffix == '.csv' else check_bag_output
        check(place, read, overwrite=args.overwrite)
    return [(bag, place) for place, bag in places.items()]
