"""Smooth functions of time for the kernel: prescribed motion, pushing torques, references."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, make_interp_spline, PchipInterpolator

FloatArray = NDArray[np.float64]

DEGREE = 5  # of the spline that tells the second derivative of something smooth


@dataclass(frozen=True)
class Signals:
    """
    Cubic Hermite signals on one uniform grid, held before the first sample and after the last.

    ``value`` and ``slope``: shape (signals, samples), the slope per second; ``start`` and ``step``
    [s] place the grid. ``bend``, of the same shape: by how much the second derivative is more than
    that of the cubic, straight between samples; nowhere where None.
    """

    value: FloatArray
    slope: FloatArray
    start: float
    step: float
    bend: FloatArray | None = None

    @property
    def flat(self) -> FloatArray:
        """The kernel's form: start, samples a second, samples, signals, values, slopes, bends."""
        rows, samples = self.value.shape
        head = np.array([self.start, 1.0 / self.step, float(samples), float(rows)])
        rest = self.value, self.slope, self.bends
        return np.concatenate([head, *(table.ravel() for table in rest)])

    @property
    def bends(self) -> FloatArray:
        """The bend of all signals, shape (signals, samples)."""
        return np.zeros_like(self.value) if self.bend is None else self.bend

    @classmethod
    def none(cls) -> Signals:
        """Return no signals at all."""
        return cls(np.zeros((0, 1)), np.zeros((0, 1)), 0.0, 1.0)

    @classmethod
    def held(cls, values: FloatArray) -> Signals:
        """
        Return signals that do not change.

        :param values: shape (signals,).
        :return: the signals.
        """
        column = np.asarray(values, dtype=np.float64).reshape(-1, 1)
        return cls(column, np.zeros_like(column), 0.0, 1.0)

    @classmethod
    def straight(cls, start: float, gap: float, before: FloatArray, after: FloatArray) -> Signals:
        """
        Return signals that go straight from one place to another.

        :param start: when [s].
        :param gap: how long [s].
        :param before: values at first, shape (signals,).
        :param after: values at last, shape (signals,).
        :return: the signals.
        """
        slope = (after - before) / gap
        return cls(np.stack([before, after], 1), np.stack([slope, slope], 1), start, gap)

    @classmethod
    def through(cls, start: float, step: float, values: FloatArray) -> Signals:
        """
        Return monotone signals through samples: no overshoot at a step.

        :param start: time of the first sample [s].
        :param step: between samples [s].
        :param values: shape (signals, samples).
        :return: the signals.
        """
        table = np.atleast_2d(np.asarray(values, dtype=np.float64))
        grid = step * np.arange(table.shape[1])
        slope = PchipInterpolator(grid, table, axis=1).derivative()(grid)
        return cls(table, slope, start, step)

    @classmethod
    def smooth(cls, start: float, step: float, values: FloatArray) -> Signals:
        """
        Return twice differentiable signals through samples of something smooth: measured motion.

        A cubic spline makes the second derivative of a wave of w radians a sample too large by
        w^2 / 12: a tenth where a loop shakes with six samples a period. One of degree five makes
        it too large by w^4 / 720 and is right to a quarter of a percent there.

        :param start: time of the first sample [s].
        :param step: between samples [s].
        :param values: shape (signals, samples).
        :return: the signals.
        """
        table = np.atleast_2d(np.asarray(values, dtype=np.float64))
        grid = step * np.arange(table.shape[1])
        cubic = CubicSpline(grid, table, axis=1)
        bend = None
        if table.shape[1] > DEGREE:
            bend = make_interp_spline(grid, table, k=DEGREE, axis=1)(grid, 2) - cubic(grid, 2)
        return cls(table, cubic(grid, 1), start, step, bend)
