"""What causes of a fit are worth: how much misfit would grow without them, to first order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math

import numpy as np

from tendon_ros.identify.fit import Fit, Problem

#: part of its size that is added to each unknown's: two may do the very same
SAME = 1e-10


def worths(problem: Problem, fit: Fit) -> list[float]:
    """
    Return by how much squares would grow, to first order, were each cause left out.

    :param problem: the fitted bins.
    :param fit: the fit.
    :return: one for each cause; infinite for one whose size is no number of its own, and for all
        of a fit that could not be computed.
    """
    grows = growth(problem, fit)
    return [grows([k]) for k in range(len(fit.model.causes))]


def growth(problem: Problem, fit: Fit) -> Callable[[Sequence[int]], float]:
    """
    Return what tells by how much squares would grow, to first order, without some of the causes.

    :param problem: the fitted bins.
    :param fit: the fit.
    :return: from the numbers of causes that are left out together to the growth; infinite where
        one has no number for its size, and where the fit could not be computed.
    """
    if not math.isfinite(fit.cost):
        return lambda _which: math.inf
    slope = fit.slope * problem.free(fit)
    products = slope.T @ slope + np.diag(problem.prior(fit.model) + 1e-9)
    # of size one, so that two that do the very same can still be solved for
    size = np.sqrt(np.diag(products))
    products = products / np.outer(size, size) + SAME * np.eye(len(size))
    x = problem.pack(fit.model)
    begins = np.cumsum([0, *(len(c.parameters) for c in fit.model.causes)]).tolist()

    def grows(which: Sequence[int]) -> float:
        sizes = [fit.model.causes[k].coordinates.sizes for k in which]
        if not all(sizes):
            return math.inf
        gone = [begins[k] + n for k, own in zip(which, sizes, strict=True) for n in own]
        theirs = [j for k in which for j in range(begins[k], begins[k + 1])]
        stays = np.setdiff1d(np.arange(len(x)), theirs)
        step = -x[gone]
        # what stays makes up for it as far as it can
        across = products[np.ix_(stays, gone)] @ (size[gone] * step)
        made_up = np.linalg.solve(products[np.ix_(stays, stays)], across)
        here = slope[:, gone] @ step
        grown = float(here @ here) + 2.0 * float(here @ fit.left)
        return max(0.0, grown - float(across @ made_up))

    return grows
