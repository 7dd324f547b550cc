"""Smooth functions of time for the kernel: prescribed motion, pushing torques, references."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Signals:
    """
    Cubic Hermite signals on one uniform grid, held before the first sample and after the last.

    ``value`` and ``slope``: shape (signals, samples), the slope per second; ``start`` and ``step``
    [s] place the grid.
    """

    value: FloatArray
    slope: FloatArray
    start: float
    step: float

    @property
    def flat(self) -> FloatArray:
        """The kernel's form: start, samples per second, samples, signals, values, slopes."""
        rows, samples = self.value.shape
        head = np.array([self.start, 1.0 / self.step, float(samples), float(rows)])
        return np.concatenate([head, self.value.ravel(), self.slope.ravel()])

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

        :param start: time of the first sample [s].
        :param step: between samples [s].
        :param values: shape (signals, samples).
        :return: the signals.
        """
        table = np.atleast_2d(np.asarray(values, dtype=np.float64))
        grid = step * np.arange(table.shape[1])
        slope = CubicSpline(grid, table, axis=1).derivative()(grid)
        return cls(table, slope, start, step)
