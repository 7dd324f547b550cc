"""Ten seconds of sampled and of continuous control against the independent reference."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench.reference import Reference
from bench.rig import five_pulleys, press_and_swing
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import Simulation

FloatArray = NDArray[np.float64]


def truth(folder: Path, *, seconds: float, continuous: bool) -> FloatArray:
    """
    Return the reference's angles, computed once and kept.

    :param folder: where it is kept.
    :param seconds: how long.
    :param continuous: control without sampling.
    :return: shape (ticks, 5) [rad].
    """
    here = Path(__file__).parent
    text = ''.join(
        (here / f'{name}.py').read_text(encoding='utf-8') for name in ('reference', 'rig')
    )
    mark = hashlib.sha256(f'{text}{seconds}{continuous}'.encode()).hexdigest()[:12]
    path = folder / f'reference_{mark}.npy'
    if path.exists():
        return np.asarray(np.load(path))
    setpoints = press_and_swing(seconds)
    follow = None
    if continuous:
        signals = Signals.through(0.0, 1e-3, setpoints.T)
        follow = Follow(signals)
    angles = Reference(five_pulleys(continuous=continuous)).run(setpoints, signals=follow)[:, :5]
    np.save(path, angles)
    return angles


class Follow:
    """Set-points and slopes at a time, from the cubics that the kernel follows."""

    def __init__(self, signals: Signals) -> None:
        self._signals = signals

    def __call__(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Return values and slopes at time t [s]."""
        one = self._signals
        u = min(max((t - one.start) / one.step, 0.0), one.value.shape[1] - 1.0)
        cell = min(int(u), one.value.shape[1] - 2)
        u -= cell
        a, b = one.value[:, cell], one.value[:, cell + 1]
        p, q = one.slope[:, cell] * one.step, one.slope[:, cell + 1] * one.step
        rise = b - a
        c, e = 3.0 * rise - 2.0 * p - q, p + q - 2.0 * rise
        return a + u * (p + u * (c + u * e)), (p + u * (2.0 * c + 3.0 * u * e)) / one.step


def errors(
    folder: Path, *, seconds: float, continuous: bool, tolerances: tuple[float, ...]
) -> list[dict[str, float]]:
    """
    Return the kernel's largest angle error at several tolerances.

    :param folder: where the reference is kept.
    :param seconds: how long.
    :param continuous: control without sampling.
    :param tolerances: local error allowed in an angle [rad].
    :return: for each: tolerance, error [rad], steps, rejected, events.
    """
    right = truth(folder, seconds=seconds, continuous=continuous)
    setpoints = press_and_swing(seconds)
    found = []
    for tolerance in tolerances:
        simulation = Simulation(five_pulleys(continuous=continuous), tolerance=tolerance)
        rows = simulation.follow(setpoints) if continuous else simulation.run(setpoints)
        count = min(len(rows), len(right))
        wrong = np.abs(rows.angle[:count] - right[:count]).max()
        found.append({'tolerance': tolerance, 'error': float(wrong), **simulation.counts})
    return found
