"""
Fits: causes with their parameters, together with what the file's tolerances let move.

Weighted least squares with priors, by Levenberg and Marquardt. Derivatives are differences of
rollouts; those by the tolerances are shared by all fits that begin from one state, since a percent
of inertia acts the same whatever else is there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.descent import computed, Descent, follow, Place, TRIES, unpressed
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.slopes import Slopes

FloatArray = NDArray[np.float64]

#: [s] that begin and end of events are tried at, and how often
RETIMED = tuple(sign * shift for shift in (0.32, 0.16, 0.08, 0.04, 0.02, 0.01) for sign in (-1, 1))
MOVES = 2
#: on its axis: what a guess may move until its derivative has to follow; how often a rough fit
#: takes such derivatives anew where it seems to end
FAR, LOOKS = 0.3, 1
#: accuracy from which on fits are careful; and of those that look for no times of events
CAREFUL, UNTIMED = 1e-3, 2e-3


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


class Problem(Slopes):
    """The recordings as a least-squares problem."""

    def cost(self, model: Model) -> float:
        """
        Return the squares of what a model leaves and of its priors, nothing fitted.

        :param model: the model.
        :return: the cost; infinite where the model cannot be computed.
        """
        cost = self._descent(model).at(self.pack(model)).cost
        return cost if math.isfinite(cost) else math.inf

    def free(self, fit: Fit) -> NDArray[np.bool_]:
        """
        Return which unknowns of a fit can still move: those that no bound holds back.

        :param fit: the fit.
        :return: shape (unknowns,).
        """
        x = self.pack(fit.model)
        pull = fit.slope.T @ fit.left + self.prior(fit.model) * self.off(fit.model)
        return unpressed(x, self._bounds(fit.model), pull)

    def centred(self, fit: Fit) -> Fit:
        """
        Return a fit with derivatives that are good enough to say what it does not know.

        Where torques, inertias and frictions are guessed only their ratios can be known; the
        curvature in derivatives to one side would tell the rest, the surer the more data there is.

        :param fit: the fit.
        :return: the same with derivatives by steps to both sides.
        """
        moving = np.flatnonzero(~self.still(fit.model)).tolist()
        slope = np.zeros_like(fit.slope)
        slope[:, moving] = self.slope(fit.model, fit.left, moving, centred=True)
        return replace(fit, slope=slope)

    def fitted(
        self,
        model: Model,
        known: Mapping[str, FloatArray] | None = None,
        rounds: int = 12,
        accuracy: float = 1e-3,
        *,
        timed: bool = True,
    ) -> Fit:
        """
        Fit all unknowns of a model.

        :param model: where to begin.
        :param known: derivatives that are good enough as they are, by the unknown's label, such
            as :meth:`slopes` gives them; those by tolerances are found once where not known.
        :param rounds: at most so many.
        :param accuracy: relative gain of a round below which the fit ends.
        :param timed: whether a careful fit looks for when events were as well; a rough one, which
            is for comparing, does not.
        :return: the fit.
        """
        fit = self._descended(model, known, rounds, accuracy)
        careful = timed and accuracy <= CAREFUL
        return self.timed(fit, rounds, accuracy) if careful else fit

    def timed(self, fit: Fit, rounds: int, accuracy: float) -> Fit:
        """
        Return a fit whose events are where they fit best.

        :param fit: the fit.
        :param rounds: at most so many once an event has moved.
        :param accuracy: relative gain of a round below which the fit ends.
        :return: the fit; the same where they were.
        """
        for _ in range(MOVES):
            later = self._retimed(fit)
            if later is None:
                break
            fit = self._descended(later, self.slopes(fit), rounds, accuracy)
        return fit

    def _retimed(self, fit: Fit) -> Model | None:
        """
        Return a model whose events are at better times; None where they are good as they are.

        Bins make the misfit a staircase in time, on which no derivative finds its way.
        """
        x = self.pack(fit.model)
        axes = self.axes(fit.model)
        left = fit.left
        least = (1.0 - 1e-3) * fit.cost
        descent = self._descent(fit.model)
        at = 0
        for cause in fit.model.causes:
            better: Place | None = None
            segments, there = self.acting(cause)
            for move, shift in product(_moves(cause, at), RETIMED):
                trial = x.copy()
                for j, sign in move:
                    low, high = axes[j].low, axes[j].high
                    moved = axes[j].value(x[j]) + sign * shift
                    trial[j] = axes[j].place(min(max(moved, low), high))
                # nothing changes where the event does not happen
                now = self.left(self.unpack(fit.model, trial), segments)
                place = descent.placed(trial, np.where(there, now, left))
                if place.cost < least:
                    better, least = place, place.cost
            at += len(cause.parameters)
            x, left = (x, left) if better is None else (better.x, better.left)
        return None if left is fit.left else self.unpack(fit.model, x)

    def _descended(
        self,
        model: Model,
        known: Mapping[str, FloatArray] | None,
        rounds: int,
        accuracy: float,
    ) -> Fit:
        """Return the fit that Levenberg and Marquardt's method comes to."""
        axes = self.axes(model)
        own = len(axes) - len(self.tolerances)
        still = self.still(model)
        descent = self._descent(model)
        x = self.pack(model)
        x[still] = 0.0
        place = computed(descent, np.clip(x, *self._bounds(model).T), own)
        if not math.isfinite(place.cost):  # the model diverges: nothing to fit from here
            nothing = np.zeros((len(place.left), len(axes)))
            return Fit(self.unpack(model, place.x), place.left, nothing, math.inf)
        labels = self.labels(model)
        slope = np.zeros((len(place.left), len(axes)))
        fresh = []
        once = []
        guessed = []
        for j, label in enumerate(labels):
            if j >= own and not still[j] and self.tolerances[j - own].guessed:
                guessed.append(j)
            if known is not None and label in known:
                slope[:, j] = known[label]
            elif j < own:
                fresh.append(j)
            elif not still[j]:
                once.append(j)
        slope[:, once] = self.slope(self.unpack(model, place.x), place.left, once)
        slope[:, still] = 0.0
        taken = place.x
        far: list[int] = []  # guesses that have left where their derivatives were taken
        looks = LOOKS if accuracy > CAREFUL else rounds
        # the valleys of guesses are long and bent: several steps at once lead astray there
        tried = TRIES[:1] if guessed else TRIES
        anew = fresh
        told = slope[:, fresh]
        for _ in range(rounds):
            slope[:, anew] = self.slope(self.unpack(model, place.x), place.left, anew)
            anew = fresh
            told = slope[:, fresh]
            before = place.cost
            for tries in tried:
                last, place = place, descent.step(place, slope, tries, accuracy)
                far = [j for j in guessed if abs(place.x[j] - taken[j]) > FAR]
                follow(slope, far if guessed else fresh, last, place)
                if last.cost - place.cost <= accuracy * last.cost:
                    break
            if before - place.cost <= accuracy * before:
                if not far or not looks:
                    break
                # an end is one only by derivatives that were taken near it
                looks -= 1
                taken = np.where(np.isin(np.arange(len(x)), far), place.x, taken)
                anew, far = [*fresh, *far], []
        # those that have followed a step on which all moved tell of each some of what others did
        slope[:, fresh] = told
        return Fit(self.unpack(model, place.x), place.left, slope, place.cost)

    def _bounds(self, model: Model) -> FloatArray:
        """Return between which places the unknowns of a model lie, shape (unknowns, 2)."""
        return np.array([axis.ends for axis in self.axes(model)]).reshape(-1, 2)

    def _descent(self, model: Model) -> Descent:
        return Descent(
            lambda x: self.left(self.unpack(model, x)),
            self.prior(model),
            self.likely(model),
            self._bounds(model),
            self.still(model),
            lambda x: self.pack(self.unpack(model, x)),
        )

    def slopes(self, fit: Fit) -> dict[str, FloatArray]:
        """
        Return the derivatives of a fit by the labels of the unknowns.

        :param fit: the fit.
        :return: columns, shape (samples,) each; those of tolerances that a cause stands for are
            left out.
        """
        owned = {
            f'{t.place}.{t.quantity}'
            for t, still in zip(self.tolerances, self.owned(fit.model), strict=True)
            if still
        }
        return {
            label: fit.slope[:, j]
            for j, label in enumerate(self.labels(fit.model))
            if label not in owned
        }

    def covariance(self, fit: Fit, free: NDArray[np.bool_] | None = None) -> FloatArray:
        """
        Return how well a fit knows its unknowns, were noise white and independent.

        :param fit: the fit.
        :param free: which unknowns the data may move; all where None.
        :return: shape (unknowns, unknowns), on their axes.
        """
        slope = fit.slope if free is None else fit.slope * free
        normal = slope.T @ slope + np.diag(self.prior(fit.model) + 1e-9)
        # one along which the model runs away must not make nothing of all others
        scale = 1.0 / np.sqrt(np.diag(normal))
        scaled = np.linalg.pinv(normal * np.outer(scale, scale), hermitian=True)
        return np.asarray(scaled * np.outer(scale, scale), dtype=np.float64)


def _moves(cause: Candidate, at: int) -> list[list[tuple[int, float]]]:
    """
    Return how an event may move: the whole of it, its begin alone, its end alone.

    Each is a list of unknowns and which way they go; ``at``: the first unknown of the cause.
    """
    searched = [p.search for p in cause.parameters]
    begin = [at + n for n, search in enumerate(searched) if search == 'instant']
    lasts = [at + n for n, search in enumerate(searched) if search == 'duration']
    return [
        *([(j, 1.0)] for j in begin),
        *([(j, 1.0), (k, -1.0)] for j in begin for k in lasts),
        *([(k, 1.0)] for k in lasts),
    ]
