"""Fractions with their intervals, and how well stated probabilities come true."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np
from scipy.stats import binom


@dataclass(frozen=True)
class Fraction:
    """``count`` of ``of``, with Wilson's 95 % interval."""

    count: int
    of: int

    @property
    def value(self) -> float:
        """The fraction, NaN of nothing."""
        return self.count / self.of if self.of else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's score interval at 95 %, everything of nothing."""
        if not self.of:
            return 0.0, 1.0
        z = 1.959964
        share, weight = self.value, z * z / self.of
        middle = (share + 0.5 * weight) / (1.0 + weight)
        half = z * math.sqrt(share * (1.0 - share) / self.of + weight / (4.0 * self.of))
        half /= 1.0 + weight
        return max(0.0, middle - half), min(1.0, middle + half)

    def __str__(self) -> str:
        if not self.of:
            return '–'
        low, high = self.interval
        return f'{100 * self.value:.0f} % ({100 * low:.0f}–{100 * high:.0f})'


@dataclass(frozen=True)
class Bin:
    """Probabilities that are alike: their mean, and how many of them came true."""

    stated: float
    true: Fraction


BINS = 10


def reliability(chances: Sequence[tuple[float, bool]]) -> tuple[Bin, ...]:
    """
    Return stated probabilities against what came true, in ten bins of equal width.

    :param chances: probability, and whether it came true.
    :return: the bins that hold something.
    """
    result = []
    for n in range(BINS):
        inside = [c for c in chances if min(int(c[0] * BINS), BINS - 1) == n]
        if inside:
            mean = sum(p for p, _ in inside) / len(inside)
            result.append(Bin(mean, Fraction(sum(true for _, true in inside), len(inside))))
    return tuple(result)


def calibration_error(bins: Sequence[Bin]) -> float:
    """
    Return the expected calibration error.

    :param bins: of :func:`reliability`.
    :return: mean distance between stated and true, weighted by the bins' counts; NaN of nothing.
    """
    total = sum(b.true.of for b in bins)
    if not total:
        return math.nan
    return sum(b.true.of * abs(b.true.value - b.stated) for b in bins) / total


def error_by_chance(bins: Sequence[Bin]) -> float:
    """
    Return the calibration error to expect where every stated probability is right.

    A few probabilities never come true in just the parts that they state.

    :param bins: of :func:`reliability`.
    :return: the mean of :func:`calibration_error`; NaN of nothing.
    """
    total = sum(b.true.of for b in bins)
    if not total:
        return math.nan
    expected = 0.0
    for b in bins:
        counts = np.arange(b.true.of + 1)
        off = np.abs(counts - b.true.of * b.stated)
        expected += float(off @ binom.pmf(counts, b.true.of, b.stated))
    return expected / total
