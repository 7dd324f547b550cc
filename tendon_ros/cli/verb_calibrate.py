"""``tendon calibrate``: fit what was diagnosed on one machine to another of its kind."""

from __future__ import annotations

import argparse
from pathlib import Path

from tendon_ros.cli.arguments import files_read, recordings_of, takes_bags, takes_stretches

HELP = 'fit a diagnosed instrument file to another machine of its kind, and say what differs'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    takes_bags(parser)
    takes_stretches(parser)
    parser.add_argument(
        '--out', type=Path, required=True, metavar='FILE.yaml', help='calibrated file to write'
    )
    parser.add_argument('--overwrite', action='store_true', help='replace a file that is there')


def run(args: argparse.Namespace) -> None:
    """
    Calibrate, write the file, and say what carried over.

    :param args: parsed arguments.
    """
    from tendon_ros.base.outputs import check_output
    from tendon_ros.cli.progress import told
    from tendon_ros.diagnose.calibrate import calibrate
    from tendon_ros.model.instrument_file import load_instrument, save_instrument
    from tendon_ros.model.joints import joint_names
    from tendon_ros.report.calibration_text import calibration_text

    check_output(args.out, files_read(args), overwrite=args.overwrite)
    instrument = load_instrument(args.instrument)
    recordings = recordings_of(args, joint_names(instrument))
    with told() as report:
        found = calibrate(recordings, instrument, report)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    save_instrument(found.instrument, args.out)
    print(calibration_text(found), end='')
    print(f'{args.out}: simulate, estimate and diagnose take it as it is')
