"""
Fits: causes with their parameters, together with what the file's tolerances let move.

Weighted least squares with priors, by Levenberg and Marquardt. Derivatives are differences of
rollouts; those by the tolerances are shared by all fits that begin from one state, since a percent
of inertia acts the same whatever else is there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.effects import find
from tendon_ros.identify.axis import Axis, axis_of
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.tolerance import Tolerance
from tendon_ros.model.instrument import EffectUse

FloatArray = NDArray[np.float64]

FLOOR = 0.95  # mean square of a channel, in noise deviations, that is its floor
NEIGHBOURS = 5  # bins between which noise is a difference and motion is not
RETIMED = (-0.08, -0.04, -0.02, -0.01, 0.01, 0.02, 0.04, 0.08)  # [s] that events are tried at
SUDDEN = 0.08  # [s] about an event in which misfit hardly counts: no slip is as sudden as its law

#: dry friction builds up over a fraction of a degree in every bearing that was ever measured; what
#: takes more than its upper end is pre-sliding friction by name
BRISTLE = Axis('angle', 'rad', 1e-6, 3e-3, 1e-3, math.log(4.0), log=True, spread=1.0)


@dataclass(frozen=True)
class Model:
    """
    Causes with places on their axes, and what else moves.

    ``z``: for each cause the places of its parameters; ``bristle``: by pulley place, for dry
    friction without a pre-sliding angle of its own; ``moved``: of each tolerance, in its
    deviations, shape (tolerances,).
    """

    causes: tuple[Candidate, ...]
    z: tuple[tuple[float, ...], ...]
    bristle: Mapping[str, float]
    moved: FloatArray

    def values(self, k: int) -> dict[str, float]:
        """
        Return the parameters of a cause.

        :param k: which.
        :return: values by name, SI units.
        """
        cause = self.causes[k]
        return {
            p.name: axis_of(p).value(z) for p, z in zip(cause.parameters, self.z[k], strict=True)
        }

    def without(self, k: int) -> Model:
        """
        Return the model without one cause, nothing refitted.

        :param k: which.
        :return: the smaller model.
        """
        causes = self.causes[:k] + self.causes[k + 1 :]
        left = _dry_places(causes)
        return Model(
            causes,
            self.z[:k] + self.z[k + 1 :],
            {place: z for place, z in self.bristle.items() if place in left},
            self.moved,
        )

    def joined(self, cause: Candidate, values: Mapping[str, float]) -> Model:
        """
        Return the model with one more cause.

        :param cause: the cause.
        :param values: of its parameters.
        :return: the larger model.
        """
        causes = (*self.causes, cause)
        row = tuple(axis_of(p).place(values[p.name]) for p in cause.parameters)
        bristle = {place: self.bristle.get(place, 0.0) for place in _dry_places(causes)}
        return Model(causes, (*self.z, row), bristle, self.moved)


def _dry_places(causes: Sequence[Candidate]) -> list[str]:
    """Return the pulleys whose dry friction needs an angle to build up over."""
    dry = {c.place for c in causes if find(c.effect).hook == 'budget'}
    own = {c.place for c in causes if c.effect == 'presliding_friction'}
    return sorted(dry - own)


def bristles(model: Model) -> list[EffectUse]:
    """
    Return the effects that let dry friction build up over an angle.

    :param model: the model.
    :return: one effect for each pulley with dry friction.
    """
    return [
        EffectUse('presliding_friction', place, {'torque': 0.0, 'angle': BRISTLE.value(z)})
        for place, z in model.bristle.items()
    ]


def _instants(cause: Candidate, values: Mapping[str, float]) -> list[float]:
    """Return when something suddenly changes."""
    begun = [values[p.name] for p in cause.instants]
    lasts = [values[p.name] for p in cause.parameters if p.search == 'duration']
    return begun + [a + b for a in begun for b in lasts]


@dataclass(frozen=True)
class Fit:
    """
    A fitted model.

    ``left``: what is left of each sample, in noise deviations; ``slope``: its derivative by all
    unknowns, causes first, then bristles, then tolerances; ``cost``: squares of both ``left`` and
    the priors.
    """

    model: Model
    left: FloatArray
    slope: FloatArray
    cost: float


class Problem:
    """
    The recordings as a least-squares problem.

    :param rollouts: the model and what was measured.
    :param tolerances: what may move.
    :param used: which bins count, one mask (bins,) a segment.
    """

    def __init__(
        self,
        rollouts: Rollouts,
        tolerances: Sequence[Tolerance],
        used: Sequence[NDArray[np.bool_]],
    ) -> None:
        self.rollouts = rollouts
        self.tolerances = tuple(tolerances)
        self._segments = rollouts.segments
        self._masks = tuple(
            np.isfinite(measured) & mask
            for measured, mask in zip(rollouts.measured, used, strict=True)
        )
        self._noise = tuple(
            np.array([m.noise for m in s.measured]).reshape(-1, len(s.time))
            for s in self._segments
        )

        times = [np.broadcast_to(s.time, m.shape)[m] for s, m in zip(
            self._segments, self._masks, strict=True)]  # fmt: skip
        self._time = np.concatenate(times)
        self._segment = np.repeat(np.arange(len(times)), [len(t) for t in times])

    @property
    def masks(self) -> tuple[NDArray[np.bool_], ...]:
        """Which samples count: one (channels, bins) a segment."""
        return self._masks

    @property
    def empty(self) -> Model:
        """The instrument file as it is."""
        return Model((), (), {}, np.zeros(len(self.tolerances)))

    def uses(self, model: Model) -> list[list[EffectUse]]:
        """
        Return the effects of a model for each segment.

        :param model: the model.
        :return: effects by segment.
        """
        always = [
            EffectUse(t.effect, t.place, {find(t.effect).parameters[0].name: t.axis.value(z)})
            for t, z in self.moved(model)
        ]
        always += bristles(model)
        own = [cause.use(model.values(k)) for k, cause in enumerate(model.causes)]
        return [
            always + [use for c, use in zip(model.causes, own, strict=True) if c.acts_in(s.name)]
            for s in self._segments
        ]

    def moved(self, model: Model) -> list[tuple[Tolerance, float]]:
        """
        Return the tolerances that have moved, but for those that a cause stands for.

        :param model: the model.
        :return: each with its place on its axis.
        """
        owned = {(c.effect, c.place) for c in model.causes}
        return [
            (t, float(z))
            for t, z in zip(self.tolerances, model.moved, strict=True)
            if z != 0.0 and (t.effect, t.place) not in owned
        ]

    def left(self, model: Model) -> FloatArray:
        """
        Return what is left of each sample that counts, in noise deviations.

        :param model: the model.
        :return: measured less predicted, shape (samples,).
        """
        predicted = self.rollouts.predicted(self.uses(model))
        left = self.flat([m - p for m, p in zip(self.rollouts.measured, predicted, strict=True)])
        for k, cause in enumerate(model.causes):
            for instant in _instants(cause, model.values(k)):
                near = self._near(cause, instant)
                left[near] = np.clip(left[near], -2.0, 2.0)
        return left

    def _near(self, cause: Candidate, instant: float) -> NDArray[np.bool_]:
        """Return the samples so near an event that how it came about matters."""
        acting = np.array([cause.acts_in(s.name) for s in self._segments])
        near: NDArray[np.bool_] = np.abs(self._time - instant) < SUDDEN
        there: NDArray[np.bool_] = near & acting[self._segment]
        return there

    def flat(self, rows: Sequence[FloatArray]) -> FloatArray:
        """
        Return arrays (channels, bins) as one vector of what counts, in noise deviations.

        :param rows: one array a segment.
        :return: shape (samples,).
        """
        parts = [
            (row / noise)[mask]
            for row, noise, mask in zip(rows, self._noise, self._masks, strict=True)
        ]
        return np.concatenate(parts)

    def clusters(self, length: float) -> NDArray[np.int64]:
        """
        Return which stretch of time each sample belongs to.

        :param length: of a stretch [s].
        :return: numbers from zero, shape (samples,).
        """
        own = np.floor(self._time / length).astype(np.int64)
        _, numbered = np.unique(np.stack([self._segment, own]), axis=1, return_inverse=True)
        return numbered.reshape(-1).astype(np.int64)

    def pieces(self, length: float) -> NDArray[np.int64]:
        """
        Return which piece of a recording each sample belongs to, whatever its channel.

        :param length: of a piece [s].
        :return: numbers from zero, shape (samples,).
        """
        return self.clusters(length)

    def spans(self) -> list[tuple[int, int, slice]]:
        """Return segment, channel, and where its samples lie in a vector."""
        found = []
        at = 0
        for n, mask in enumerate(self._masks):
            for c, row in enumerate(mask):
                count = int(row.sum())
                found.append((n, c, slice(at, at + count)))
                at += count
        return found

    def structured(self, left: FloatArray) -> float:
        """
        Return the power of what is left that is not noise: what neighbouring bins share.

        :param left: what is left, shape (samples,).
        :return: mean square in noise deviations, noise taken off.
        """
        return self.structures(left)[0]

    def structures(self, left: FloatArray) -> tuple[float, float]:
        """
        Return the same over all samples, and in the channel that has most of it.

        :param left: what is left, shape (samples,).
        :return: mean squares in noise deviations, noise taken off.
        """
        power: dict[str, list[float]] = {}
        for n, c, own in self.groups(left):
            if len(own) <= NEIGHBOURS:
                continue
            step = own[NEIGHBOURS:] - own[:-NEIGHBOURS]
            noise = 0.5 * float(step @ step) * len(own) / len(step)
            # what keeps below the floor is no gap, whatever its shape: counts of a still encoder
            beyond = min(float(own @ own) - noise, float(own @ own) - FLOOR * len(own))
            entry = power.setdefault(self._segments[n].measured[c].sensor.channel, [0.0, 0.0])
            entry[0] += max(0.0, beyond)
            entry[1] += len(own)
        whole = sum(e[0] for e in power.values()) / max(sum(e[1] for e in power.values()), 1.0)
        return whole, max((e[0] / e[1] for e in power.values() if e[1]), default=0.0)

    def groups(self, vector: FloatArray) -> list[tuple[int, int, FloatArray]]:
        """
        Take a vector of samples apart again.

        :param vector: shape (samples,).
        :return: segment, channel, and its samples in the order of time.
        """
        found = []
        at = 0
        for n, mask in enumerate(self._masks):
            for c, row in enumerate(mask):
                count = int(row.sum())
                found.append((n, c, vector[at : at + count]))
                at += count
        return found

    # -- unknowns as one vector

    def pack(self, model: Model) -> FloatArray:
        """Return the unknowns of a model as one vector: causes, bristles, tolerances."""
        own = [z for row in model.z for z in row]
        return np.array([*own, *model.bristle.values(), *model.moved])

    def unpack(self, like: Model, x: FloatArray) -> Model:
        """Return the model with the unknowns of a vector."""
        rows = []
        at = 0
        for row in like.z:
            rows.append(tuple(float(z) for z in x[at : at + len(row)]))
            at += len(row)
        bristle = {p: float(z) for p, z in zip(like.bristle, x[at:], strict=False)}
        at += len(bristle)
        return Model(like.causes, tuple(rows), bristle, x[at:].copy())

    def axes(self, model: Model) -> list[Axis]:
        """Return the axes of all unknowns, in their order."""
        own = [axis_of(p) for c in model.causes for p in c.parameters]
        return [*own, *(BRISTLE for _ in model.bristle), *(t.axis for t in self.tolerances)]

    def labels(self, model: Model) -> list[str]:
        """Return a name for each unknown that holds in any model which has it."""
        own = [
            f'{c.effect}@{c.place}@{c.only}.{p.name}' for c in model.causes for p in c.parameters
        ]
        moved = [f'{t.place}.{t.quantity}' for t in self.tolerances]
        return [*own, *(f'{place}.bristle' for place in model.bristle), *moved]

    def slope(self, model: Model, left: FloatArray, columns: Sequence[int]) -> FloatArray:
        """
        Return derivatives of what is left.

        :param model: where.
        :param left: what is left there.
        :param columns: of which unknowns.
        :return: shape (samples, columns).
        """
        x = self.pack(model)
        axes = self.axes(model)
        found = np.empty((len(left), len(columns)))
        for n, j in enumerate(columns):
            high = axes[j].ends[1]
            step = 0.02 * max(1.0, abs(x[j])) if not axes[j].log else 0.05
            if axes[j].spread == 1.0:
                step = 0.5
            if x[j] + step > high:
                step = -step
            moved = x.copy()
            moved[j] += step
            change = (self.left(self.unpack(model, moved)) - left) / step
            found[:, n] = change if np.isfinite(change).all() else 0.0
        return found

    def fitted(
        self,
        model: Model,
        known: Mapping[str, FloatArray] | None = None,
        rounds: int = 12,
        accuracy: float = 1e-3,
    ) -> Fit:
        """
        Fit all unknowns of a model.

        :param model: where to begin.
        :param known: derivatives that are good enough as they are, by the unknown's label, such
            as :meth:`slopes` gives them; those by tolerances are found once where not known.
        :param rounds: at most so many.
        :param accuracy: relative gain of a round below which the fit ends.
        :return: the fit.
        """
        fit = self._descended(model, known, rounds, accuracy)
        later = self._retimed(fit)
        if later is None:
            return fit
        return self._descended(later, self.slopes(fit), rounds, accuracy)

    def _retimed(self, fit: Fit) -> Model | None:
        """
        Return a model whose events are at better times; None where they are good as they are.

        Bins make the misfit a staircase in time, on which no derivative finds its way.
        """
        x = self.pack(fit.model)
        axes = self.axes(fit.model)
        prior = np.array([axis.spread**-2 for axis in axes])
        names = [p for c in fit.model.causes for p in c.parameters]
        timed = [j for j, p in enumerate(names) if p.search == 'instant']
        best, least = None, (1.0 - 1e-3) * fit.cost
        for j in timed:
            start = x[j]
            for shift in RETIMED:
                trial = x.copy()
                trial[j] = start + shift / axes[j].scale
                left = self.left(self.unpack(fit.model, trial))
                cost = float(left @ left + prior @ trial**2)
                if cost < least:
                    best, least = trial, cost
            if best is not None:
                x = best
        return None if best is None else self.unpack(fit.model, best)

    def _descended(
        self,
        model: Model,
        known: Mapping[str, FloatArray] | None,
        rounds: int,
        accuracy: float,
    ) -> Fit:
        """Return the fit that Levenberg and Marquardt's method comes to."""
        axes = self.axes(model)
        bounds = np.array([axis.ends for axis in axes]).reshape(-1, 2)
        prior = np.array([axis.spread**-2 for axis in axes])
        own = len(axes) - len(self.tolerances)
        # a tolerance that a cause owns does not move
        owned = {(c.effect, c.place) for c in model.causes}
        still = np.array([False] * own + [(t.effect, t.place) in owned for t in self.tolerances])
        x = self.pack(model)
        x[still] = 0.0
        x = np.clip(x, bounds[:, 0], bounds[:, 1])
        left = self.left(self.unpack(model, x))
        cost = float(left @ left + prior @ x**2)
        if not math.isfinite(cost):  # the model diverges: nothing to fit from here
            return Fit(self.unpack(model, x), left, np.zeros((len(left), len(axes))), math.inf)
        labels = self.labels(model)
        slope = np.zeros((len(left), len(axes)))
        fresh = []
        once = []
        for j, label in enumerate(labels):
            if known is not None and label in known:
                slope[:, j] = known[label]
            elif j < own:
                fresh.append(j)
            elif not still[j]:
                once.append(j)
        slope[:, once] = self.slope(self.unpack(model, x), left, once)
        slope[:, still] = 0.0
        damping = 1e-3
        for _ in range(rounds):
            slope[:, fresh] = self.slope(self.unpack(model, x), left, fresh)
            normal = slope.T @ slope + np.diag(prior)
            gradient = slope.T @ left + prior * x
            before = cost
            for _ in range(6):
                scale = np.diag(np.diag(normal)) + 1e-9 * np.eye(len(x))
                # unknowns pressed against a bound stay there
                free = ~still & ~(
                    ((x <= bounds[:, 0]) & (gradient > 0.0))
                    | ((x >= bounds[:, 1]) & (gradient < 0.0))
                )
                step = np.zeros(len(x))
                step[free] = np.linalg.solve(
                    (normal + damping * scale)[np.ix_(free, free)], -gradient[free]
                )
                trial = np.clip(x + step, bounds[:, 0], bounds[:, 1])
                now = self.left(self.unpack(model, trial))
                new = float(now @ now + prior @ trial**2)
                if np.isfinite(new) and new < cost:
                    x, left, cost = trial, now, new
                    damping = max(damping * 0.2, 1e-7)
                    break
                damping *= 8.0
            if before - cost <= accuracy * before:
                break
        return Fit(self.unpack(model, x), left, slope, cost)

    def slopes(self, fit: Fit) -> dict[str, FloatArray]:
        """
        Return the derivatives of a fit by the labels of the unknowns.

        :param fit: the fit.
        :return: columns, shape (samples,) each; those of tolerances that a cause stands for are
            left out.
        """
        owned = {f'{t.place}.{t.quantity}' for t in self.tolerances} - {
            f'{t.place}.{t.quantity}'
            for t in self.tolerances
            if (t.effect, t.place) not in {(c.effect, c.place) for c in fit.model.causes}
        }
        return {
            label: fit.slope[:, j]
            for j, label in enumerate(self.labels(fit.model))
            if label not in owned
        }
