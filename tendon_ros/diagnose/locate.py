"""Shares of the gap by place and regime: those of the causes, and of what stays unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.places import Places
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.result import Where
from tendon_ros.diagnose.where import regimes
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

SHOWN = 0.02  # shares below this are not listed
FIRST = 3  # places of what stays, beside those that no channel tells from the first


@dataclass(frozen=True)
class Whereabouts:
    """
    Where the gap lies, most first; and where and when what stays unexplained does.

    After the first of the unexplained places come those that no channel tells from it.
    """

    listed: tuple[Where, ...]
    unexplained: tuple[str, ...]
    unexplained_regime: str


def whereabouts(
    ready: Prepared, found: Found, accepted: Sequence[int], believed: Fit, left: float
) -> Whereabouts:
    """
    Share the gap out among places and regimes.

    :param ready: the problem.
    :param found: what the search has found.
    :param accepted: which of its causes are believed.
    :param believed: the fit with these alone: a doubted cause says nothing of the place.
    :param left: structured misfit that stays, in noise power per sample.
    :return: the shares.
    """
    problem = ready.problem
    texts = _regimes_of(problem)
    powers: dict[tuple[str, str], float] = {}
    # what laws may get wrong is doubted there, and yet it is a gap that they explain
    doubted = problem.doubted
    explained = max(0.0, float(doubted @ (found.start.left**2 - believed.left**2)))
    gains = {k: doubted * (found.without[k].left ** 2 - found.final.left**2) for k in accepted}
    worths = {k: max(float(gain.sum()), 1e-9) for k, gain in gains.items()}
    for k in accepted:
        gain = np.maximum(gains[k], 0.0)
        part = explained * worths[k] / sum(worths.values())
        _spread(powers, found.final.model.causes[k].place, gain, texts, part)
    rest, blamed = _blamed(problem, believed, left * len(believed.left), texts)
    for key, value in rest.items():
        powers[key] = powers.get(key, 0.0) + value
    whole = sum(powers.values()) + 1e-30
    listed = [
        Where(place=p, regime=r, share=min(1.0, v / whole))
        for (p, r), v in powers.items()
        if v / whole >= SHOWN
    ]
    by_regime: dict[str, float] = {}
    for (_, regime), value in rest.items():
        by_regime[regime] = by_regime.get(regime, 0.0) + value
    return Whereabouts(
        tuple(sorted(listed, key=lambda w: -w.share)),
        blamed,
        max(by_regime, key=lambda r: by_regime[r]) if by_regime else '',
    )


def _blamed(
    problem: Problem, believed: Fit, stays: float, texts: NDArray[np.str_]
) -> tuple[dict[tuple[str, str], float], tuple[str, ...]]:
    """Share out what stays; the places with it, most first, and who is the same as the first."""
    rest: dict[tuple[str, str], float] = {}
    if not stays > 0.0:
        return rest, ()
    taken = [one for one in Places(problem, believed).shares() if one.power.sum() > 0.0]
    total = sum(float(one.power.sum()) for one in taken)
    for one in taken:
        part = stays * float(one.power.sum()) / total
        _spread(rest, one.place, np.maximum(one.power, 0.0), texts, part)
    order = sorted(taken, key=lambda one: -float(one.power.sum()))[:FIRST]
    same = [place for first in order[:1] for place in first.same]
    names = [one.place for one in order]
    return rest, tuple(dict.fromkeys([*names[:1], *same, *names[1:]]))


def _spread(
    powers: dict[tuple[str, str], float],
    place: str,
    gain: FloatArray,
    texts: NDArray[np.str_],
    whole: float,
) -> None:
    """Add a power at a place, shared among regimes as the gain is."""
    total = float(gain.sum())
    if total <= 0.0:
        return
    for regime in np.unique(texts):
        part = float(gain[texts == regime].sum()) / total
        if part > 0.0:
            key = (place, str(regime))
            powers[key] = powers.get(key, 0.0) + whole * part


def _regimes_of(problem: Problem) -> NDArray[np.str_]:
    """Return the regime of each sample."""
    states = problem.rollouts.states([()] * len(problem.rollouts.segments))
    forces = [np.abs(s.contact_force).max(axis=1, initial=0.0) for s in states]
    instrument = problem.rollouts.instrument
    driven = [instrument.index(name) for name in instrument.driven]
    texts = [
        regimes(segment, state.velocity[:, driven].T, force)
        for segment, state, force in zip(problem.rollouts.segments, states, forces, strict=True)
    ]
    rows = [texts[n][problem.masks[n][c]] for n, c, _ in problem.spans()]
    return np.concatenate(rows)
