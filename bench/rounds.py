"""Interleaved rounds: what is compared runs in turn, so that noise hits all alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import time

import numpy as np


@dataclass(frozen=True)
class Timing:
    """Times of one contestant over all rounds [s], and its ratio to the first, round by round."""

    name: str
    median: float
    best: float
    ratio: float
    spread: tuple[float, float]


def interleaved(contestants: Mapping[str, Callable[[], object]], rounds: int = 15) -> list[Timing]:
    """
    Time functions in turn.

    :param contestants: by name; ratios are to the first one.
    :param rounds: how often each runs, after one run that does not count.
    :return: one timing each; the ratio is the median over rounds, its spread the quartiles.
    """
    times = np.zeros((rounds, len(contestants)))
    for call in contestants.values():
        call()
    for n in range(rounds):
        for c, call in enumerate(contestants.values()):
            begun = time.perf_counter()
            call()
            times[n, c] = time.perf_counter() - begun
    ratios = times / times[:, :1]
    return [
        Timing(
            name,
            float(np.median(times[:, c])),
            float(times[:, c].min()),
            float(np.median(ratios[:, c])),
            (float(np.quantile(ratios[:, c], 0.25)), float(np.quantile(ratios[:, c], 0.75))),
        )
        for c, name in enumerate(contestants)
    ]
