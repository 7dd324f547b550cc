"""
The catalogue of effects: one file each, found rather than registered.

A module in this folder is an effect of the same name. Its docstring is the data sheet, its
constant ``EFFECT`` fulfils :mod:`tendon_ros.base.effect`. To add an effect is to add a file.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from inspect import cleandoc
from pkgutil import iter_modules
from types import MappingProxyType

from tendon_ros.base.effect import Effect
from tendon_ros.base.errors import EffectError, listed


@cache
def catalogue() -> Mapping[str, Effect]:
    """
    Return every effect that exists.

    :return: the effects by id, in the order of their ids; read-only.
    """
    names = sorted(module.name for module in iter_modules(__path__))
    return MappingProxyType({n: import_module(f'{__name__}.{n}').EFFECT for n in names})


def find(name: str) -> Effect:
    """
    Return one effect.

    :param name: its id.
    :return: the effect.
    :raises EffectError: where there is none of that id; the message lists those that exist.
    """
    try:
        return catalogue()[name]
    except KeyError:
        raise EffectError(f'no effect {name!r}; there are {listed(catalogue())}') from None


def data_sheet(name: str) -> str:
    """
    Return what an effect means: the docstring of its file.

    :param name: its id.
    :return: the text, first line a summary, equations indented after a line that ends in ``::``.
    :raises EffectError: where there is no effect of that id.
    """
    return cleandoc(import_module(f'{__name__}.{find(name).id}').__doc__ or '')
