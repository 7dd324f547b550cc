"""An effect in force at a place of an instrument, checked against the catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from tendon_ros.base.errors import EffectError, listed
from tendon_ros.base.quantity import parsed, written
from tendon_ros.base.recording import unit_of
from tendon_ros.effects import find
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.numbers import place_index


def units_at(instrument: Instrument, effect: str, place: str) -> dict[str, str]:
    """
    Return the units of an effect's parameters: what a sensor reads in is told by its place.

    :param instrument: where it acts.
    :param effect: the effect's id.
    :param place: a place of the instrument.
    :return: units by parameter.
    :raises EffectError: on an effect that is not in the catalogue.
    """
    read = {s.name: unit_of(s.channel) for s in instrument.sensors}
    return {
        p.name: read.get(place, p.unit) if p.of_reading else p.unit
        for p in find(effect).parameters
    }


def whole(use: EffectUse) -> EffectUse:
    """
    Return an effect with the parameters that no search moves, as a file has it.

    :param use: with some of its parameters.
    :return: with all of them; what stands instead of a file's effect has the others from there.
    """
    if use.instead:
        return use
    return replace(use, parameters={**find(use.effect).neutral, **use.parameters})


def checked_use(
    instrument: Instrument, effect: str, place: str, parameters: Mapping[str, str | float]
) -> EffectUse:
    """
    Return an effect at a place, all its parameters given and within their bounds.

    :param instrument: where it is to act.
    :param effect: the effect's id.
    :param place: a place of the instrument, such as ``pulley_3``.
    :param parameters: texts with units, or SI numbers; sizes that are left out are none, and
        angles are zero.
    :return: the effect in use.
    :raises EffectError: on an unknown effect, place or parameter, a place of the wrong kind, a
        wrong unit or a value out of bounds; the message lists what exists.
    """
    known = find(effect)
    kind, _ = place_index(instrument, place)
    if kind not in known.kinds:
        raise EffectError(
            f'{effect} cannot act at {place}, a {kind}; it acts at {listed(known.kinds)}'
        )
    if kind == 'sensor':
        [sensor] = [s for s in instrument.sensors if s.name == place]
        if known.sensors and sensor.kind not in known.sensors:
            raise EffectError(
                f'{effect} cannot act at {place}, which measures {sensor.kind}; it acts at '
                f'sensors of {listed(known.sensors)}'
            )
    values = dict(known.left_out)
    units = units_at(instrument, effect, place)
    for name in parameters:
        if name not in values:
            raise EffectError(f'{effect} has no parameter {name!r}; it has {listed(values)}')
    for parameter in known.parameters:
        if parameter.name not in parameters:
            continue
        given, unit = parameters[parameter.name], units[parameter.name]
        field = f'{effect} at {place}: {parameter.name}'
        try:
            value = parsed(given, unit) if isinstance(given, str) else float(given)
        except ValueError as error:
            raise EffectError(f'{field}: {error}') from None
        if not parameter.low <= value <= parameter.high:
            raise EffectError(
                f'{field}: {given!r} is out of bounds; give '
                f'{written(parameter.low, unit)} to {written(parameter.high, unit)}'
            )
        values[parameter.name] = value
    return EffectUse(effect, place, values)


def in_force(own: Sequence[EffectUse], uses: Sequence[EffectUse]) -> tuple[EffectUse, ...]:
    """
    Return the effects that act where an instrument has effects and others are added.

    :param own: of the instrument.
    :param uses: what is added, and what stands instead of an effect of the instrument.
    :return: all of them.
    """
    found = list(own)
    for use in uses:
        name = (use.effect, use.place)
        old = next((n for n, u in enumerate(own) if (u.effect, u.place) == name), None)
        if use.instead and old is not None:
            changed = {**found[old].parameters, **use.parameters}
            found[old] = replace(found[old], parameters=changed)
        else:
            found.append(replace(use, instead=False) if use.instead else use)
    return tuple(found)
