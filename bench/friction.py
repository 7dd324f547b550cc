"""Smooth friction against sticking, and pre-sliding friction against both."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from bench.rig import five_pulleys, press_and_swing
from bench.yardstick import Yardstick
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.simulation import Simulation

FloatArray = NDArray[np.float64]

RUBBING = ('1', '2', '3')


def smoothed(
    right: FloatArray, speeds: tuple[float, ...], tolerance: float
) -> list[dict[str, float]]:
    """
    Measure friction smoothed as v / sqrt(v^2 + eps^2), by the yardstick.

    :param right: the reference's angles, with sticking [rad].
    :param speeds: eps [rad/s].
    :param tolerance: of the steps.
    :return: for each eps: error against sticking [rad], time [s], steps, and how far a pulley
        moves while it ought to stick [rad].
    """
    setpoints = press_and_swing(len(right) * 1e-3)
    window = still_window(right)
    found = []
    for eps in speeds:
        one = Yardstick(five_pulleys(), tolerance=tolerance, smooth=eps)
        angle = one.run(setpoints)[:, 1:6]
        times = []
        for _ in range(5):
            begun = time.perf_counter()
            one.run(setpoints)
            times.append(time.perf_counter() - begun)
        found.append(
            {
                'eps': eps,
                'error': float(np.abs(angle - right).max()),
                'time': float(np.median(times)),
                'steps': float(one.counts[0]),
                'drift': drift(angle, window),
            }
        )
    return found


def still_window(angle: FloatArray) -> tuple[int, int, int]:
    """Return pulley, first and last tick of the longest time that a pulley does not move."""
    best = (0, 0, 0)
    for i in (2, 3, 4):
        moves = np.flatnonzero(np.diff(angle[:, i]) != 0.0)
        edges = np.concatenate([[0], moves + 1, [len(angle) - 1]])
        gaps = np.diff(edges)
        at = int(np.argmax(gaps[1:])) + 1 if len(gaps) > 1 else 0
        if gaps[at] > best[2] - best[1]:
            best = (i, int(edges[at]), int(edges[at + 1]) - 1)
    return best


def drift(angle: FloatArray, window: tuple[int, int, int]) -> float:
    """Return how far a pulley moves while it ought to stick [rad]."""
    i, first, last = window
    return float(abs(angle[last, i] - angle[first, i]))


def presliding(right: FloatArray, angles: tuple[float, ...]) -> list[dict[str, float]]:
    """
    Measure pre-sliding friction against rigid sticking.

    :param right: the reference's angles, with sticking [rad].
    :param angles: over which friction builds up [rad].
    :return: for each: error against rigid sticking [rad], time [s], steps, drift [rad].
    """
    setpoints = press_and_swing(len(right) * 1e-3)
    window = still_window(right)
    found = []
    for build_up in angles:
        effects = []
        for name in RUBBING:
            place = f'pulley_{name}'
            effects.append(EffectUse('tension_friction', place, {'coefficient': 0.1}))
            if build_up > 0.0:
                shape = {'torque': 0.0, 'angle': build_up}
                effects.append(EffectUse('presliding_friction', place, shape))
        simulation = Simulation(five_pulleys(effects=tuple(effects)))
        rows = simulation.run(setpoints)
        times = []
        for _ in range(5):
            simulation.reset()
            begun = time.perf_counter()
            simulation.run(setpoints)
            times.append(time.perf_counter() - begun)
        found.append(
            {
                'angle': build_up,
                'error': float(np.abs(rows.angle - right).max()),
                'time': float(np.median(times)),
                'steps': float(simulation.counts['steps']),
                'drift': drift(rows.angle, window),
            }
        )
    return found
