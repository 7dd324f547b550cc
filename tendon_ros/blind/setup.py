"""What cases are drawn for: a rig, and which of its sensors there are."""

from __future__ import annotations

from dataclasses import dataclass

from tendon_ros.blind.law import Law
from tendon_ros.blind.laws import AXIS_LAWS, LAWS
from tendon_ros.blind.motion import AXIS_KINDS, KINDS
from tendon_ros.blind.sensing import CHANNEL_SETS
from tendon_ros.blind.unknowns import AXIS_UNKNOWNS, UNKNOWNS


@dataclass(frozen=True)
class Setup:
    """A rig by its name, and one of its channel sets."""

    bench: str
    channels: str

    @property
    def kinds(self) -> tuple[str, ...]:
        """The recordings of a case."""
        return AXIS_KINDS if self.bench == 'axis' else KINDS

    @property
    def laws(self) -> tuple[Law, ...]:
        """The faults that the catalogue may have."""
        return AXIS_LAWS if self.bench == 'axis' else LAWS

    @property
    def unknowns(self) -> tuple[Law, ...]:
        """The faults that no catalogue has."""
        return AXIS_UNKNOWNS if self.bench == 'axis' else UNKNOWNS

    def closed(self, kind: str) -> bool:
        """Return whether there is something to press on in a kind of recording."""
        return self.bench != 'axis' and kind != 'free'

    def places(self, law: Law) -> tuple[str, ...]:
        """Return the places of a law without those at sensors that are not there."""
        missing = set() if self.channels == 'joint' else {'encoder_1', 'encoder_2', 'encoder_3'}
        if self.channels == 'motor':
            missing.add('load_cell')
        return tuple(place for place in law.places if place not in missing)


def channel_sets(bench: str) -> tuple[str, ...]:
    """
    Return which sets of channels a rig has.

    :param bench: its name.
    :return: their names.
    """
    return CHANNEL_SETS[:1] if bench == 'axis' else CHANNEL_SETS
