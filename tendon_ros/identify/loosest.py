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
#: changes of a tenth
UNNOTICED = 0.05
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
    rough = _doubted(instrument, segments, steps[0])
    for tolerance, finer in pairwise(steps):
        fine = _doubted(instrument, segments, finer)
        if not all(np.isfinite(row).all() for row in (*rough, *fine)):
            return unit * TOLERANCE  # the file's own model diverges
        changes = [np.sqrt(np.mean((a - b) ** 2)) for a, b in zip(rough, fine, strict=True)]
        change = max(changes, default=0.0)
        if change < UNNOTICED:
            return tolerance
        rough = fine
    return steps[-1]


def _doubted(
    instrument: Instrument, segments: Sequence[Segment], tolerance: float
) -> list[FloatArray]:
    """Return all channels by what the right model may be off, without friction and with some."""
    rollouts = Rollouts(instrument, segments, tolerance=tolerance)
    as_written: list[list[EffectUse]] = [[] for _ in segments]
    rubs = [
        [
            EffectUse('tension_friction', f'pulley_{name}', {'coefficient': RUBS})
            for name in instrument.pulley_names
            if name not in segment.prescribed
        ]
        for segment in segments
    ]
    return [
        row / m.doubt
        for uses in (as_written, rubs)
        for segment, rows in zip(segments, rollouts.predicted(uses), strict=True)
        for m, row in zip(segment.measured, rows, strict=True)
    ]
