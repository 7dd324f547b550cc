"""
Intervals that respect correlated residuals.

What is left of a fit is not white: the form of a law is never quite right, motion is smoothed,
friction remembers. Samples within a block count as one piece of evidence (White's sandwich with
blocks as clusters), so that a thousand samples of one hold are not a thousand proofs.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2
from scipy.stats import t as student

from tendon_ros.base.parameter import Parameter
from tendon_ros.effects import find
from tendon_ros.identify.axis import Axis
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.identify.residuals import SUDDEN

FloatArray = NDArray[np.float64]

CLUSTER = 1.0  # [s] of samples that count as one piece of evidence
#: relative error of a size that the form of any law leaves, one deviation
SIZE_FORM = 0.02
#: times as wide as all that: of 171 parameters of published cases that were used up, 87 % lay
#: within, and 92 % within so much
WIDER = 1.3
REACH = WIDER * float(student.ppf(0.975, 20))  # deviations of an interval
SMALL = 1e-5  # step of a derivative, on an axis


def deviations(problem: Problem, fit: Fit) -> FloatArray:
    """
    Return the standard deviations of all unknowns on their axes.

    :param problem: the data.
    :param fit: the fit.
    :return: shape (unknowns,), in the order of the fit.
    """
    return Spread(problem, fit).along(np.eye(fit.slope.shape[1]))


class Spread:
    """
    How well a fit knows its unknowns.

    :param problem: the data.
    :param fit: the fit.
    :param known: unknowns that are taken for known, shape (unknowns,); none where None.
    """

    def __init__(self, problem: Problem, fit: Fit, known: NDArray[np.bool_] | None = None) -> None:
        axes = problem.axes(fit.model)
        self._white = problem.covariance(fit, None if known is None else ~known)
        cluster = problem.clusters(CLUSTER)
        scores = fit.slope * fit.left[:, None]
        sums = np.zeros((int(cluster.max()) + 1 if len(cluster) else 1, len(axes)))
        np.add.at(sums, cluster, scores)
        # a prior of so much weight is still off by one deviation
        prior = problem.prior(fit.model)
        held = prior > 0.0
        off = np.zeros(len(axes))
        off[held] = prior[held] * np.array([axis.spread for axis in axes])[held]
        meat = np.diag(off**2) + sums.T @ sums
        self._clustered = self._white @ meat @ self._white

    def along(self, directions: FloatArray) -> FloatArray:
        """
        Return the standard deviations of sums of unknowns.

        :param directions: what each unknown counts for, shape (sums, unknowns).
        :return: the larger of what white and what clustered noise leaves, shape (sums,).
        """
        found = [
            np.einsum('ij,jk,ik->i', directions, matrix, directions)
            for matrix in (self._white, self._clustered)
        ]
        return np.asarray(np.sqrt(np.maximum(*found).clip(min=0.0)), dtype=np.float64)


def parameter_intervals(
    problem: Problem, fit: Fit, known: NDArray[np.bool_] | None = None, *, laws: bool = True
) -> list[dict[str, tuple[float, float]]]:
    """
    Return the 95 % intervals of every cause's parameters.

    :param problem: the data.
    :param fit: the fit.
    :param known: unknowns that are taken for known, shape (unknowns,); none where None.
    :param laws: whether to allow for what laws get wrong, or for what the data leave open alone.
    :return: for each cause, low and high by parameter, in its unit.
    """
    spread = Spread(problem, fit, known)
    found = []
    at = 0
    for cause, z in zip(fit.model.causes, fit.model.z, strict=True):
        coordinates = cause.coordinates
        centre = coordinates.values(z)
        form = float(np.hypot(SIZE_FORM, find(cause.effect).form))
        row: dict[str, tuple[float, float]] = {}
        for n, p in enumerate(cause.parameters):
            value, axis = centre[p.name], coordinates.axes[n]
            by_form = _by_form(p, value, form) if laws else 0.0
            direction = np.zeros((1, fit.slope.shape[1]))
            if coordinates.paired(n):
                for j, step in enumerate(SMALL * np.eye(len(z))):
                    moved = coordinates.values([a + b for a, b in zip(z, step, strict=True)])
                    direction[0, at + j] = (moved[p.name] - value) / SMALL
                wide = float(np.hypot(spread.along(direction)[0], by_form))
                ends = value - REACH * wide, value + REACH * wide
                row[p.name] = max(p.low, ends[0]), min(p.high, ends[1])
                continue
            direction[0, at + n] = 1.0
            row[p.name] = _on_axis(axis, z[n], float(spread.along(direction)[0]), by_form)
        at += len(z)
        found.append(row)
    return found


def unsized(problem: Problem, fit: Fit) -> frozenset[int]:
    """
    Return the causes of which not even whether they are there can be told by their sizes.

    Where a torque constant is guessed, friction may be as small as that may be large: it is there
    all the same, whatever its unit. What the file has of it is in its own unit, and so is what a
    factor multiplies: a body that is twice as heavy may be a motor that is half as strong.

    :param problem: the data.
    :param fit: the fit.
    :return: those of which every size may as well be none, or all numbers as the file has them.
    """
    found = set()
    units = [t.guessed and t.quantity == 'torque_gain' for t in problem.tolerances]
    own = fit.slope.shape[1] - len(units)
    in_units = parameter_intervals(problem, fit, np.array([False] * own + units))
    free = parameter_intervals(problem, fit)
    # an angle that a law gets wrong is no less there
    whole = parameter_intervals(problem, fit, laws=False)
    for k, cause in enumerate(fit.model.causes):
        if cause.given:
            known = {t.parameter: t.axis for t in problem.tolerances if t.is_moved_by(cause)}
            values = cause.as_given
            if all(
                _overlap(whole[k][p.name], values[p.name], known.get(p.name))
                for p in cause.parameters
                if cause.given_size or not p.is_shape
            ):
                found.add(k)
            continue
        sizes = [
            p for p in cause.parameters if not (p.is_shape or p.search in ('share', 'switch'))
        ]
        rows = {p.name: (free if p.neutral == 1.0 else in_units)[k][p.name] for p in sizes}
        if sizes and all(rows[p.name][0] <= p.neutral <= rows[p.name][1] for p in sizes):
            found.add(k)
    return frozenset(found)


def _overlap(ends: tuple[float, float], value: float, known: Axis | None) -> bool:
    """Return whether an interval holds what the file has, or any of its tolerance."""
    low, high = (value, value) if known is None else (known.low, known.high)
    return ends[0] <= high and ends[1] >= low


def number_intervals(
    problem: Problem, fit: Fit, others: Sequence[Model] = ()
) -> list[tuple[float, float]]:
    """
    Return the 95 % intervals of the numbers of the file that may move.

    :param problem: the data.
    :param fit: the fit.
    :param others: other explanations that may hold as well; what a guess is in them lies within,
        too.
    :return: low and high of each tolerance, in the unit of its axis.
    """
    own = fit.slope.shape[1] - len(problem.tolerances)
    known = deviations(problem, fit)[own:]
    found = []
    for n, (t, z, s) in enumerate(
        zip(problem.tolerances, fit.model.moved, known.tolist(), strict=True)
    ):
        if not t.guessed:
            found.append(_on_axis(t.axis, z, s, 0.0))
            continue
        # what laws get wrong pulls at a guess as it does at a size
        ends = _on_axis(t.axis, z, s, SIZE_FORM * abs(t.axis.value(z)))
        values = [t.axis.value(float(other.moved[n])) for other in others]
        found.append((min(ends[0], *values), max(ends[1], *values)) if values else ends)
    return found


def _on_axis(axis: Axis, z: float, deviation: float, by_form: float) -> tuple[float, float]:
    """Return an interval about a place, of its deviation there and that of its value by form."""
    value = axis.value(z)
    own = by_form / (axis.scale * (abs(value) + 1e-30 if axis.log else 1.0))
    wide = REACH * float(np.hypot(deviation, own))
    ends = axis.value(z - wide), axis.value(z + wide)
    return min(*ends, value), max(*ends, value)


def _by_form(parameter: Parameter, value: float, form: float) -> float:
    """
    Return what the form of a law leaves open of a parameter, one deviation in its unit.

    A size may be off by as much as the law is, what shapes the law by twice as much; no event is
    as sudden as its law.
    """
    if parameter.search in ('instant', 'duration'):
        return SUDDEN / 4.0
    if parameter.search in ('phase', 'share'):
        return form
    if parameter.search == 'cycles':  # waves are counted along the whole way
        return SIZE_FORM * abs(value)
    if parameter.search in ('level', 'rest'):
        return form * abs(value)
    return 2.0 * form * abs(value) if parameter.is_shape else form * abs(value - parameter.neutral)


def mean_square_interval(squares: Sequence[float]) -> tuple[float, float]:
    """
    Return the 95 % interval of a root mean square from those of blocks.

    :param squares: mean squares of blocks that are nearly independent.
    :return: low and high of the root; of a single block, as of one draw from a normal
        distribution: from half of it to thirty times as much.
    """
    values = np.asarray(squares, dtype=np.float64)
    if len(values) < 2:
        root = float(np.sqrt(values.sum()))
        low, high = (root / math.sqrt(chi2.ppf(part, 1)) for part in (0.975, 0.025))
        return low, high
    half = float(student.ppf(0.975, len(values) - 1) * values.std(ddof=1) / np.sqrt(len(values)))
    mean = float(values.mean())
    return float(np.sqrt(max(mean - half, 0.0))), float(np.sqrt(mean + half))
