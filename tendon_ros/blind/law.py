"""
What a law of a fault is: a change of a rig's tables by one number, its size.

Whatever else a law needs (phases, times, signs) it draws from a seed of its own, so that the same
fault can be made larger or smaller. What it returns is the truth in the words of the catalogue.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math

import numpy as np

from tendon_ros.blind import columns as k
from tendon_ros.blind.rig import Rig

Values = dict[str, float]
Apply = Callable[[Rig, int, float, np.random.Generator], Values]


@dataclass(frozen=True)
class Law:
    """
    One fault: ``apply(rig, index, size, rng)`` at ``places``, sizes from ``low`` to ``high``.

    ``event``: it happens at a time, in one recording or in all. ``places`` are full names.
    ``spread``: how many times the nuisance is one standard deviation of the same quantity.
    """

    effect: str
    places: tuple[str, ...]
    low: float
    high: float
    apply: Apply
    event: bool = False
    spread: float = 0.0


def at(kind: str, names: str) -> tuple[str, ...]:
    """Return places, for instance ``at('pulley', '1 2')``."""
    return tuple(f'{kind}_{name}' for name in names.split())


def sign(rng: np.random.Generator) -> float:
    """Return -1 or 1."""
    return float(rng.choice([-1.0, 1.0]))


def dry(rig: Rig, p: int, rest: float, angle: float) -> None:
    """Give a pulley bristles that yield ``rest`` [N m] over an angle [rad]."""
    row = rig.pulleys[p]
    row[k.BRISTLE] = max(row[k.BRISTLE], rest / angle)
    row[k.BRISTLE_DAMPING] = 0.6 * math.sqrt(row[k.BRISTLE] * min(row[k.INERTIA], 2e-4))
