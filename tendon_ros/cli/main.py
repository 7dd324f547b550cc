"""
The command ``tendon``: finds the verbs, reads the arguments, sets the exit status.

A verb is a module ``verb_<name>.py`` of this package with ``HELP`` (one line),
``add_arguments(parser)`` and ``run(args)``; underscores become dashes. Nothing registers it.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import importlib
import os
import pkgutil
import sys
from typing import Protocol

from tendon_ros import __version__, cli
from tendon_ros.base.command_line import DONE, FAILED, MISTAKE, Parser
from tendon_ros.base.errors import TendonError

_PREFIX = 'verb_'


class Verb(Protocol):
    """What the module of a verb offers."""

    HELP: str

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the arguments."""

    def run(self, args: argparse.Namespace) -> None:
        """Do the task."""


def verbs() -> dict[str, Verb]:
    """Return the verbs that exist, by name."""
    found: dict[str, Verb] = {}
    for module in pkgutil.iter_modules(cli.__path__):
        if module.name.startswith(_PREFIX):
            name = module.name.removeprefix(_PREFIX).replace('_', '-')
            found[name] = importlib.import_module(f'{cli.__name__}.{module.name}')
    return found


def build_parser() -> argparse.ArgumentParser:
    """Return the parser with all verbs."""
    parser = Parser(
        prog='tendon',
        description='Simulate, estimate and diagnose tendon-driven surgical instruments.',
    )
    parser.add_argument('--version', action='version', version=f'tendon {__version__}')
    verb_parsers = parser.add_subparsers(
        dest='verb', metavar='VERB', required=True, parser_class=Parser
    )
    for name, verb in sorted(verbs().items()):
        one = verb_parsers.add_parser(name, help=verb.HELP, description=verb.HELP)
        verb.add_arguments(one)
        one.set_defaults(run=verb.run)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """
    Run the command.

    :param argv: the arguments; None for those of the process.
    :return: the exit status.
    """
    try:
        args = build_parser().parse_args(argv)
        args.run(args)
        sys.stdout.flush()
    except TendonError as error:
        print(f'tendon: {" ".join(str(error).split())}', file=sys.stderr)
        return MISTAKE
    except BrokenPipeError:
        # The reader of our output is gone; keep Python from complaining again when it exits.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except KeyboardInterrupt:
        print('tendon: interrupted', file=sys.stderr)
        return FAILED
    except SystemExit as leave:
        return leave.code if isinstance(leave.code, int) else DONE
    return DONE


if __name__ == '__main__':
    sys.exit(main())
