"""The fixed-step check against the default: what it allows, and how it converges."""

from __future__ import annotations

import time

import numpy as np

from bench.fixed_step import FixedStep
from bench.rig import five_pulleys, press_and_swing
from tendon_ros.base.errors import SimulationError
from tendon_ros.model.simulation import Simulation


def steps(sizes: tuple[float, ...], seconds: float = 1.2) -> list[dict[str, float | str]]:
    """
    Run the fixed step at several sizes.

    :param sizes: steps [s].
    :param seconds: how long.
    :return: for each: step, error against the default [rad] and time [s], or what it said.
    """
    setpoints = press_and_swing(seconds)
    found: list[dict[str, float | str]] = []
    instrument = five_pulleys(wall='hunt_crossley')
    right = Simulation(instrument, tolerance=1e-11).run(setpoints)
    for size in sizes:
        try:
            begun = time.perf_counter()
            rows = FixedStep(instrument, size).run(setpoints)
        except SimulationError as error:
            found.append({'step': size, 'refused': str(error)})
            continue
        wrong = float(np.abs(rows.angle - right.angle).max())
        found.append({'step': size, 'error': wrong, 'time': time.perf_counter() - begun})
    return found
