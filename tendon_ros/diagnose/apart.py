"""
Whether what stays is an effect that had another size in each recording.

A motor gets warm, a cable is tightened, a joint is homed again: no effect that lasts tells of it,
and fitted to all recordings at once each of them is off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.naming import NAMED
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.effects import find
from tendon_ros.identify.beside import Beside
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: part of what stays that has to go, and by how much another effect may be behind the best in that
#: and still be the one
TELLS, ALIKE = 0.6, 0.05
#: effects that a closer look is taken at; recordings that it is taken at most with
CLOSER, MOST = 6, 12
FARTHEST = 30.0  # typical sizes that an effect may differ by
REPEATS = 0.5  # noise power from which on what differs between repetitions is looked into
DIFFERS = 0.5  # part of what one size for all recordings leaves that other sizes leave at most


@dataclass(frozen=True)
class Apart:
    """
    An effect that may have had another size in each recording.

    ``values``: by recording its parameters, SI units; ``goes``: part of what stays that goes with
    them; ``alike``: other effects that would do as much.
    """

    candidate: Candidate
    values: Mapping[str, Mapping[str, float]]
    goes: float
    alike: tuple[Candidate, ...] = ()


@dataclass(frozen=True)
class _Look:
    """
    A first look at an effect.

    ``model``: with the effect in each recording for itself, sizes as far apart as they like, and
    ``together`` with one size for all; ``gain``: by how much squares fall, to first order.
    """

    candidate: Candidate
    model: Model
    together: Model
    gain: float


def disagreement(
    ready: Prepared, final: Fit, candidates: Sequence[Candidate], beyond: float
) -> Apart | None:
    """
    Return the effect by which recordings disagree, if they do.

    What differs where a motion is repeated is noise to a diagnosis; here it may have a reason.

    :param ready: the problem.
    :param final: what was found.
    :param candidates: effects that may be asked for.
    :param beyond: probability that something of the gap has a cause that was not named.
    :return: the effect; None where none explains much.
    """
    if not 2 <= len(_recordings(ready.problem)) <= MOST:
        return None
    again = ready.unrepeated(final.model)
    if again is ready:
        return apart(ready.problem, final, candidates) if beyond >= NAMED else None
    fit = again.problem.fitted(final.model, rounds=0)
    differs = again.problem.structured(fit.left) > REPEATS
    return apart(again.problem, fit, candidates) if differs else None


def apart(problem: Problem, fit: Fit, candidates: Sequence[Candidate]) -> Apart | None:
    """
    Return the effect that explains most of what stays where it has its own size in each recording.

    :param problem: the bins of several recordings.
    :param fit: of what is believed.
    :param candidates: effects that may be asked for.
    :return: the simplest of those that explain most of it; None where none does.
    """
    own = _recordings(problem)
    stays = problem.structured(fit.left)
    if not stays > 0.0:
        return None
    beside = Beside(problem, fit)

    def look(candidate: Candidate) -> _Look | None:
        return _look(problem, fit, beside, candidate, own)

    lasting = [c for c in candidates if not c.instants and c.coordinates.sizes]
    looks = [one for one in problem.rollouts.each(look, lasting) if one is not None]
    closer = [
        _closer(problem, fit, stays, list(own), one)
        for one in sorted(looks, key=lambda one: -one.gain)[:CLOSER]
    ]
    found = [one for one in closer if one is not None]
    most = max((one.goes for one in found), default=0.0)
    if most < TELLS:
        return None
    best, *others = sorted(
        (one for one in found if one.goes > most - ALIKE),
        key=lambda one: (one.candidate.price, -one.goes),
    )
    return replace(best, alike=tuple(one.candidate for one in others))


def apart_words(one: Apart) -> str:
    """
    Say what was another one in each recording.

    :param one: the effect.
    :return: a sentence.
    """
    parts = []
    for name, values in one.values.items():
        sizes = [
            f'{p.name} {values[p.name]:.3g}{"" if p.unit == "1" else " " + p.unit}'
            for p in one.candidate.parameters
            if not p.is_shape
        ]
        parts.append(f'{", ".join(sizes)} in {name}')
    what, *others = (
        f'{find(c.effect).title.lower()} at {c.place}' for c in (one.candidate, *one.alike)
    )
    instead = f'; or {" or ".join(others)}' if others else ''
    return (
        f'the recordings disagree: {one.goes:.0%} of what stays goes where {what} is another one '
        f'in each ({"; ".join(parts)}{instead}). Something was not the same then (warmth, load, a '
        'cable tightened, a joint homed again): diagnose recordings of one state apart from the '
        'others'
    )


def _recordings(problem: Problem) -> dict[str, NDArray[np.bool_]]:
    """Return by recording which samples are its own, of those that have any."""
    segments = problem.rollouts.segments
    owner = problem.sampled([np.full(len(s.time), n) for n, s in enumerate(segments)])
    return {segments[n].name: owner == n for n in np.unique(owner).tolist()}


def _look(
    problem: Problem,
    fit: Fit,
    beside: Beside,
    candidate: Candidate,
    own: Mapping[str, NDArray[np.bool_]],
) -> _Look | None:
    """Return what an effect explains to first order; None where it changes nothing."""
    whole = [k for k, c in enumerate(fit.model.causes) if replace(c, only='') == candidate]
    numbers = problem.moved(fit.model)
    values = {
        **candidate.as_given,
        **{t.parameter: t.axis.value(z) for t, z in numbers if t.is_moved_by(candidate)},
    }
    if whole:
        values = fit.model.values(whole[0])
    model = fit.model.without(*whole)
    first = len(model.causes)
    for name in own:
        model = model.joined(replace(candidate, only=name), values)
    axes, sizes = candidate.coordinates.axes, candidate.coordinates.sizes
    begun = np.array(model.z[first])[list(sizes)]
    ends = np.array([axes[n].ends for n in sizes])
    changes = []
    for n in range(len(sizes)):
        step = 1.0 if begun[n] + 1.0 <= ends[n, 1] else -1.0
        steps = np.zeros((len(own), len(sizes)))
        steps[:, n] = step
        # beside a size that is none already, another changes nothing
        now = problem.left(_stepped(model, first, sizes, steps))
        changes.append((now - fit.left) / step)
    change = np.array(changes)
    if not np.isfinite(change).all() or not change.any():
        return None
    columns = np.concatenate([np.where(there, change, 0.0) for there in own.values()]).T
    reach = np.clip(ends - begun[:, None], -FARTHEST, FARTHEST).T
    stood_for = _stood_for(problem, fit, candidate)
    gain, steps = beside.best(columns, np.tile(reach, len(own)), stood_for)
    moved = _stepped(model, first, sizes, steps.reshape(len(own), len(sizes)))
    _, steps = beside.best(change.T, reach, stood_for)
    one = fit.model.without(*whole).joined(candidate, values)
    return _Look(candidate, moved, _stepped(one, first, sizes, steps[None]), gain)


def _stepped(model: Model, first: int, sizes: Sequence[int], steps: FloatArray) -> Model:
    """Return a model whose causes from one on have gone along their sizes, within their ends."""
    rows = list(model.z)
    for k, own in enumerate(steps, first):
        row, axes = list(rows[k]), model.causes[k].coordinates.axes
        for n, step in zip(sizes, own.tolist(), strict=True):
            low, high = axes[n].ends
            row[n] = min(max(row[n] + step, low), high)
        rows[k] = tuple(row)
    return replace(model, z=tuple(rows))


def _stood_for(problem: Problem, fit: Fit, candidate: Candidate) -> list[int]:
    """Return the unknowns of a fit that an effect's sizes stand for."""
    first = fit.slope.shape[1] - len(problem.tolerances)
    found = [first + n for n, t in enumerate(problem.tolerances) if t.is_moved_by(candidate)]
    at = 0
    for cause in fit.model.causes:
        if replace(cause, only='') == candidate:
            found += [at + n for n in cause.coordinates.sizes]
        at += len(cause.parameters)
    return found


def _closer(
    problem: Problem, fit: Fit, stays: float, names: Sequence[str], one: _Look
) -> Apart | None:
    """Return an effect as fits have it in each recording; None where one size does as well."""
    known = problem.slopes(fit)
    refit, together = (
        problem.fitted(model, known, rounds=4, accuracy=1e-2)
        for model in (one.model, one.together)
    )
    left = problem.structured(refit.left)
    if left > DIFFERS * problem.structured(together.left):
        return None
    first = len(refit.model.causes) - len(names)
    return Apart(
        candidate=one.candidate,
        values={name: refit.model.values(first + k) for k, name in enumerate(names)},
        goes=1.0 - left / stays,
    )
