"""How roughly rollouts may be integrated, so that nothing that is measured notices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import Segment
from tendon_ros.identify.step_size import fineness, ROUGHER, TOLERANCE
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]

#: part of what the right model may be off that this may change of the file's. Dry friction makes
#: it some five times more, and derivatives are taken from changes of a tenth
UNNOTICED = 4e-3


def loosest(instrument: Instrument, segments: Sequence[Segment]) -> float:
    """
    Return how roughly rollouts may be computed.

    :param instrument: the network.
    :param segments: what was measured, with its noise and what models leave of it.
    :return: a tolerance of a step [rad].
    """
    unit = fineness(instrument)
    fine = _of_the_file(instrument, segments, unit * TOLERANCE)
    for tolerance in (unit * step for step in ROUGHER):
        rough = _of_the_file(instrument, segments, tolerance)
        changes = [np.sqrt(np.mean((a - b) ** 2)) for a, b in zip(rough, fine, strict=True)]
        # infinite where the file's own model diverges
        if float(np.max(changes)) < UNNOTICED:
            return tolerance
    return unit * TOLERANCE


def _of_the_file(
    instrument: Instrument, segments: Sequence[Segment], tolerance: float
) -> list[FloatArray]:
    """Return all channels as the file has them, by what the right model may be off."""
    rows = Rollouts(instrument, segments, tolerance=tolerance).predicted([[] for _ in segments])
    return [
        row / m.doubt
        for segment, of_segment in zip(segments, rows, strict=True)
        for m, row in zip(segment.measured, of_segment, strict=True)
    ]
