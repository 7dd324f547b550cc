"""Cost against the number of cables, and of effects that are off."""

from __future__ import annotations

import time

import numpy as np

from bench.rig import chain, five_pulleys, press_and_swing
from bench.rounds import interleaved, Timing
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.simulation import Simulation


def chains(sizes: tuple[int, ...]) -> list[dict[str, float]]:
    """
    Time one second of sampled control of chains.

    :param sizes: numbers of cable loops.
    :return: for each: loops, time of one step for each loop [s], steps, seconds to get ready.
    """
    found = []
    for loops in sizes:
        begun = time.perf_counter()
        simulation = Simulation(chain(loops))
        ready = time.perf_counter() - begun
        setpoints = np.full((1000, 1), 0.05)
        times = []
        for _ in range(3):
            simulation.reset()
            begun = time.perf_counter()
            simulation.run(setpoints, every=1000)
            times.append(time.perf_counter() - begun)
        steps = simulation.counts['steps'] + simulation.counts['rejected']
        found.append(
            {
                'loops': loops,
                'per_step_and_loop': min(times) / steps / loops,
                'steps': float(steps),
                'ready': ready,
            }
        )
    return found


def effects_off(rounds: int) -> list[Timing]:
    """
    Time the bare rig, the rig with effects at neutral values, and with effects at work.

    :param rounds: interleaved rounds.
    :return: timings, the bare rig first.
    """
    setpoints = press_and_swing(2.0)
    neutral = (
        EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.0}),
        EffectUse('joint_spring', 'pulley_3', {}),
        EffectUse('eccentricity', 'pulley_1', {'amplitude': 0.0, 'phase': 0.0}),
        EffectUse('cable_hysteresis', 'cable_L3', {'force': 0.0, 'elongation': 1e-4}),
    )
    working = (
        EffectUse('coulomb_friction', 'pulley_3', {'torque': 0.02}),
        EffectUse('joint_spring', 'pulley_3', {'stiffness': 0.1}),
        EffectUse('eccentricity', 'pulley_1', {'amplitude': 0.02, 'phase': 0.0}),
        EffectUse('cable_hysteresis', 'cable_L3', {'force': 2.0, 'elongation': 1e-4}),
    )
    contestants = {}
    for name, effects in (('none', ()), ('neutral', neutral), ('at work', working)):
        simulation = Simulation(five_pulleys(effects=effects))

        def go(simulation: Simulation = simulation) -> None:
            simulation.reset()
            simulation.run(setpoints)

        contestants[name] = go
    return interleaved(contestants, rounds)
