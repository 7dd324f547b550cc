"""
The rig of Figs. 14 and 15 as a diagnosis meets it: recordings, and what was done to it withheld.

Its authors found by hand what separates the rig from their model: 10 % less pretension in L3,
friction in proportion to tension, and static friction between joint pulley and stand plate. Here
the rig has just that, and its recordings have the noise and the counts of real sensors.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.model.effect_use import checked_use
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

#: the instrument file that the diagnosis is given: the rig with the sensors of its stand
STAND = 'paper_stand'

Use3 = tuple[str, str, Mapping[str, float]]

#: What is withheld. Coefficient as in :mod:`~tendon_ros.model.paper.adjusted_rig`, on all joint
#: pulleys; the paper gives no static friction: 0.2 N m is that of 0.1 (dry steel, lubricated) by
#: 110 N on a face of 18 mm.
WITHHELD: tuple[Use3, ...] = (
    ('pretension', 'cable_L3', {'scale': 0.9}),
    ('tension_friction', 'pulley_1', {'coefficient': 0.1}),
    ('tension_friction', 'pulley_2', {'coefficient': 0.1}),
    ('tension_friction', 'pulley_3', {'coefficient': 0.1}),
    ('stribeck_friction', 'pulley_3', {'static': 0.2, 'sliding': 0.0, 'speed': 0.05}),
)

#: Steel bends before it slips, by 10 um: over bearings of 5 mm, and over the face of 18 mm [rad].
#: Friction is nowhere without it, so it is no cause of its own.
BENDING: Mapping[str, float] = MappingProxyType({'1': 2e-3, '2': 2e-3, '3': 0.56e-3})

# how well the numbers of a file are known, one deviation; not to be reported as a cause
_NUMBERS, _DAMPINGS, _PRELOADS = 0.01, 0.03, 0.005

RATE = 500.0  # recorded rows a second [Hz]


@dataclass(frozen=True)
class Plan:
    """A recording: what moves how, and whether the load cell is in the way of the tip."""

    name: str
    trajectory: str
    settings: Mapping[str, str | float]
    contact: bool


#: the paper's own experiment, and two that it did not make
PLANS = (
    Plan('profile', 'paper_fig12', {}, True),
    Plan('free', 'multisine', {'duration': 16.0, 'amplitude': '6 deg'}, False),
    Plan('mixed', 'multisine', {'duration': 16.0, 'amplitude': '5 deg', 'seed': 3}, True),
)


def withheld_rig(stand: Instrument, seed: int = 1) -> Instrument:
    """
    Return the rig as it really is.

    :param stand: the instrument file that tells nothing of it.
    :param seed: of the percent by which every number of a file is off.
    :return: the same with the withheld effects and its own numbers.
    """
    draw = np.random.default_rng(seed).standard_normal
    pulleys = tuple(
        replace(
            p,
            inertia=p.inertia * (1.0 + _NUMBERS * draw()),
            damping=p.damping * (1.0 + _DAMPINGS * draw()),
        )
        for p in stand.pulleys
    )
    loops = tuple(
        replace(p, pretension=p.pretension * (1.0 + _PRELOADS * draw())) for p in stand.loops
    )
    curves: list[Use3] = [
        ('cable_stiffness', f'cable_{p.name}', {'scale': 1.0 + _NUMBERS * draw()})
        for p in stand.loops
    ]
    bending: list[Use3] = [
        ('presliding_friction', f'pulley_{name}', {'torque': 0.0, 'angle': angle})
        for name, angle in BENDING.items()
    ]
    rig = replace(stand, pulleys=pulleys, loops=loops)
    uses = (*WITHHELD, *curves, *bending)
    return replace(rig, effects=tuple(checked_use(rig, *use) for use in uses))


def recorded(
    rig: Instrument,
    plan: Plan,
    seed: int,
    progress: Callable[[float], None] | None = None,
) -> Recording:
    """
    Record what the stand's sensors see of the rig; set-points with it, nothing else.

    :param rig: the rig as it is.
    :param plan: the recording.
    :param seed: of the sensors' noise.
    :param progress: called with the part that is done.
    :return: simulated, with noise and counts.
    """
    there = tuple(replace(c, enabled=plan.contact) for c in rig.contacts)
    run = simulate(
        replace(rig, contacts=there),
        chosen_trajectory(plan.trajectory, rig.motor_names, plan.settings),
        rate=RATE,
        seed=seed,
        progress=progress,
    )
    kept = {s.channel for s in rig.sensors}
    kept |= {f'setpoint/pulley_{name}/position' for name in rig.driven}
    # the simulator writes down what it runs; a rig does not tell
    return Recording(
        plan.name,
        {name: c for name, c in run.channels.items() if name in kept},
        run.epoch_ns,
        {'source': 'simulated'},
    )
