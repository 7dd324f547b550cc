"""
What a model leaves of the recordings, sample by sample, in deviations of the noise.

Channels and recordings lie one after the other in one vector, so that fits need not know of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import bristles, Model
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.step_size import fineness, ROUGHER, STEPS
from tendon_ros.identify.tolerance import Tolerance
from tendon_ros.model.instrument import EffectUse

FloatArray = NDArray[np.float64]

FEW = 5  # recordings that a first look takes of many
SUDDEN = 0.08  # [s] about an event in which misfit hardly counts: no slip is as sudden as its law


class Residuals:
    """
    What a model leaves of the recordings.

    :param rollouts: the model and what was measured.
    :param tolerances: what may move.
    :param used: which bins count, one mask a segment, shape (bins,) or (channels, bins).
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
        self._used = tuple(used)
        self._masks = tuple(
            np.isfinite(measured) & mask
            for measured, mask in zip(rollouts.measured, used, strict=True)
        )
        self._asked = tuple(bool(mask.any()) for mask in self._masks)
        self._noise = tuple(
            np.array([m.doubt for m in s.measured]).reshape(-1, len(s.time))
            for s in self._segments
        )

        times = [np.broadcast_to(s.time, m.shape)[m] for s, m in zip(
            self._segments, self._masks, strict=True)]  # fmt: skip
        self._time = np.concatenate(times)
        self._segment = np.repeat(np.arange(len(times)), [len(t) for t in times])

    def rougher(self) -> Self:
        """
        Return what first looks need: rougher rollouts of a few recordings.

        Of many runs, evenly picked ones tell which way to go.
        """
        roughest = STEPS[0] * fineness(self.rollouts.instrument)
        rough = min(roughest, ROUGHER * self.rollouts.tolerance)
        count = len(self._segments)
        picked = np.unique(np.linspace(0, count - 1, min(count, FEW)).round().astype(int))
        rollouts = self.rollouts.like([self._segments[n] for n in picked], rough)
        return type(self)(rollouts, self.tolerances, [self._used[n] for n in picked])

    def toleranced(self, tolerances: Sequence[Tolerance]) -> Self:
        """
        Return the same data with other tolerances.

        :param tolerances: what may move.
        :return: the problem.
        """
        return type(self)(self.rollouts, tolerances, self._used)

    def leaving_out(self, bins: Sequence[NDArray[np.bool_]]) -> Self:
        """
        Return the problem without some bins.

        :param bins: which do not count, one mask a segment, shape (bins,) or (channels, bins).
        :return: the problem.
        """
        used = [own & ~out for own, out in zip(self._used, bins, strict=True)]
        return type(self)(self.rollouts, self.tolerances, used)

    @property
    def masks(self) -> tuple[NDArray[np.bool_], ...]:
        """Which samples count: one (channels, bins) a segment."""
        return self._masks

    @property
    def by_misfit(self) -> bool:
        """Whether channels weigh by what a model left of them, beside their noise."""
        return any(m.misfit > 0.0 for s in self._segments for m in s.measured)

    @property
    def empty(self) -> Model:
        """The instrument file without causes, from which fits begin."""
        return Model.of_file(self.rollouts.instrument.effects, len(self.tolerances))

    @property
    def written(self) -> Model:
        """The instrument file as it is, with friction as rigid as it says."""
        return Model((), (), {}, np.zeros(len(self.tolerances)))

    @property
    def begun(self) -> Model:
        """The instrument with its numbers where they are likely to be, from which fits begin."""
        return replace(self.empty, moved=np.array([t.axis.likely for t in self.tolerances]))

    def uses(self, model: Model) -> list[list[EffectUse]]:
        """
        Return the effects of a model for each segment.

        :param model: the model.
        :return: effects by segment.
        """
        always = [t.use(z) for t, z in self.moved(model)]
        always += bristles(model, self.rollouts.instrument.effects, self.rollouts.tolerance)
        own = [model.use(k) for k in range(len(model.causes))]
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
        return [
            (t, float(z))
            for t, z, owned in zip(self.tolerances, model.moved, self.owned(model), strict=True)
            if z != 0.0 and not owned
        ]

    def owned(self, model: Model) -> list[bool]:
        """
        Return which tolerances do not move, since a cause moves the same number.

        :param model: the model.
        :return: one a tolerance.
        """
        return [any(t.is_moved_by(c) for c in model.causes) for t in self.tolerances]

    def left(self, model: Model, among: Sequence[bool] | None = None) -> FloatArray:
        """
        Return what is left of each sample that counts, in noise deviations.

        :param model: the model.
        :param among: of each segment whether it is asked for; all where None.
        :return: measured less predicted, shape (samples,); of what was not asked for, nothing that
            means anything.
        """
        asked = self._asked if among is None else np.logical_and(self._asked, among).tolist()
        predicted = self.rollouts.predicted(self.uses(model), asked)
        left = self.flat([m - p for m, p in zip(self.rollouts.measured, predicted, strict=True)])
        for k, cause in enumerate(model.causes):
            self.forgive(left, cause, model.values(k))
        return left

    def forgive(self, left: FloatArray, cause: Candidate, values: Mapping[str, float]) -> None:
        """
        Cut short what is left about the ends of an event: how it came about is not its law.

        :param left: what is left, shape (samples,); it is changed.
        :param cause: an event, or one that has no ends.
        :param values: of its parameters.
        """
        for instant in cause.changes(values):
            near = self._near(cause, instant)
            left[near] = np.clip(left[near], -2.0, 2.0)

    def predicted(self, model: Model) -> FloatArray:
        """
        Return what a model predicts of each sample that counts, in noise deviations.

        :param model: the model.
        :return: shape (samples,).
        """
        return self.flat(self.rollouts.predicted(self.uses(model), self._asked))

    def acting(self, cause: Candidate) -> tuple[list[bool], NDArray[np.bool_]]:
        """
        Return where a cause acts.

        :param cause: the cause.
        :return: in which segments; in which samples.
        """
        segments = [cause.acts_in(s.name) for s in self._segments]
        return segments, np.array(segments)[self._segment]

    def _near(self, cause: Candidate, instant: float) -> NDArray[np.bool_]:
        """Return the samples so near an event that how it came about matters."""
        near: NDArray[np.bool_] = np.abs(self._time - instant) < SUDDEN
        _, there = self.acting(cause)
        return near & there

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

    def sampled[T: np.generic](self, rows: Sequence[NDArray[T]]) -> NDArray[T]:
        """
        Return something known of every bin, for each sample that counts.

        :param rows: one array (bins,) or (channels, bins) a segment.
        :return: shape (samples,).
        """
        parts = [
            np.broadcast_to(row, mask.shape)[mask]
            for row, mask in zip(rows, self._masks, strict=True)
        ]
        return np.concatenate(parts)

    @cached_property
    def resting(self) -> Mapping[str, NDArray[np.bool_]]:
        """By pulley place which samples are torques of its motor while it rests."""
        motors = self.rollouts.instrument.motors
        rows = {
            f'pulley_{motor.pulley}': [np.zeros(m.shape, dtype=np.bool_) for m in self._masks]
            for motor in motors
        }
        for n, segment in enumerate(self._segments):
            for row, j, still in segment.at_rest(self.rollouts.instrument):
                rows[f'pulley_{motors[j].pulley}'][n][row] = still
        return {place: self.sampled(of_place) for place, of_place in rows.items()}

    @cached_property
    def doubted(self) -> FloatArray:
        """By how many times the power laws make each sample more doubtful, shape (samples,)."""
        rows = [np.array([m.without_laws for m in s.measured]) for s in self._segments]
        parts = [row.reshape(mask.shape) for row, mask in zip(rows, self._masks, strict=True)]
        return np.asarray(self.flat(parts) ** -2)

    def clusters(self, length: float) -> NDArray[np.int64]:
        """
        Return which stretch of time each sample belongs to.

        :param length: of a stretch [s].
        :return: numbers from zero, shape (samples,).
        """
        own = np.floor(self._time / length).astype(np.int64)
        _, numbered = np.unique(np.stack([self._segment, own]), axis=1, return_inverse=True)
        return numbered.reshape(-1).astype(np.int64)

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

    def channels(self) -> dict[str, NDArray[np.bool_]]:
        """Return by channel which samples of a vector are its own, of all segments together."""
        spans = self.spans()
        count = spans[-1][2].stop if spans else 0
        found: dict[str, NDArray[np.bool_]] = {}
        for n, c, span in spans:
            name = self._segments[n].measured[c].sensor.channel
            found.setdefault(name, np.zeros(count, dtype=np.bool_))[span] = True
        return found

    def groups(self, vector: FloatArray) -> list[tuple[int, int, FloatArray]]:
        """
        Take a vector of samples apart again.

        :param vector: shape (samples,).
        :return: segment, channel, and its samples in the order of time.
        """
        return [(n, c, vector[span]) for n, c, span in self.spans()]
