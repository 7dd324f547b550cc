"""What effects do to a model: the numbers that they modify, and the laws that act."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import NamedTuple

from tendon_ros.base.effect import Effect, HOOKS
from tendon_ros.base.errors import EffectError, listed
from tendon_ros.effects import catalogue, find
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.numbers import Numbers, place_index


@cache
def law_numbers() -> Mapping[str, Mapping[str, int]]:
    """
    Return the number by which the kernel knows each law, by hook and effect id.

    :return: for each hook, the effects that have a law for it, numbered in the order of their ids.
    """
    effects = catalogue()
    return {
        hook: {
            name: number
            for number, name in enumerate(sorted(e for e in effects if effects[e].hook == hook))
        }
        for hook in HOOKS
    }


class Law(NamedTuple):
    """A law that acts: its number, the pulley or link it acts on, and its parameters."""

    number: int
    where: int
    values: tuple[float, ...]
    stateful: bool


class Laws:
    """
    Collects what effects do.

    ``numbers``: after them; ``acting``: laws by hook, places in the instrument's order;
    ``switches``: times at which any of them jumps [s].

    :param instrument: the network.
    :param numbers: those of the instrument; they are modified.
    """

    def __init__(self, instrument: Instrument, numbers: Numbers) -> None:
        self.instrument = instrument
        self.numbers = numbers
        self.acting: dict[str, list[Law]] = {hook: [] for hook in HOOKS}
        self.switches: list[float] = []

    def add(self, use: EffectUse) -> None:
        """
        Add an effect.

        :param use: the effect at its place.
        :raises EffectError: where it cannot act, or a parameter is unknown or out of bounds.
        """
        effect = find(use.effect)
        kind, index = place_index(self.instrument, use.place)
        values = self._checked(effect, kind, index, use)
        if all(values[p.name] == p.neutral for p in effect.parameters if not p.shapes_only):
            return  # off costs nothing and changes nothing, not even the rounding
        if effect.modify is not None:
            self.numbers.kind = kind
            effect.modify(self.numbers, index, **values)
        if effect.hook:
            if kind == 'motor':
                index = int(self.numbers['motor_pulley'][index])
            number = law_numbers()[effect.hook][use.effect]
            ordered = tuple(values[p.name] for p in effect.parameters)
            self.acting[effect.hook].append(Law(number, index, ordered, effect.stateful))
        if effect.switches is not None:
            self.switches.extend(effect.switches(**values))

    def _checked(self, effect: Effect, kind: str, index: int, use: EffectUse) -> dict[str, float]:
        """Return all parameters of an effect that can act at its place."""
        if kind not in effect.kinds:
            raise EffectError(
                f'{use.effect} cannot act at {use.place}: it acts at {listed(effect.kinds)}'
            )
        if kind == 'sensor' and self.instrument.sensors[index].kind not in effect.sensors:
            raise EffectError(
                f'{use.effect} cannot act at {use.place}, a sensor of '
                f'{self.instrument.sensors[index].kind}: it acts on {listed(effect.sensors)}'
            )
        values = {**effect.neutral, **use.parameters}
        if len(values) > len(effect.neutral):
            unknown = sorted(set(values) - set(effect.neutral))
            raise EffectError(
                f'{use.effect} at {use.place}: no parameter {unknown[0]!r}; it has '
                f'{listed(effect.neutral)}'
            )
        for parameter in effect.parameters:
            value = values[parameter.name]
            if not parameter.low <= value <= parameter.high:
                raise EffectError(
                    f'{use.effect} at {use.place}: {parameter.name} = {value:g} {parameter.unit} '
                    f'is outside {parameter.low:g} to {parameter.high:g}'
                )
        return values


def modified(instrument: Instrument, effects: Sequence[EffectUse]) -> Numbers:
    """
    Return the numbers of an instrument after effects have modified them.

    :param instrument: the network.
    :param effects: those in force.
    :return: the numbers.
    :raises EffectError: as :meth:`Laws.add`.
    """
    laws = Laws(instrument, Numbers(instrument))
    for use in effects:
        laws.add(use)
    return laws.numbers
