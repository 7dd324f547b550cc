"""How far an estimate is from what a load cell measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.estimate.channels import deviation
from tendon_ros.model.instrument import Instrument


@dataclass(frozen=True)
class Score:
    """
    Estimate against measurement of one recording.

    ``rmse``, ``bias`` and ``span`` (of the measurement) in ``unit``; ``coverage``: part of the
    samples within two standard deviations, the load cell's own noise included;
    ``samples``: their number.
    """

    quantity: str
    unit: str
    rmse: float
    bias: float
    span: float
    coverage: float
    samples: int


def scored(recording: Recording, instrument: Instrument) -> Score | None:
    """
    Compare the estimate in a recording with its load cell.

    :param recording: with estimates.
    :param instrument: states the noise of its load cell.
    :return: the score, or None where the load cell was not recorded.
    """
    for quantity in ('force', 'torque'):
        truth, guess = f'load_cell/{quantity}', f'estimate/{quantity}'
        if truth in recording and guess in recording:
            estimate = recording[guess]
            measured = recording[truth].at(estimate.time)
            error = estimate.value - measured
            noise = [deviation(s) for s in instrument.sensors if s.channel == truth and s.noise]
            # of what was recorded live, each channel may lack other messages
            stated = recording[f'{guess}_std'].at(estimate.time)
            sigma = np.hypot(stated, noise[0] if noise else 0.0)
            return Score(
                quantity,
                estimate.unit,
                float(np.sqrt(np.mean(error**2))),
                float(np.mean(error)),
                float(np.ptp(measured)),
                float(np.mean(np.abs(error) <= 2.0 * sigma)),
                len(error),
            )
    return None
