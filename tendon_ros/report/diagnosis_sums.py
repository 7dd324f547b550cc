"""The sums that the words of a diagnosis rest on: gaps in noise floors, shares by place."""

from __future__ import annotations

import numpy as np

from tendon_ros.diagnose.result import ChannelGap, Diagnosis, Where


def overall(diagnosis: Diagnosis) -> tuple[float, float]:
    """Return the gap before and after, over all channels, in noise standard deviations."""
    known = [in_floors(g) for g in diagnosis.gap if g.noise_floor > 0.0]
    if not known:
        return 0.0, 0.0
    before, after = np.sqrt(np.mean(np.square(known), axis=0))
    return float(before), float(after)


def fitted_alone(diagnosis: Diagnosis) -> float:
    """Return the gap with numbers fitted within their tolerances alone, as :func:`overall`."""
    known = [
        diagnosis.fitted.get(g.channel, g.before) / g.noise_floor
        for g in diagnosis.gap
        if g.noise_floor > 0.0
    ]
    return float(np.sqrt(np.mean(np.square(known)))) if known else 0.0


def in_floors(gap: ChannelGap) -> tuple[float, float]:
    """Return a channel's gap before and after by its noise floor, infinite without one."""
    if gap.noise_floor > 0.0:
        return gap.before / gap.noise_floor, gap.after / gap.noise_floor
    return np.inf, np.inf


def floor_of(diagnosis: Diagnosis, channel: str) -> float:
    """Return the noise floor of a channel in its unit, 0 where it is not known."""
    return next((g.noise_floor for g in diagnosis.gap if g.channel == channel), 0.0)


def by_place(where: tuple[Where, ...]) -> dict[str, float]:
    """Return the share of each place over all regimes, most first."""
    sums: dict[str, float] = {}
    for entry in where:
        sums[entry.place] = sums.get(entry.place, 0.0) + entry.share
    return dict(sorted(sums.items(), key=lambda item: -item[1]))
