"""Faults: a law at a place with a size, and a rig that has them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

import numpy as np

from tendon_ros.blind.bench import LOOPS, MOTORS, PULLEYS
from tendon_ros.blind.law import Law, Values
from tendon_ros.blind.laws import KIN, MERGING
from tendon_ros.blind.rig import Rig
from tendon_ros.blind.setup import Setup

#: names of what stands at an index, by the first word of a place
_NAMES: dict[str, Sequence[str]] = {
    'pulley': PULLEYS,
    'cable': LOOPS,
    'motor': MOTORS,
    'torque': MOTORS,
    'encoder': ('M', 'L', '1', '2', '3'),
}


@dataclass(frozen=True)
class Fault:
    """A law at a place; ``recordings`` are those in which it acts."""

    law: Law
    place: str
    size: float
    seed: int
    recordings: tuple[str, ...]

    @property
    def effect(self) -> str:
        """The effect's id."""
        return self.law.effect

    def out_of_bounds(self, nuisance: float) -> bool:
        """Return whether the size is out of reason, or hardly more than a nuisance error."""
        least = max(self.law.low / 8.0, 5.0 * self.law.spread * nuisance)
        return not least <= self.size <= self.law.high

    def larger(self, factor: float) -> Fault:
        """Return the same fault, larger or smaller."""
        return replace(self, size=self.size * factor)

    def values(self, base: Rig) -> Values:
        """Return the truth in the catalogue's words."""
        return self.change(base.copy())

    def change(self, rig: Rig) -> Values:
        """Change a rig, and return the truth in the catalogue's words."""
        kind, _, name = self.place.partition('_')
        index = _NAMES[kind].index(name) if kind in _NAMES else 0
        rng = np.random.default_rng(self.seed)
        values = self.law.apply(rig, index, self.size, rng)
        return {key: float(value) for key, value in values.items()}


def rig_with(base: Rig, faults: Sequence[Fault], kind: str) -> Rig:
    """
    Return a rig with the faults that act in one kind of recording.

    :param base: without them.
    :param faults: what is wrong.
    :param kind: of recording.
    :return: a new rig.
    """
    rig = base.copy()
    for fault in faults:
        if kind in fault.recordings:
            fault.change(rig)
    return rig


def chosen(stratum: str, setup: Setup, rng: np.random.Generator) -> tuple[Fault, ...]:
    """
    Draw faults for a stratum: effect first, then place, each with the same chance.

    :param stratum: one that has faults.
    :param setup: which rig, and which of its sensors there are.
    :param rng: draws.
    :return: one to three faults that are not at one place the special case of each other; of a
        mixed case the last is one that no catalogue has.
    """
    count = int(rng.integers(2, 4)) if stratum in ('two_three', 'mixed') else 1
    laws = [setup.unknowns if stratum == 'unknown' else setup.laws] * count
    if stratum == 'mixed':
        laws[-1] = setup.unknowns
    while True:
        faults = [_any(own, setup, rng) for own in laws]
        if not any(_same(a, b) for n, a in enumerate(faults) for b in faults[:n]):
            return tuple(faults)


def renewed(
    faults: Sequence[Fault],
    which: int,
    setup: Setup,
    rng: np.random.Generator,
    *,
    keep: bool,
) -> tuple[Fault, ...]:
    """
    Draw one of several faults anew.

    :param faults: all of them.
    :param which: the index of the one.
    :param setup: which rig, and which of its sensors there are.
    :param rng: draws.
    :param keep: whether its effect stays, at another place and size.
    :return: the faults with a new one in its place.
    """
    others = [fault for n, fault in enumerate(faults) if n != which]
    laws = setup.unknowns if faults[which].law in setup.unknowns else setup.laws
    while True:
        if keep:
            one = _drawn(faults[which].effect, laws, setup, rng)
        else:
            one = _any(laws, setup, rng)
        if not any(_same(one, other) for other in others):
            return (*faults[:which], one, *faults[which + 1 :])
        keep = False


def _any(laws: Sequence[Law], setup: Setup, rng: np.random.Generator) -> Fault:
    """Draw any fault of some laws."""
    effects = sorted({law.effect for law in laws if setup.places(law)})
    return _drawn(str(rng.choice(effects)), laws, setup, rng)


def _drawn(effect: str, laws: Sequence[Law], setup: Setup, rng: np.random.Generator) -> Fault:
    """Draw place, size and recordings of an effect."""
    pairs = [(law, place) for law in laws if law.effect == effect for place in setup.places(law)]
    law, place = pairs[int(rng.integers(len(pairs)))]
    size = math.exp(rng.uniform(math.log(law.low), math.log(law.high)))
    once = law.event and rng.random() < 0.6
    kinds = (str(rng.choice(setup.kinds)),) if once else setup.kinds
    return Fault(law, place, size, int(rng.integers(2**31)), kinds)


def _same(one: Fault, other: Fault) -> bool:
    """Return whether two faults at one place, or on one body, are a matter of words."""
    kin = (one.effect, *KIN.get(one.effect, ()))
    if one.place == other.place and other.effect in kin:
        return True
    bodies = {fault.place.partition('_')[2] for fault in (one, other)}
    return len(bodies) == 1 and {one.effect, other.effect} in MERGING
