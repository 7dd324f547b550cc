"""
Effects as parameters of a node: ``effects.<place>.<effect>.<parameter>``.

Every effect of the catalogue gets its parameters at every place of the instrument where it can
act, with the catalogue's bounds and units. They start at what the instrument file says, and at
what changes nothing where it says nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tendon_ros.base.effect import Effect
from tendon_ros.effects import catalogue
from tendon_ros.model.effect_use import units_at
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.numbers import place_index
from tendon_ros.nodes.settings import Setting

#: what the names of all these parameters begin with
PREFIX = 'effects'


def effect_settings(instrument: Instrument) -> tuple[Setting, ...]:
    """
    Return the parameters of all effects that can act on an instrument.

    :param instrument: the network, with the effects of its file.
    :return: settings that may change while the node runs.
    """
    in_file = {(use.place, use.effect): use.parameters for use in instrument.effects}
    out = []
    for place, effect in _slots(instrument):
        units = units_at(instrument, effect.id, place)
        given = {**effect.left_out, **in_file.get((place, effect.id), {})}
        for parameter in effect.parameters:
            out.append(
                Setting(
                    name=_name(place, effect.id, parameter.name),
                    default=float(given[parameter.name]),
                    meaning=f'{effect.title} at {place}: {parameter.meaning}',
                    unit=units[parameter.name],
                    low=parameter.low,
                    high=parameter.high,
                    live=True,
                )
            )
    return tuple(out)


def effects_from(instrument: Instrument, values: Mapping[str, float]) -> tuple[EffectUse, ...]:
    """
    Return the effects that parameters put in force.

    :param instrument: the network, with the effects of its file.
    :param values: every parameter of :func:`effect_settings`, by name.
    :return: the effects of which some parameter changes something; those of the file come first,
        in the file's order, so that the model is bit for bit that of the file.
    """
    uses = {}
    for place, effect in _slots(instrument):
        own = {p.name: values[_name(place, effect.id, p.name)] for p in effect.parameters}
        if any(own[p.name] != p.neutral for p in effect.parameters if not p.shapes_only):
            uses[place, effect.id] = EffectUse(effect.id, place, own)
    first = [key for use in instrument.effects if (key := (use.place, use.effect)) in uses]
    return tuple(uses[key] for key in dict.fromkeys([*first, *uses]))


def _slots(instrument: Instrument) -> Iterator[tuple[str, Effect]]:
    """Yield every place with every effect that can act there."""
    sensors = {sensor.name: sensor.kind for sensor in instrument.sensors}
    for place in instrument.places():
        kind, _ = place_index(instrument, place)
        for effect in catalogue().values():
            fits = kind != 'sensor' or not effect.sensors or sensors[place] in effect.sensors
            if kind in effect.kinds and fits:
                yield place, effect


def _name(place: str, effect: str, parameter: str) -> str:
    return f'{PREFIX}.{place}.{effect}.{parameter}'
