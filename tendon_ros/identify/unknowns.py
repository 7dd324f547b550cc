"""
The unknowns of a model as one vector: causes, bristles, tolerances, in this order.

What a fit moves, how far each may go, what a deviation costs before any data, and its name.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.axis import Axis
from tendon_ros.identify.explanation import BRISTLES, Model
from tendon_ros.identify.structure import Structure

FloatArray = NDArray[np.float64]

#: time over which what is left remembers itself [s]: so many values count as one against a prior
REMEMBERED = 0.4


class Unknowns(Structure):
    """What a model leaves of the recordings, by the vector of its unknowns."""

    def pack(self, model: Model) -> FloatArray:
        """Return the unknowns of a model as one vector: causes, bristles, tolerances."""
        own = [z for row in model.z for z in row]
        return np.array([*own, *model.bristle.values(), *model.moved])

    def unpack(self, like: Model, x: FloatArray) -> Model:
        """Return the model with the unknowns of a vector."""
        rows = []
        at = 0
        for cause, row in zip(like.causes, like.z, strict=True):
            rows.append(cause.coordinates.within([float(z) for z in x[at : at + len(row)]]))
            at += len(row)
        bristle = {key: float(z) for key, z in zip(like.bristle, x[at:], strict=False)}
        at += len(bristle)
        return replace(like, z=tuple(rows), bristle=bristle, moved=x[at:].copy())

    def axes(self, model: Model) -> list[Axis]:
        """Return the axes of all unknowns, in their order."""
        own = [axis for c in model.causes for axis in c.coordinates.axes]
        bent = [BRISTLES[name] for _, name in model.bristle]
        return [*own, *bent, *(t.axis for t in self.tolerances)]

    def prior(self, model: Model) -> FloatArray:
        """
        Return what a deviation of each unknown costs before any data.

        What is left of a wrong model is no noise: its bins repeat each other. Counted one by one,
        they would move any number of the file to the end of its tolerance, and let friction
        tremble until it lets go of whatever it is not.

        :param model: whose unknowns.
        :return: by the square of how far it is off, shape (unknowns,).
        """
        repeated = max(1.0, REMEMBERED / self.rollouts.segments[0].spacing)
        return np.array(
            [(repeated if a.repeated else 1.0) * a.spread**-2 for a in self.axes(model)]
        )

    def likely(self, model: Model) -> FloatArray:
        """Return where each unknown is likely to be before any data, shape (unknowns,)."""
        return np.array([a.likely for a in self.axes(model)])

    def off(self, model: Model) -> FloatArray:
        """Return how far each unknown is from there, on its axis, shape (unknowns,)."""
        return self.pack(model) - self.likely(model)

    def still(self, model: Model) -> NDArray[np.bool_]:
        """Return which unknowns do not move: tolerances that a cause owns, shape (unknowns,)."""
        own = sum(map(len, model.z)) + len(model.bristle)
        return np.array([False] * own + self.owned(model))

    def labels(self, model: Model) -> list[str]:
        """Return a name for each unknown that holds in any model which has it."""
        own = [
            f'{c.effect}@{c.place}@{c.only}.{p.name}' for c in model.causes for p in c.parameters
        ]
        moved = [f'{t.place}.{t.quantity}' for t in self.tolerances]
        bent = [f'{place}.bristle.{name}' for place, name in model.bristle]
        return [*own, *bent, *moved]
