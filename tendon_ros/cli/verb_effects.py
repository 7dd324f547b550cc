"""``tendon effects``: the catalogue of effects, one data sheet, or the page of all of them."""

from __future__ import annotations

import argparse
from pathlib import Path

HELP = 'list the effects that the model knows, or show one with its equation and parameters'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments of the verb.

    :param parser: the verb's own parser.
    """
    what = parser.add_mutually_exclusive_group()
    what.add_argument('effect', metavar='ID', nargs='?', help='effect whose data sheet to show')
    what.add_argument(
        '--markdown', metavar='FILE', type=Path, help='write all data sheets as one Markdown page'
    )
    parser.add_argument('--overwrite', action='store_true', help='replace a page that is there')


def run(args: argparse.Namespace) -> None:
    """
    Print or write what was asked for.

    :param args: the parsed arguments.
    :raises EffectError: where there is no effect of that id.
    :raises OutputError: where the page cannot be written.
    """
    from tendon_ros.base.outputs import check_output
    from tendon_ros.effects import catalogue
    from tendon_ros.report.effects_page import section, write_page

    if args.markdown is not None:
        check_output(args.markdown, overwrite=args.overwrite)
        write_page(args.markdown)
        print(f'{args.markdown}: {len(catalogue())} effects')
    elif args.effect is not None:
        print(section(args.effect))
    else:
        width = max(map(len, catalogue()))
        for effect in catalogue().values():
            print(f'{effect.id:{width}}  {effect.title} ({", ".join(effect.kinds)})')
