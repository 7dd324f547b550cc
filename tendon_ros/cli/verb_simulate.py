"""``tendon simulate``: an instrument along a trajectory, faster than real time, into a bag."""

from __future__ import annotations

import argparse
from pathlib import Path

from tendon_ros.cli.arguments import takes_instrument

HELP = 'simulate an instrument along a trajectory, straight to a bag'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    takes_instrument(parser)
    parser.add_argument(
        '--trajectory', required=True, metavar='NAME|FILE.csv', help='see --trajectory list'
    )
    parser.add_argument('--out', metavar='BAG', help='folder, .mcap or .db3 file to write')
    parser.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        help="a setting of the trajectory, such as --set 'amplitude=5 deg'",
    )
    parser.add_argument(
        '--seed', type=int, help='of the noise of the sensors, 0 or more; noise is off without'
    )
    parser.add_argument('--rate', type=float, default=500.0, help='recorded rows per second [Hz]')
    parser.add_argument('--engine', choices=('auto', 'compiled', 'plain'), default='auto')
    parser.add_argument('--namespace', default='/instrument', help='of the topics written')
    parser.add_argument('--overwrite', action='store_true', help='replace a bag that is there')


def run(args: argparse.Namespace) -> None:
    """
    Simulate and write the bag.

    :param args: parsed arguments.
    """
    import time

    from tendon_ros.bags.place import check_bag_output
    from tendon_ros.bags.topics import check_namespace
    from tendon_ros.bags.writer import write_recording
    from tendon_ros.base.errors import RecordingError, TrajectoryError
    from tendon_ros.cli.progress import shown
    from tendon_ros.model.instrument_file import load_instrument
    from tendon_ros.model.session import simulate
    from tendon_ros.model.trajectory_choice import chosen_trajectory, profiles, settings

    if args.trajectory == 'list':
        for name in profiles():
            print(name)
            for key, (default, sheet) in settings(name).items():
                print(f'    {key}={default}  {sheet.meaning} [{sheet.unit}]')
        return
    if args.out is None:
        raise RecordingError('--out: missing; name the bag to write')
    if args.seed is not None and args.seed < 0:
        raise RecordingError(f'--seed {args.seed}: give 0 or more, or none for no noise')
    check_namespace(args.namespace)
    check_bag_output(Path(args.out), overwrite=args.overwrite)
    given = {}
    for text in args.set:
        key, equals, value = text.partition('=')
        if not equals:
            raise TrajectoryError(f'--set {text}: write KEY=VALUE')
        given[key.strip()] = value.strip()
    instrument = load_instrument(args.instrument)
    trajectory = chosen_trajectory(args.trajectory, instrument.motor_names, given)
    began = time.perf_counter()
    with shown('simulating') as progress:
        recording = simulate(
            instrument,
            trajectory,
            rate=args.rate,
            seed=args.seed,
            engine=args.engine,
            progress=progress,
        )
    took = time.perf_counter() - began
    path = write_recording(recording, args.out, namespace=args.namespace, overwrite=args.overwrite)
    span = recording.end - recording.start
    print(f'{path}: {span:.3f} s simulated in {took:.2f} s ({recording.metadata["engine"]})')
