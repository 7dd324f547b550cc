"""How roughly rollouts may be integrated, so that nothing that is measured notices."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import Segment
from tendon_ros.identify.step_size import fineness, STEPS, TOLERANCE
from tendon_ros.model.instrument import EffectUse, Instrument

FloatArray = NDArray[np.float64]

#: part of what the right model may be off that steps may be off: derivatives are taken from
#: changes of a tenth; twice that with friction, where a single hold makes as much
UNNOTICED, STICKING = 0.05, 0.1
#: friction that a machine may have whose file has none, as a part of what presses on it. Errors
#: of steps fade where all is smooth; what sticks keeps them
RUBS = 0.1


def loosest(instrument: Instrument, segments: Sequence[Segment]) -> float:
    """
    Return how roughly rollouts may be computed.

    :param instrument: the network.
    :param segments: what was measured, with its noise and what models leave of it.
    :return: a tolerance of a step [rad].
    """
    unit = fineness(instrument)
    steps = [unit * step for step in STEPS]
    smooth: list[list[EffectUse]] = [[] for _ in segments]
    sticking = [
        [
            EffectUse('tension_friction', f'pulley_{name}', {'coefficient': RUBS})
            for name in instrument.pulley_names
            if name not in segment.prescribed
        ]
        for segment in segments
    ]

    def doubted(tolerance: float) -> list[list[FloatArray]]:
        """Return channels by what the right model may be off, by what that may change."""
        rollouts = Rollouts(instrument, segments, tolerance=tolerance)
        return [
            [
                row / m.doubt / unnoticed
                for segment, rows in zip(segments, rollouts.predicted(uses), strict=True)
                for m, row in zip(segment.measured, rows, strict=True)
            ]
            for uses, unnoticed in ((smooth, UNNOTICED), (sticking, STICKING))
        ]

    rough, enough = doubted(steps[0]), 0.0
    for tolerance, finer in pairwise(steps):
        fine = doubted(finer)
        if not all(np.isfinite(row).all() for rows in (*rough, *fine) for row in rows):
            return unit * TOLERANCE  # the file's own model diverges
        as_smooth, as_sticking = (
            all(np.mean((a - b) ** 2) < 1.0 for a, b in zip(one, other, strict=True))
            for one, other in zip(rough, fine, strict=True)
        )
        if as_smooth:
            enough = enough or tolerance
            if as_sticking:
                return tolerance
        rough = fine
    # what shakes holds and lets go otherwise with each step, however fine: that is chance
    return min(enough, unit * TOLERANCE) or steps[-1]
