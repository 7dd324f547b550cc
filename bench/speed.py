"""Time against the yardstick, and rollouts a second."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing.pool import ThreadPool
import time

import numpy as np

from bench.rig import five_pulleys, press_and_swing
from bench.rounds import interleaved, Timing
from bench.yardstick import compiler_found, Yardstick
from tendon_ros.model.signals import Signals
from tendon_ros.model.simulation import Simulation


def against_c(*, continuous: bool, tolerance: float, every: int, rounds: int) -> list[Timing]:
    """
    Time ten seconds of control in C and here.

    :param continuous: control without sampling.
    :param tolerance: of both.
    :param every: record every so many ticks.
    :param rounds: interleaved rounds.
    :return: timings, C first where there is a compiler.
    """
    instrument = five_pulleys(continuous=continuous)
    setpoints = press_and_swing()
    signals = Signals.through(0.0, instrument.control_period, setpoints.T)
    simulation = Simulation(instrument, tolerance=tolerance)

    def ours() -> object:
        simulation.reset()
        return (
            simulation.follow(signals, every) if continuous else simulation.run(setpoints, every)
        )

    contestants: dict[str, Callable[[], object]] = {}
    if compiler_found():
        yardstick = Yardstick(instrument, tolerance=tolerance)
        contestants['C'] = lambda: yardstick.run(signals if continuous else setpoints, every)
    contestants['kernel'] = ours
    return interleaved(contestants, rounds)


def agreement() -> float:
    """Return the largest difference of an angle between C and kernel in ten seconds [rad]."""
    instrument = five_pulleys()
    setpoints = press_and_swing()
    rows = Simulation(instrument).run(setpoints)
    return float(np.abs(Yardstick(instrument).run(setpoints)[:, 1:6] - rows.angle).max())


def rollouts_per_second(tolerance: float, threads: int = 2, seconds: float = 3.0) -> float:
    """
    Return how many rollouts of ten seconds, continuous control, end in a second.

    :param tolerance: local error of an angle in one step [rad].
    :param threads: that work at the same time; the kernel lets go of the interpreter.
    :param seconds: how long to measure.
    :return: rollouts a second, recorded at 100 Hz each.
    """
    setpoints = press_and_swing()
    signals = Signals.through(0.0, five_pulleys().control_period, setpoints.T)
    simulations = [
        Simulation(five_pulleys(continuous=True), tolerance=tolerance) for _ in range(threads)
    ]

    def work(simulation: Simulation) -> int:
        done = 0
        while time.perf_counter() < end:
            simulation.reset()
            simulation.follow(signals, every=10)
            done += 1
        return done

    end = time.perf_counter()
    with ThreadPool(threads) as pool:
        pool.map(work, simulations)
        begun = time.perf_counter()
        end = begun + seconds
        return sum(pool.map(work, simulations)) / (time.perf_counter() - begun)
