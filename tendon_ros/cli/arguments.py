"""Arguments that several verbs share."""

from __future__ import annotations

import argparse


def takes_bags(parser: argparse.ArgumentParser) -> None:
    """
    Declare the bags of one rig, its instrument file, and the namespace in the bags.

    :param parser: of a verb.
    """
    parser.add_argument('bag', nargs='+', metavar='BAG', help='folder, .mcap or .db3 file')
    takes_instrument(parser)
    parser.add_argument('--namespace', help='of the instrument, where a bag has several')


def takes_instrument(parser: argparse.ArgumentParser) -> None:
    """
    Declare the instrument file.

    :param parser: of a verb.
    """
    parser.add_argument('--instrument', required=True, metavar='FILE.yaml', help='file or name')
