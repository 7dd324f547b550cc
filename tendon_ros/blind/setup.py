"""What cases are drawn for: a rig, and which of its sensors there are."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tendon_ros.blind.law import Law
from tendon_ros.blind.laws import ARM_LAWS, AXIS_LAWS, GUESSED_LAWS, LAWS
from tendon_ros.blind.motion import AXIS_KINDS, KINDS
from tendon_ros.blind.sensing import CHANNEL_SETS, Sampling
from tendon_ros.blind.unknowns import AXIS_UNKNOWNS, UNKNOWNS


@dataclass(frozen=True)
class _Repertoire:
    """
    What is recorded of a kind of rig, and what can be wrong with it.

    ``kinds``: its recordings, ``pressed``: those in which there is something to press on;
    ``sampling``: when rows are recorded.
    """

    kinds: tuple[str, ...]
    pressed: tuple[str, ...]
    channel_sets: tuple[str, ...]
    laws: tuple[Law, ...]
    unknowns: tuple[Law, ...]
    sampling: Sampling


_BENCH = _Repertoire(KINDS, ('contact', 'mixed'), CHANNEL_SETS, LAWS, UNKNOWNS, Sampling())
_AXIS = _Repertoire(AXIS_KINDS, (), ('motor',), AXIS_LAWS, AXIS_UNKNOWNS, Sampling())
_ARM = _Repertoire(
    AXIS_KINDS, (), ('motor',), ARM_LAWS, AXIS_UNKNOWNS, Sampling(every=10, late=2, lost=0.01)
)
_GUESSED = replace(_BENCH, laws=GUESSED_LAWS)
_REPERTOIRES = {
    'bench': _BENCH,
    'other': _BENCH,
    'axis': _AXIS,
    'arm': _ARM,
    'guessed': _GUESSED,
}


@dataclass(frozen=True)
class Setup:
    """A rig by its name, and one of its channel sets."""

    bench: str
    channels: str

    @property
    def kinds(self) -> tuple[str, ...]:
        """The recordings of a case."""
        return _REPERTOIRES[self.bench].kinds

    @property
    def laws(self) -> tuple[Law, ...]:
        """The faults that the catalogue may have."""
        return _REPERTOIRES[self.bench].laws

    @property
    def unknowns(self) -> tuple[Law, ...]:
        """The faults that no catalogue has."""
        return _REPERTOIRES[self.bench].unknowns

    @property
    def sampling(self) -> Sampling:
        """When rows are recorded."""
        return _REPERTOIRES[self.bench].sampling

    def closed(self, kind: str) -> bool:
        """Return whether there is something to press on in a kind of recording."""
        return kind in _REPERTOIRES[self.bench].pressed

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
    return _REPERTOIRES[bench].channel_sets
