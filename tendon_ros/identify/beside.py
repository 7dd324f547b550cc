"""What a change explains beside everything that may move within its bounds, to first order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

NARROW = 1e-9  # bounds are at least so far apart


class Beside:
    """
    Solves for the sizes of a change and for all unknowns of a state together.

    :param problem: the data.
    :param fit: the state.
    """

    def __init__(self, problem: Problem, fit: Fit) -> None:
        x = problem.pack(fit.model)
        prior = problem.prior(fit.model)
        ends = np.array([axis.ends for axis in problem.axes(fit.model)]).reshape(-1, 2).T
        self._slope = fit.slope
        off = problem.off(fit.model)
        self._held = prior * off**2
        self._left = fit.left
        self._products = fit.slope.T @ fit.slope + np.diag(prior)
        self._pull = fit.slope.T @ fit.left + prior * off
        self._bounds = np.stack([ends[0] - x, ends[1] - x])
        self._alone = self._solved(self._products, self._pull, self._bounds)[0]

    def best(
        self, changes: FloatArray, reach: FloatArray, still: Sequence[int]
    ) -> tuple[float, FloatArray]:
        """
        Return what changes explain.

        :param changes: what each size changes by one, shape (samples, sizes).
        :param reach: how far each size may go, shape (2, sizes).
        :param still: unknowns that the change takes the place of: they do not move beside it, and
            nothing holds them back any more.
        :return: by how much squares fall, and the sizes, shape (sizes,).
        """
        across = self._slope.T @ changes
        products = np.block([[self._products, across], [across.T, changes.T @ changes]])
        pull = np.concatenate([self._pull, changes.T @ self._left])
        bounds = np.concatenate([self._bounds, reach], axis=1)
        bounds[:, list(still)] = 0.0
        freed = float(self._held[list(still)].sum())
        fall, found = self._solved(products, pull, bounds)
        return max(0.0, fall - self._alone + freed), found[len(self._pull) :]

    def _solved(
        self, products: FloatArray, pull: FloatArray, bounds: FloatArray
    ) -> tuple[float, FloatArray]:
        """Return by how much squares fall within bounds, and where."""
        scale = np.sqrt(np.diag(products)) + 1e-12
        scaled = products / np.outer(scale, scale) + 1e-9 * np.eye(len(scale))
        root = np.linalg.cholesky(scaled).T
        wanted = -np.linalg.solve(root.T, pull / scale)
        low, high = bounds * scale
        high = np.maximum(high, low + NARROW)
        found = lsq_linear(root, wanted, (low, high), method='bvls').x
        return float(wanted @ wanted - np.sum((root @ found - wanted) ** 2)), found / scale
