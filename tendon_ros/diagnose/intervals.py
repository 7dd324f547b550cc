"""
Intervals that respect correlated residuals.

What is left of a fit is not white: the form of a law is never quite right, motion is smoothed,
friction remembers. Samples within a block count as one piece of evidence (White's sandwich with
blocks as clusters), so that a thousand samples of one hold are not a thousand proofs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

CLUSTER = 1.0  # [s] of samples that count as one piece of evidence
#: relative error of a size that the form of a law leaves, one deviation
SIZE_FORM = 0.02


def deviations(problem: Problem, fit: Fit) -> FloatArray:
    """
    Return the standard deviations of all unknowns on their axes.

    :param problem: the data.
    :param fit: the fit.
    :return: shape (unknowns,), in the order of the fit.
    """
    axes = problem.axes(fit.model)
    prior = np.array([axis.spread**-2 for axis in axes])
    inverse = problem.covariance(fit)
    meat = np.diag(prior)
    cluster = problem.clusters(CLUSTER)
    scores = fit.slope * fit.left[:, None]
    sums = np.zeros((int(cluster.max()) + 1 if len(cluster) else 1, len(axes)))
    np.add.at(sums, cluster, scores)
    meat = meat + sums.T @ sums
    variance = np.diag(inverse @ meat @ inverse)
    return np.sqrt(np.maximum(variance, np.diag(inverse)))


def parameter_intervals(problem: Problem, fit: Fit) -> list[dict[str, tuple[float, float]]]:
    """
    Return the 95 % intervals of every cause's parameters.

    :param problem: the data.
    :param fit: the fit.
    :return: for each cause, low and high by parameter, in its unit.
    """
    spread = deviations(problem, fit)
    axes = problem.axes(fit.model)
    reach = float(student.ppf(0.975, 20))
    found = []
    at = 0
    for k, cause in enumerate(fit.model.causes):
        values = fit.model.values(k)
        row: dict[str, tuple[float, float]] = {}
        for p, z in zip(cause.parameters, fit.model.z[k], strict=True):
            axis = axes[at]
            wide = spread[at]
            if not p.is_shape and not axis.log:
                wide = float(np.hypot(wide, SIZE_FORM * abs(z)))
            ends = axis.value(z - reach * wide), axis.value(z + reach * wide)
            row[p.name] = (min(*ends, values[p.name]), max(*ends, values[p.name]))
            at += 1
        found.append(row)
    return found


def mean_square_interval(squares: Sequence[float]) -> tuple[float, float]:
    """
    Return the 95 % interval of a root mean square from those of blocks.

    :param squares: mean squares of blocks that are nearly independent.
    :return: low and high of the root.
    """
    values = np.asarray(squares, dtype=np.float64)
    if len(values) < 2:
        root = float(np.sqrt(values.mean())) if len(values) else 0.0
        return root, root
    half = float(student.ppf(0.975, len(values) - 1) * values.std(ddof=1) / np.sqrt(len(values)))
    mean = float(values.mean())
    return float(np.sqrt(max(mean - half, 0.0))), float(np.sqrt(mean + half))
