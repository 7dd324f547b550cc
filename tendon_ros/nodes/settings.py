"""
The parameters of a node as plain data: ROS descriptors, options, help and docs follow from them.

Nothing here needs ROS, so that ``--help`` works without it.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
import difflib
import math

from tendon_ros.base.errors import listed, TendonError

Value = bool | int | float | str

SHOWN = 12  # names in a message
_KINDS = {bool: 'true or false', int: 'a whole number', float: 'a number', str: 'a text'}


class SettingError(TendonError):
    """A parameter of a node that does not exist or has a value that it cannot have."""


@dataclass(frozen=True)
class Setting:
    """
    One parameter of a node.

    The type of ``default`` is the type of the parameter. ``low`` and ``high`` bound numbers,
    ``choices`` texts. ``live``: it may change while the node runs.
    """

    name: str
    default: Value
    meaning: str
    unit: str = ''
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()
    live: bool = False

    @property
    def option(self) -> str:
        """The option of the command line: ``--exit-when-done``."""
        return '--' + self.name.replace('_', '-')

    @property
    def description(self) -> str:
        """What a parameter tool shows."""
        unit = f' [{self.unit}]' if self.unit else ''
        return self.meaning + unit

    @property
    def constraint(self) -> str:
        """What values are allowed, in words; empty for all."""
        if self.choices:
            return f'one of {", ".join(self.choices)}'
        if math.isfinite(self.low) and math.isfinite(self.high):
            return f'{self.low:g} to {self.high:g}'
        if math.isfinite(self.low):
            return f'at least {self.low:g}'
        return f'at most {self.high:g}' if math.isfinite(self.high) else ''


#: settings that several nodes have
INSTRUMENT = Setting('instrument', 'paper_rig', 'instrument file, or name of an installed one')
ENGINE = Setting('engine', 'auto', 'how the physics runs', choices=('auto', 'compiled', 'plain'))


def checked(setting: Setting, value: object) -> Value:
    """
    Return a value that is fit for a parameter.

    :param setting: the parameter.
    :param value: what was given.
    :return: the value, unchanged.
    :raises SettingError: on a wrong type, a number out of bounds or not finite, or no choice.
    """
    kind = type(setting.default)
    if type(value) is not kind:
        mend = f'{value}.0' if kind is float and type(value) is int else f'give {_KINDS[kind]}'
        mend = mend if mend.startswith('give') else f'write {mend}'
        raise SettingError(f'parameter {setting.name}: {value!r} is not {_KINDS[kind]}; {mend}')
    if isinstance(value, float) and not math.isfinite(value):
        raise SettingError(f'parameter {setting.name}: {value} is not a finite number')
    if isinstance(value, int | float) and not setting.low <= value <= setting.high:
        raise SettingError(
            f'parameter {setting.name}: {value:g} {setting.unit}'.rstrip()
            + f' is out of bounds; give {setting.constraint}'
        )
    if setting.choices and value not in setting.choices:
        raise SettingError(
            f'parameter {setting.name}: {value!r} does not exist; there are '
            f'{listed(setting.choices)}'
        )
    assert isinstance(value, bool | int | float | str)
    return value


def refuse_unknown(node: str, given: Iterable[str], known: Iterable[str]) -> None:
    """
    Raise where a parameter was given that the node does not have; ROS would ignore it.

    :param node: name of the node.
    :param given: names in parameter files and options.
    :param known: names that exist.
    :raises SettingError: with the name that comes closest.
    """
    names = set(known)
    for name in sorted(set(given) - names):
        close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
        mend = f'did you mean {close[0]}?' if close else f'it has {_short(names)}'
        raise SettingError(f'{node}: no parameter {name!r}; {mend}')


def add_options(parser: argparse.ArgumentParser, settings: Iterable[Setting]) -> None:
    """
    Declare an option for every parameter of a node.

    :param parser: of the node's command line.
    :param settings: the parameters.
    """
    for one in settings:
        limits = f'; {one.constraint}' if one.constraint else ''
        text = f'{one.description} (default {one.default!r}{limits})'.replace('%', '%%')
        if isinstance(one.default, bool):
            parser.add_argument(
                one.option, dest=one.name, action=argparse.BooleanOptionalAction, help=text
            )
        else:
            parser.add_argument(
                one.option, dest=one.name, type=type(one.default), metavar='X', help=text
            )


def given_options(args: argparse.Namespace, settings: Iterable[Setting]) -> Mapping[str, Value]:
    """
    Return the parameters that the command line sets.

    :param args: parsed arguments.
    :param settings: the parameters.
    :return: values by name, only those given.
    :raises SettingError: on a value that a parameter cannot have.
    """
    values = {one.name: (one, getattr(args, one.name)) for one in settings}
    return {name: checked(one, v) for name, (one, v) in values.items() if v is not None}


def _short(names: set[str]) -> str:
    """Return names for a message; an instrument has hundreds of parameters of effects."""
    plain = {name for name in names if not name.startswith('effects.')}
    more = ' and effects.PLACE.EFFECT.PARAMETER' if plain != names else ''
    return listed(sorted(plain)[:SHOWN]) + more
