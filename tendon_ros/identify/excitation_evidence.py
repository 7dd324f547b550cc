"""
How far apart two explanations are in an experiment, and how long it takes to tell them apart.

Fisher information: the difference between what the one predicts and the closest imitation that the
other reaches, its own parameters free and the instrument's numbers within their tolerances.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: of a signature that the law of the catalogue may miss, since no law is quite that of the machine
FORM = 0.08
ENOUGH = 5.0  # deviations after which one of the two is believed
#: cycles of one experiment that are thought of
CYCLES = (1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 30, 50, 100)


@dataclass(frozen=True)
class Evidence:
    """
    What the channels of one cycle hold, in noise deviations.

    ``products``, shape (1 + unknowns, 1 + unknowns): scalar products of the difference, first, and
    of the derivatives by all unknowns. ``prior``, shape (unknowns,): of each, the inverse of its
    variance before the experiment. ``signature``: squared norm of what the one does to the
    channels. ``cycle`` [s].
    """

    products: FloatArray
    prior: FloatArray
    signature: float
    cycle: float

    @classmethod
    def joined(cls, parts: Iterable[Evidence]) -> Evidence:
        """
        Return what several channels hold together.

        :param parts: of the same experiment and unknowns.
        :return: the evidence.
        """
        own = list(parts)
        products = np.sum([p.products for p in own], axis=0)
        signature = sum(p.signature for p in own)
        return cls(products, own[0].prior, signature, own[0].cycle)

    def imitation(self) -> FloatArray:
        """
        Return the unknowns with which the other comes closest.

        :return: shape (unknowns,).
        """
        return self._solved(1.0)

    def distance(self, cycles: float) -> float:
        """
        Return the deviations between the two, the imitation as close as it can be.

        :param cycles: how often the motion is repeated.
        :return: deviations; what the catalogue's law may miss is taken off.
        """
        across = self.products[0, 1:]
        square = cycles * (self.products[0, 0] - across @ self._solved(cycles))
        form = FORM * np.sqrt(cycles * self.signature)
        return float(np.sqrt(max(square, 0.0)) - form)

    @property
    def rate(self) -> float:
        """Deviations after the first second, growing with the root of time; not negative."""
        return max(0.0, self.distance(1.0) / float(np.sqrt(self.cycle)))

    @property
    def seconds(self) -> float:
        """Time until the two are apart [s], in whole cycles; infinite beyond the longest."""
        for cycles in CYCLES:
            if self.distance(cycles) >= ENOUGH:
                return cycles * self.cycle
        return float('inf')

    def _solved(self, cycles: float) -> FloatArray:
        normal = cycles * self.products[1:, 1:] + np.diag(self.prior)
        # what leaves no trace and is not bounded either is left alone
        scale = np.sqrt(np.maximum(np.diag(normal), 1e-12))
        even = normal / np.outer(scale, scale) + 1e-9 * np.eye(len(scale))
        right = cycles * self.products[1:, 0] / scale
        solved: FloatArray = np.linalg.solve(even, right) / scale
        return solved
