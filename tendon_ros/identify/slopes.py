"""Derivatives of what a model leaves, by its unknowns: differences of rollouts."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.explanation import Model
from tendon_ros.identify.unknowns import Unknowns

FloatArray = NDArray[np.float64]

FAINT = 0.1  # of the noise: changes below are mostly chance


class Slopes(Unknowns):
    """What a model leaves of the recordings, and how it changes."""

    def slope(
        self, model: Model, left: FloatArray, columns: Sequence[int], *, centred: bool = False
    ) -> FloatArray:
        """
        Return derivatives of what is left.

        :param model: where.
        :param left: what is left there.
        :param columns: of which unknowns.
        :param centred: whether by steps to both sides.
        :return: shape (samples, columns).
        """
        x = self.pack(model)
        axes = self.axes(model)

        def one(j: int) -> FloatArray:
            high = axes[j].ends[1]
            step = 0.02 * max(1.0, abs(x[j])) if not axes[j].log else 0.05
            if axes[j].spread == 1.0:
                step = 0.5
            step = step if x[j] + step <= high and self._reaches(model, x, j, step) else -step
            return self._change(model, left, j, step, centred=centred)

        found = np.empty((len(left), len(columns)))
        for n, column in enumerate(self.rollouts.each(one, columns)):
            found[:, n] = column
        return found

    def _reaches(self, model: Model, x: FloatArray, j: int, step: float) -> bool:
        """Return whether a step moves an unknown, which an amplitude at its end does not."""
        moved = x.copy()
        moved[j] += step
        return math.isclose(float(self.pack(self.unpack(model, moved))[j]), float(moved[j]))

    def _change(
        self, model: Model, left: FloatArray, j: int, step: float, *, centred: bool
    ) -> FloatArray:
        """
        Return the derivative of what is left by one unknown, from a step along its axis.

        Where dry friction sticks a hair earlier or later is chance: a step that changes hardly
        more than that is made longer.
        """
        x = self.pack(model)
        axis = self.axes(model)[j]
        low, high = axis.ends

        def after(step: float) -> FloatArray:
            moved = x.copy()
            moved[j] += step
            return self.left(self.unpack(model, moved))

        while True:
            change = after(step) - left
            if not np.isfinite(change).all():
                return np.zeros(len(left))
            longer = 4.0 * step
            if (
                float(change @ change) > FAINT**2 * len(left)
                or abs(longer) > 0.5
                or not low <= x[j] + longer <= high
            ):
                break
            step = longer
        if centred and low <= x[j] - step <= high:
            back = after(-step) - left
            if np.isfinite(back).all():
                # exact for what is in proportion, and in inverse proportion, to a logarithmic axis
                rate = math.sinh(axis.scale * step) / axis.scale if axis.log else step
                return np.asarray(0.5 * (change - back) / rate)
        return np.asarray(change / step)
