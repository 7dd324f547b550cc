"""What a diagnosis rests on, for the report: signals, the steps taken, what was weighed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


#: times that a guess is off by, from which on one doubts the units of what was recorded
ABSURD = 10.0
#: times as much as the least that it may be, up to which a guess may be anything
ANYTHING = 100.0


@dataclass(frozen=True)
class Trace:
    """
    One channel of one recording, measured and predicted, all of shape (n,) in ``unit``.

    ``before`` is the prediction of the instrument file, ``after`` with the effects found.
    ``held_out`` marks samples that no fit has seen.
    """

    recording: str
    channel: str
    unit: str
    time: FloatArray
    measured: FloatArray
    before: FloatArray
    after: FloatArray
    held_out: NDArray[np.bool_]


@dataclass(frozen=True)
class Step:
    """
    One step of the explanation: what joined, and the gap after it, in noise standard deviations.

    ``gap`` on fitted data, ``held_out`` on data that no fit has seen; the first step has no
    effect: it is the instrument file with its parameters moved within their tolerances.
    """

    effect: str
    place: str
    gap: float
    held_out: float


@dataclass(frozen=True)
class Floor:
    """The noise floor of a channel, in its unit, and how it was found."""

    channel: str
    unit: str
    value: float
    how: str


#: deviations from what the file says that a number which was measured hardly is
STRAINED = 2.0
#: deviations by which one is at the end of its tolerance
ENDED = 2.9


@dataclass(frozen=True)
class Moved:
    """
    A number of the instrument file that moved within its tolerance: factor or addition.

    ``guessed``: the file says that it is no more than a guess. ``off``: by how many deviations of
    its tolerance it has moved; of a guess none. ``supposed``: the file does not say how well it
    knows the number, and the tolerance is the usual one.
    """

    place: str
    quantity: str
    value: float
    ci95: tuple[float, float]
    unit: str
    guessed: bool = False
    off: float = 0.0
    supposed: bool = False

    @property
    def strained(self) -> bool:
        """Whether it has moved as far as what was measured hardly can: a fault may hide in it."""
        return self.off > STRAINED

    @property
    def ended(self) -> bool:
        """Whether it has moved to the end of its tolerance."""
        return self.off >= ENDED

    @property
    def untold(self) -> bool:
        """Whether a guess may still be nearly anything."""
        low, high = self.ci95
        return self.guessed and self.unit == '1' and low * ANYTHING < high

    @property
    def absurd(self) -> bool:
        """Whether a guess is off by so much that a unit is more likely than a bad guess."""
        if not self.guessed or self.unit != '1':
            return False
        low, high = self.ci95
        return (self.value < 1.0 / ABSURD and high < 2.0 / ABSURD) or (
            self.value > ABSURD and low > 0.5 * ABSURD
        )


@dataclass(frozen=True)
class Rival:
    """A candidate's shrink when it alone is added: part of the gap's square that it removes."""

    effect: str
    place: str
    share: float


@dataclass(frozen=True)
class Told:
    """
    What one recording alone says of the size of a cause.

    ``why``: why it says nothing, where it does not: the cause leaves ``no trace`` there, or
    ``others do the same``.
    """

    recording: str
    effect: str
    place: str
    parameter: str
    unit: str
    value: float
    ci95: tuple[float, float]
    why: str


@dataclass(frozen=True)
class Evidence:
    """Everything the report shows beside the verdict."""

    instrument: str
    recordings: tuple[str, ...]
    traces: tuple[Trace, ...]
    closed_loop: tuple[Trace, ...]
    steps: tuple[Step, ...]
    floors: tuple[Floor, ...]
    moved: tuple[Moved, ...]
    told: tuple[Told, ...]
    rivals: tuple[Rival, ...]
    seconds: float
