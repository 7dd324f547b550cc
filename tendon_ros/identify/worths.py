"""What each cause of a fit is worth: how much misfit would grow without it, to first order."""

from __future__ import annotations

import math

import numpy as np

from tendon_ros.identify.fit import Fit, Problem


def worths(problem: Problem, fit: Fit) -> list[float]:
    """
    Return by how much squares would grow, to first order, were each cause left out.

    :param problem: the fitted bins.
    :param fit: the fit.
    :return: one for each cause; infinite for one whose size is no number of its own, and for all
        of a fit that could not be computed.
    """
    if not math.isfinite(fit.cost):
        return [math.inf] * len(fit.model.causes)
    slope = fit.slope * problem.free(fit)
    products = slope.T @ slope + np.diag(problem.prior(fit.model) + 1e-9)
    x = problem.pack(fit.model)
    found = []
    at = 0
    for cause in fit.model.causes:
        gone = np.array([at + n for n in cause.coordinates.sizes], dtype=np.int64)
        stays = np.setdiff1d(
            np.arange(len(x)), np.arange(at, at + len(cause.parameters)), assume_unique=True
        )
        at += len(cause.parameters)
        if not gone.size:
            found.append(math.inf)
            continue
        step = -x[gone]
        # what stays makes up for it as far as it can
        across = products[np.ix_(stays, gone)] @ step
        made_up = np.linalg.solve(products[np.ix_(stays, stays)], across)
        here = slope[:, gone] @ step
        grown = float(here @ here) + 2.0 * float(here @ fit.left)
        found.append(max(0.0, grown - float(across @ made_up)))
    return found
