"""Arguments that several verbs share."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tendon_ros.bags.reader import JointNames
    from tendon_ros.base.recording import Recording


def takes_bags(parser: argparse.ArgumentParser) -> None:
    """
    Declare the bags of one rig, its instrument file, and the namespace in the bags.

    :param parser: of a verb.
    """
    parser.add_argument('bag', nargs='+', metavar='BAG', help='folder, .mcap or .db3 file')
    takes_instrument(parser)
    parser.add_argument('--namespace', help='of the instrument, where a bag has several')


def takes_stretches(parser: argparse.ArgumentParser) -> None:
    """
    Declare what is looked at of the bags.

    :param parser: of a verb that takes bags.
    """
    parser.add_argument(
        '--only',
        action='append',
        default=[],
        metavar='[BAG=]FROM:TO',
        help='look at these seconds of each bag, or of the one named, counted from its first '
        'stamp; given twice, at two stretches, which leaves out what is between',
    )


def recordings_of(args: argparse.Namespace, joints: JointNames) -> list[Recording]:
    """
    Read the bags of :func:`takes_bags`, as far as :func:`takes_stretches` asks for them.

    :param args: parsed arguments.
    :param joints: names for messages without names.
    :return: the recordings.
    :raises RecordingError: on a bag that cannot be read, or a stretch that it has not.
    """
    from tendon_ros.bags.reader import read_recording
    from tendon_ros.base.errors import RecordingError
    from tendon_ros.base.stretch import Stretch, within

    try:
        stretches = [Stretch.parsed(text) for text in args.only]
    except RecordingError as error:
        raise RecordingError(f'--only {error}') from None
    whole = [read_recording(bag, args.namespace, joints) for bag in args.bag]
    return within(whole, stretches)


def files_read(args: argparse.Namespace) -> list[Path]:
    """
    Return the files that are read for the arguments of :func:`takes_bags`.

    :param args: parsed arguments.
    :return: the instrument file, and those of the bags.
    :raises InstrumentError: where there is no such instrument.
    :raises RecordingError: where one is no bag.
    """
    from tendon_ros.bags.place import files_of
    from tendon_ros.model.instrument_file import find_instrument

    bags = [file for bag in args.bag for file in files_of(Path(bag))]
    return [find_instrument(args.instrument), *bags]


def takes_instrument(parser: argparse.ArgumentParser) -> None:
    """
    Declare the instrument file.

    :param parser: of a verb.
    """
    parser.add_argument('--instrument', required=True, metavar='FILE.yaml', help='file or name')
