"""Which recording tells which cause, and why another does not: each recording on its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tendon_ros.diagnose.evidence import Told
from tendon_ros.diagnose.intervals import parameter_intervals
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.model.effect_use import units_at

#: norm of what a cause does to a recording, in noise deviations, that leaves a trace
TRACE = 2.0
#: part of a size that an interval may be wide to either side and still tell it
TELLS = 1.0


def told(problem: Problem, fit: Fit) -> tuple[Told, ...]:
    """
    Return what each recording alone says of the size of each cause.

    One step of Gauss and Newton from the fit to all of them, with the samples of one: what it
    would move to, its interval, and where that is too wide to tell anything, the reason.

    :param problem: the data.
    :param fit: of the causes, to all recordings.
    :return: for each recording in which a cause acts, one for each of its sizes.
    """
    found = []
    for n, segment in enumerate(problem.rollouts.segments):
        own = np.concatenate(
            [np.full(span.stop - span.start, k == n) for k, _, span in problem.spans()]
        )
        if not own.any():
            continue
        mask = [m.any(axis=0) & (k == n) for k, m in enumerate(problem.masks)]
        alone = Problem(problem.rollouts, problem.tolerances, mask)
        part = _alone(alone, replace(fit, left=fit.left[own], slope=fit.slope[own]))
        intervals = parameter_intervals(alone, part)
        at = 0
        for k, cause in enumerate(fit.model.causes):
            sizes = [at + j for j in cause.coordinates.sizes]
            at += len(cause.parameters)
            if not cause.acts_in(segment.name):
                continue
            shown = float(np.linalg.norm(part.slope[:, sizes] @ problem.pack(fit.model)[sizes]))
            values = part.model.values(k)
            units = units_at(problem.rollouts.instrument, cause.effect, cause.place)
            whole = fit.model.values(k)
            for p in cause.parameters:
                if p.is_shape or p.search == 'instant':
                    continue
                low, high = intervals[k][p.name]
                why = ''
                if shown < TRACE:
                    why = 'no trace'
                elif high - low > 2.0 * TELLS * abs(whole[p.name] - p.neutral):
                    why = 'others do the same'
                found.append(
                    Told(
                        segment.name,
                        cause.effect,
                        cause.place,
                        p.name,
                        units[p.name],
                        values[p.name],
                        (low, high),
                        why,
                    )
                )
    return tuple(found)


def _alone(problem: Problem, fit: Fit) -> Fit:
    """Return a fit moved by one step to where the samples of a problem want it."""
    x = problem.pack(fit.model)
    pull = fit.slope.T @ fit.left + problem.prior(fit.model) * problem.off(fit.model)
    free = problem.free(fit)
    step = -(problem.covariance(fit, free) @ (pull * free)) * free
    ends = np.array([axis.ends for axis in problem.axes(fit.model)]).reshape(-1, 2)
    moved = np.clip(x + step, ends[:, 0], ends[:, 1])
    return replace(fit, model=problem.unpack(fit.model, moved))
