"""
One cable as numbers: tension against elongation, in the form that the kernel reads.

The curve is the monotone cubic (PCHIP) through the points given, resampled on a uniform grid so
that a cell is found by one multiplication. Below the first point the cable is slack, at the first
tension; beyond the last one the curve goes on straight.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from tendon_ros.model.instrument import Curve

FloatArray = NDArray[np.float64]

#: most cells of a resampled curve
MOST_CELLS = 512

#: cells of a curve that was bent
BENT_CELLS = 32

#: how far the resampled curve may be from the one through the points, relative to the tension
CLOSE = 1e-4


class UniformCubic(NamedTuple):
    """
    A curve in equal cells.

    ``start`` [m]; ``rate`` cells per metre; ``coefficients`` [N], shape (cells, 4): with u from 0
    to 1 in a cell the tension is ``c0 + u (c1 + u (c2 + u c3))``. Monotone, once differentiable.
    """

    start: float
    rate: float
    coefficients: FloatArray


def uniform_cubic(curve: Curve, cells: int | None = None) -> UniformCubic:
    """
    Return a curve resampled on a uniform grid.

    :param curve: the points.
    :param cells: how many; where None, as many as a close fit takes, up to :data:`MOST_CELLS`.
        Equally spaced points are met exactly.
    :return: the curve as the kernel reads it; its coefficients are read-only.
    """
    return _chosen(curve) if cells is None else _resampled(curve, cells)


def tension_at(curve: Curve, elongation: FloatArray | float) -> FloatArray:
    """
    Return the tension of one cable.

    :param curve: its curve.
    :param elongation: [m], any shape.
    :return: [N], same shape.
    """
    start, rate, cubic = _chosen(curve)
    return _evaluated(start, rate, cubic, np.asarray(elongation, dtype=np.float64))


@lru_cache(maxsize=1024)
def elongation_at(curve: Curve, tension: float) -> float:
    """
    Return the elongation at which a cable has a tension.

    :param curve: its curve.
    :param tension: [N]; at or below the first point's, the cable is at that point.
    :return: [m], the least where several have it.
    """
    start, rate, cubic = _chosen(curve)
    knots = np.append(cubic[:, 0], cubic[-1].sum())
    if tension <= knots[0]:
        return start
    if tension > knots[-1]:
        slope = rate * float(cubic[-1] @ (0.0, 1.0, 2.0, 3.0))
        # a curve that ends flat has no such elongation
        return start + len(cubic) / rate + (tension - knots[-1]) / slope if slope else np.inf
    cell = int(np.searchsorted(knots, tension)) - 1
    c0, c1, c2, c3 = cubic[cell].tolist()
    low, high, u = 0.0, 1.0, 0.5
    # Newton within a bracket: sure where the slope is nearly zero, quick elsewhere
    for _ in range(60):
        gap = c0 + u * (c1 + u * (c2 + u * c3)) - tension
        low, high = (low, u) if gap >= 0.0 else (u, high)
        slope = c1 + u * (2.0 * c2 + 3.0 * u * c3)
        guess = u - gap / slope if slope > 0.0 else low
        if abs(guess - u) <= 1e-15:
            break
        u = guess if low < guess < high else 0.5 * (low + high)
    return start + (cell + u) / rate


def _evaluated(start: float, rate: float, cubic: FloatArray, x: FloatArray) -> FloatArray:
    """Return the tension [N] as the kernel computes it."""
    u = np.maximum((x - start) * rate, 0.0)
    cell = np.minimum(u, len(cubic) - 1).astype(np.int64)
    inside = np.minimum(u - cell, 1.0)
    beyond = np.maximum(u - len(cubic), 0.0)
    c0, c1, c2, c3 = np.moveaxis(cubic[cell], -1, 0)
    slope = c1 + inside * (2.0 * c2 + 3.0 * inside * c3)
    value: FloatArray = c0 + inside * (c1 + inside * (c2 + inside * c3)) + beyond * slope
    return value


@lru_cache(maxsize=64)
def hardened(curve: Curve, exponent: float) -> Curve:
    """
    Return a curve bent by a power of the elongation: its ends stay where they are.

    :param curve: the points.
    :param exponent: on the elongation from start to end; one changes nothing.
    :return: the bent curve.
    """
    if exponent == 1.0:
        return curve
    start, end = curve.elongation[0], curve.elongation[-1]
    part = np.linspace(0.0, 1.0, BENT_CELLS + 1)
    tension = tension_at(curve, start + (end - start) * part**exponent)
    elongation = tuple(float(x) for x in start + (end - start) * part)
    return Curve(curve.name, elongation, tuple(float(t) for t in tension))


@lru_cache(maxsize=64)
def _chosen(curve: Curve) -> UniformCubic:
    """Return the coarsest grid that is close to the curve through the points."""
    x = np.array(curve.elongation)
    fine = np.unique(np.concatenate([np.linspace(a, b, 9) for a, b in pairwise(x)]))
    exact = PchipInterpolator(x, curve.tension)(fine)
    allowed = CLOSE * np.maximum(exact, 1e-3 * exact[-1])
    cells = len(x) - 1
    while cells < MOST_CELLS:
        cable = _resampled(curve, cells)
        if np.all(np.abs(_evaluated(*cable, fine) - exact) <= allowed):
            return cable
        cells *= 2
    return _resampled(curve, MOST_CELLS)


def _resampled(curve: Curve, cells: int) -> UniformCubic:
    through = PchipInterpolator(curve.elongation, curve.tension)
    start, end = curve.elongation[0], curve.elongation[-1]
    knots = np.linspace(start, end, cells + 1)
    width = (end - start) / cells
    value = np.maximum.accumulate(through(knots))
    slope = np.maximum(through.derivative()(knots), 0.0) * width
    rise = np.diff(value)
    # Fritsch and Carlson: a cell whose end slopes are at most three times its rise is monotone
    most = 3.0 * np.minimum(np.append(rise, rise[-1]), np.insert(rise, 0, rise[0]))
    slope = np.minimum(slope, most)
    coefficients = np.stack(
        [
            value[:-1],
            slope[:-1],
            3.0 * rise - 2.0 * slope[:-1] - slope[1:],
            slope[:-1] + slope[1:] - 2.0 * rise,
        ],
        axis=1,
    )
    coefficients.flags.writeable = False
    return UniformCubic(start, cells / (end - start), coefficients)
