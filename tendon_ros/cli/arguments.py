"""Arguments that several verbs share."""

from __future__ import annotations

import argparse
from pathlib import Path


def takes_bags(parser: argparse.ArgumentParser) -> None:
    """
    Declare the bags of one rig, its instrument file, and the namespace in the bags.

    :param parser: of a verb.
    """
    parser.add_argument('bag', nargs='+', metavar='BAG', help='folder, .mcap or .db3 file')
    takes_instrument(parser)
    parser.add_argument('--namespace', help='of the instrument, where a bag has several')


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
