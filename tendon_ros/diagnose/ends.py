"""
What only an end of the range asks for: a stop, a hand or a cable at its end that no file has.

Where a pulley touches something it stands, and its motor asks for more than any motion takes. The
catalogue has no such effect, and a torque limit or a friction fits it as well as a stop would. But
it shows at one angle alone, beyond which no recording that it is in goes, and a limit, like any
friction, is met wherever the torque is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: part of a pulley's range, and counts of its encoder, that are one end of it
NEAR, COUNTS = 0.02, 3.0
#: part of the bins that may be at an end: a pulley that is there for longer does little else
THERE = 0.5
#: part of a misfit that lies at an end from which on the rest is looked at without it
MUCH = 0.4
#: part of a cause's worth that may stay elsewhere, and of a misfit's structure, if it is all there
ELSEWHERE = 0.02
#: structured misfit, in noise power per sample, from which on one wants to know where it is
WHERE = 1.0


@dataclass(frozen=True)
class End:
    """
    An end of a pulley's range in some recordings.

    ``angle`` [rad]; ``bins``: those at it, one mask a segment, none where a contact of the file
    presses.
    """

    pulley: str
    angle: float
    recordings: tuple[str, ...]
    bins: tuple[BoolArray, ...]

    @property
    def words(self) -> str:
        """What it is to say that all that stays lies there."""
        return (
            f'all that stays of the gap lies where pulley_{self.pulley} is at {self.angle:.3g} '
            f'rad in {listed(self.recordings)}, and no further: it touches something there that '
            'the file does not have (a stop, a hand, a cable that is in the way). Give it to the '
            'file as a contact, or record without it; numbers were fitted without these moments'
        )


def at_an_end(problem: Problem, final: Fit, without: Sequence[Fit]) -> frozenset[int]:
    """
    Return the causes that nothing asks for but one end of a pulley's range.

    :param problem: the data.
    :param final: with all causes.
    :param without: the fit without each of them.
    :return: those that are worth next to nothing once the bins there are left out.
    """
    found: set[int] = set()
    if all(cause.instants for cause in final.model.causes):
        return frozenset()
    every = list(_ends(problem, final.model))
    for k, (cause, rest) in enumerate(zip(final.model.causes, without, strict=True)):
        if cause.instants:  # whoever pushes may do so while it stands
            continue
        worth = (rest.cost - final.cost) / len(final.left)
        gained = np.maximum(rest.left**2 - final.left**2, 0.0)
        for end in _with_much(problem, every, gained):
            one = problem.leaving_out(end.bins)
            with_it, without_it = (
                one.fitted(model, rounds=8, accuracy=1e-2) for model in (final.model, rest.model)
            )
            if without_it.cost - with_it.cost < ELSEWHERE * worth * len(with_it.left):
                found.add(k)
                break
    return frozenset(found)


def end_of_all(problem: Problem, state: Fit) -> End | None:
    """
    Return the end of a pulley's range at which all lies that stays of a gap.

    :param problem: the data.
    :param state: the fit of what is believed.
    :return: the end; None where there is none, or nothing stays.
    """
    stays = problem.structured(state.left)
    if stays < WHERE:
        return None
    for end in _with_much(problem, _ends(problem, state.model), state.left**2):
        one = problem.leaving_out(end.bins)
        rest = one.fitted(state.model, rounds=8, accuracy=1e-2)
        if one.structured(rest.left) < ELSEWHERE * stays:
            return end
    return None


def _ends(problem: Problem, model: Model) -> Iterator[End]:
    """Yield the ends of the range of each pulley, of recordings that end alike together."""
    segments = problem.rollouts.segments
    instrument = problem.rollouts.instrument
    states = problem.rollouts.states(problem.uses(model))
    free = [~(np.abs(s.contact_force) > 0.0).any(axis=1) for s in states]
    for i, pulley in enumerate(instrument.pulleys):
        angles = [s.angle[:, i] for s in states]
        counts = [
            s.resolution for s in instrument.sensors if (s.kind, s.of) == ('angle', pulley.name)
        ]
        whole = max(a.max() for a in angles) - min(a.min() for a in angles)
        near = max(NEAR * whole, COUNTS * max(counts, default=0.0))
        for side in (1.0, -1.0):
            tops = [float((side * a).max()) for a in angles]
            for top in sorted(set(tops)):
                alike = [abs(one - top) <= near for one in tops]
                bins = tuple(
                    (side * a >= top - near) & own & here
                    for a, own, here in zip(angles, free, alike, strict=True)
                )
                among = sum(a.size for a, here in zip(angles, alike, strict=True) if here)
                if 0 < sum(int(one.sum()) for one in bins) < THERE * among:
                    names = [s.name for s, here in zip(segments, alike, strict=True) if here]
                    yield End(pulley.name, side * top, tuple(names), bins)


def _with_much(problem: Problem, ends: Iterable[End], power: FloatArray) -> list[End]:
    """Return the ends at which much of a power per sample lies, most first."""
    whole = max(float(power.sum()), 1e-300)
    parts = [(float(power[problem.sampled(end.bins)].sum()) / whole, end) for end in ends]
    most = sorted((one for one in parts if one[0] > MUCH), key=lambda one: -one[0])
    return [end for _, end in most]
