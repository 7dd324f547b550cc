"""Candidates: every effect at every place where it can act, and where fits begin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
import math

from tendon_ros.base.errors import EffectError, listed
from tendon_ros.base.parameter import Parameter
from tendon_ros.effects import catalogue, find
from tendon_ros.identify.coordinates import Coordinates
from tendon_ros.identify.magnitude import Magnitude, magnitudes, TYPICAL
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.numbers import place_index

Values = Mapping[str, float]


@dataclass(frozen=True, order=True)
class Candidate:
    """
    An effect at a place; with ``only``, in the one segment of that name.

    What happens at a time (a slip, a push) happens in one recording, or in each at its own.
    ``given``: what the instrument file says of this effect at this place. The candidate then
    stands instead of it: that the file is wrong about the effect. ``magnitude``: how large the
    forces of the place are. ``stated``: the file says how well it knows what it gives.
    ``least``: below which a size changes nothing there. ``opened``: parameters that are fitted at
    few places, of which this is one.
    """

    effect: str
    place: str
    only: str = ''
    given: tuple[tuple[str, float], ...] = ()
    magnitude: Magnitude = TYPICAL
    stated: bool = False
    least: float = -math.inf
    opened: tuple[str, ...] = ()

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """The effect's parameters, seen from what is given, but for what only a guess opens."""
        known = dict(self.given)
        effect = find(self.effect)
        own = [
            self.magnitude.sized(p)
            for p in effect.parameters
            if p.search != 'guess' and (not p.sensors or p.name in self.opened)
        ]
        own = [p if p.is_shape else replace(p, low=max(p.low, self.least)) for p in own]
        if not self.given_size:
            return tuple(own)  # what has no size has no shape either
        return tuple(_seen_from(p, known[p.name]) if p.name in known else p for p in own)

    @property
    def given_size(self) -> bool:
        """Whether the file gives it a size, so that a shape means something, too."""
        known, own = dict(self.given), find(self.effect).parameters
        return any(
            known.get(p.name, p.neutral) != p.neutral
            for p in own
            if p.search != 'guess' and not p.is_shape
        )

    @property
    def as_given(self) -> dict[str, float]:
        """The parameters with which it changes nothing: as the file has them, or of no size."""
        return {p.name: p.typical if p.is_shape else p.neutral for p in self.parameters}

    @property
    def price(self) -> int:
        """How many parameters it costs: of equals, what contradicts a measurement comes last."""
        return len(self.parameters) + self.stated

    def as_much(
        self, other: Candidate, values: Mapping[str, float], *, back: bool = False
    ) -> dict[str, float]:
        """
        Return parameters with which this changes as much as the same effect elsewhere.

        :param other: the effect at the other place, where the file may have another size of it.
        :param values: of its parameters.
        :param back: whether what may have either sign has the other one.
        :return: of this one's; a shape that the file gives stays.
        """
        known = dict(self.given)
        its = {p.name: p for p in other.parameters}
        found = {}
        for p in self.parameters:
            if p.is_shape:
                found[p.name] = known.get(p.name, values.get(p.name, p.typical))
            else:
                changed = values[p.name] - its[p.name].neutral
                if back and p.neutral == 0.0 and p.low < 0.0:
                    changed = -changed
                found[p.name] = min(max(changed + p.neutral, p.low), p.high)
        return found

    @property
    def instants(self) -> tuple[Parameter, ...]:
        """The parameters that are times of the recording."""
        return tuple(p for p in self.parameters if p.search == 'instant')

    def changes(self, values: Values) -> tuple[float, ...]:
        """
        Return when an event sets in, and when it ends if it does.

        :param values: of its parameters.
        :return: times of the recording [s], in their order; none of what lasts.
        """
        switches = find(self.effect).switches
        return switches(**values) if switches else ()

    @property
    def dry(self) -> bool:
        """Whether it is a dry friction, by whatever law."""
        return find(self.effect).dry

    @property
    def by_others(self) -> bool:
        """Whether what it does grows with what others do."""
        return find(self.effect).by_others

    @property
    def waves(self) -> bool:
        """Whether it comes again with every part of a turn."""
        return any(p.search == 'cycles' for p in self.parameters)

    @property
    def switches(self) -> bool:
        """Whether it is there or not, and has no size."""
        return any(p.search == 'switch' for p in self.parameters)

    @property
    def scales(self) -> bool:
        """Whether any parameter is a size."""
        return any(not p.is_shape for p in self.parameters)

    @cached_property
    def coordinates(self) -> Coordinates:
        """The unknowns of a fit of it."""
        return Coordinates(self.parameters)

    def use(self, values: Values) -> EffectUse:
        """
        Return the effect with its parameters.

        :param values: by name, SI units.
        :return: the effect in use.
        """
        return EffectUse(self.effect, self.place, dict(values), instead=bool(self.given))

    def acts_in(self, segment: str) -> bool:
        """
        Return whether it acts in a segment.

        :param segment: its name.
        :return: whether.
        """
        return self.only in ('', segment)


def _seen_from(parameter: Parameter, value: float) -> Parameter:
    """Return a parameter whose value in the file is what changes nothing."""
    if parameter.is_shape:
        return replace(parameter, typical=value)
    step = parameter.typical - parameter.neutral
    typical = value + step if parameter.low <= value + step <= parameter.high else value - step
    return replace(parameter, neutral=value, typical=typical)


def everyone(
    instrument: Instrument,
    measured: Sequence[str],
    withheld: Sequence[str] = (),
    magnitude: Magnitude = TYPICAL,
) -> tuple[Candidate, ...]:
    """
    Return all candidates of an instrument.

    :param instrument: the network.
    :param measured: channels that were measured; effects on sensors that were not are left out.
    :param withheld: effects that are not to be considered, ``EFFECT`` or ``EFFECT@PLACE``.
    :param magnitude: how large the forces of the instrument's motors are.
    :return: the candidates, in the catalogue's order; an effect that the file has at a place may
        be another one there; of what the file says how well it is known, only beyond that.
    """
    own = {(use.effect, use.place): use.parameters for use in instrument.effects}
    large = magnitudes(instrument, magnitude)
    silent = {s.name for s in instrument.sensors if s.channel not in measured}
    found = []
    for effect in catalogue().values():
        for place in instrument.places():
            kind, index = place_index(instrument, place)
            if kind not in effect.kinds or place in silent:
                continue
            if kind == 'sensor' and instrument.sensors[index].kind not in effect.sensors:
                continue
            if effect.id in withheld or f'{effect.id}@{place}' in withheld:
                continue
            few = opened(instrument, effect.id, place)
            one = Candidate(effect.id, place, magnitude=large[place], opened=few)
            given = own.get((effect.id, place))
            if given is not None and not one.instants:
                names = [f'{place}.{effect.id}.{name}' for name in given]
                stated = any(math.isfinite(instrument.tolerances.get(n, math.inf)) for n in names)
                one = replace(one, given=tuple(sorted(given.items())), stated=stated)
            if effect.id == 'viscous_friction':  # less than no damping would drive
                one = replace(one, least=-instrument.pulleys[index].damping)
            found.append(one)
    return tuple(found)


def opened(instrument: Instrument, effect: str, place: str) -> tuple[str, ...]:
    """
    Return the parameters of an effect that are fitted at a place, and not wherever it acts.

    :param instrument: the network.
    :param effect: the effect's id.
    :param place: a place where it can act.
    :return: their names; none for most.
    """
    kind, index = place_index(instrument, place)
    if kind != 'sensor':
        return ()
    read = instrument.sensors[index].kind
    return tuple(p.name for p in find(effect).parameters if read in p.sensors)


def check_withheld(instrument: Instrument, withheld: Sequence[str]) -> None:
    """
    Refuse to withhold what does not exist: a typing error would silently change the result.

    :param instrument: the network.
    :param withheld: ``EFFECT`` or ``EFFECT@PLACE``.
    :raises EffectError: on an unknown effect, place, or a place where it cannot act.
    """
    for text in withheld:
        name, _, place = text.partition('@')
        effect = find(name)
        if place and place_index(instrument, place)[0] not in effect.kinds:
            raise EffectError(
                f'--withhold {text}: {name} cannot act there; it acts at {listed(effect.kinds)}'
            )


def starts(candidate: Candidate) -> list[dict[str, float]]:
    """
    Return where fits of a candidate begin: sizes as typical, shapes on a coarse grid.

    :param candidate: the candidate; parameters that are searched for otherwise stay typical.
    :return: values of all parameters.
    """
    axes: list[tuple[float, ...]] = []
    for p in candidate.parameters:
        if p.search in ('instant', 'duration', 'cycles', 'level') or not p.is_shape:
            axes.append((p.typical,))
        elif p.search == 'share':
            axes.append((p.low, p.high))
        elif p.low > 0.0 or p.search == 'shape':
            axes.append((p.typical, 0.2 * p.typical, 5.0 * p.typical))
        else:
            middle, half = 0.5 * (p.low + p.high), 0.5 * min(0.5 * (p.high - p.low), 1.6)
            axes.append((middle, middle - half, middle + half))
    names = [p.name for p in candidate.parameters]
    return [
        {
            p.name: min(max(value, p.low), p.high)
            for p, value in zip(candidate.parameters, values, strict=True)
        }
        for values in product(*axes)
        if names
    ]
