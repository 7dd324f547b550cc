"""
What can be wrong with a rig, and how large it is drawn, for effects that a catalogue may have.

A law changes a rig's tables by one number, its size, which is drawn log-uniformly between bounds;
whatever else it needs (phases, times, signs) comes from a seed of its own, so that the same fault
can be made larger or smaller. What it returns is the truth in the words of the catalogue.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import math

import numpy as np

from tendon_ros.blind import kernel as k
from tendon_ros.blind.rig import Rig

Values = dict[str, float]
Apply = Callable[[Rig, int, float, np.random.Generator], Values]


@dataclass(frozen=True)
class Law:
    """
    One fault: ``apply(rig, index, size, rng)`` at ``places``, sizes from ``low`` to ``high``.

    ``event``: it happens at a time, in one recording or in all. ``places`` are full names.
    ``spread``: how many times the nuisance is one standard deviation of the same quantity.
    """

    effect: str
    places: tuple[str, ...]
    low: float
    high: float
    apply: Apply
    event: bool = False
    spread: float = 0.0


def at(kind: str, names: str) -> tuple[str, ...]:
    """Return places, for instance ``at('pulley', '1 2')``."""
    return tuple(f'{kind}_{name}' for name in names.split())


def sign(rng: np.random.Generator) -> float:
    """Return -1 or 1."""
    return float(rng.choice([-1.0, 1.0]))


def dry(rig: Rig, p: int, rest: float, angle: float) -> None:
    """Give a pulley bristles that yield ``rest`` [N m] over an angle [rad]."""
    row = rig.pulleys[p]
    row[k.BRISTLE] = max(row[k.BRISTLE], rest / angle)
    row[k.BRISTLE_DAMPING] = 0.6 * math.sqrt(row[k.BRISTLE] * min(row[k.INERTIA], 2e-4))


def _coulomb(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.COULOMB] += size
    dry(rig, p, size, rng.uniform(1.5e-4, 3e-4))
    return {'torque': size}


def _tension(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.LOADED] += size
    dry(rig, p, size * rig.load(p), rng.uniform(1.5e-4, 3e-4))
    return {'coefficient': size}


def _stribeck(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    sliding, speed = size * rng.uniform(0.2, 0.7), math.exp(rng.uniform(-4.0, -1.9))
    row = rig.pulleys[p]
    row[k.STATIC] += size
    row[k.COULOMB] += sliding
    row[k.STRIBECK_SPEED] = speed
    dry(rig, p, size + sliding, rng.uniform(1.5e-4, 3e-4))
    half = speed * math.sqrt(math.log(2.0))  # at which half of the static part is gone
    return {'static': size, 'sliding': sliding, 'speed': half}


def _presliding(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    angle = math.exp(rng.uniform(math.log(4e-3), math.log(2e-2)))
    rig.pulleys[p, k.COULOMB] += size
    dry(rig, p, size, angle)
    return {'torque': size, 'angle': angle}


def _asymmetric(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    part = sign(rng) * rng.uniform(0.4, 0.95)
    forward, backward = size * (1.0 + part), size * (1.0 - part)
    rig.pulleys[p, [k.FORWARD, k.BACKWARD]] += forward, backward
    dry(rig, p, size, rng.uniform(1.5e-4, 3e-4))
    return {'forward': forward, 'backward': backward}


def _viscous(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    less = rng.random() < 0.3
    row = rig.pulleys[p]
    added = row[k.DAMPING] * (math.exp(-size) - 1.0 if less else size)
    row[k.DAMPING] += added
    return {'damping': float(added)}


def _inertia(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    scale = math.exp(size * (sign(rng) if p == 4 else 1.0))
    rig.pulleys[p, k.INERTIA] *= scale
    return {'scale': scale}


def _gravity(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    phase = rng.uniform(-1.5, 1.5)
    rig.pulleys[p, [k.WEIGHT, k.WEIGHT_PHASE]] = size, phase
    return {'torque': size, 'phase': phase}


def _spring(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rest = rng.uniform(-0.15, 0.15)
    rig.pulleys[p, [k.SPRING, k.SPRING_REST]] = size, rest
    return {'stiffness': size, 'rest': rest}


def _eccentric(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    amplitude, phase = sign(rng) * size, rng.uniform(-1.4, 1.4)
    rig.pulleys[p, [k.ECCENTRIC, k.ECCENTRIC_PHASE]] = amplitude, phase
    return {'amplitude': amplitude, 'phase': phase}


def _disturbance(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    torque, start, length = sign(rng) * size, rng.uniform(2.0, 11.5), rng.uniform(0.3, 1.6)
    rig.pulleys[p, [k.PUSH, k.PUSH_START, k.PUSH_LENGTH]] = torque, start, length
    # the edges take a tenth each: a rectangle of the same area begins and ends half-way up
    return {'torque': torque, 'start': start + 0.05 * length, 'duration': 0.9 * length}


def _pretension(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    scale = math.exp(sign(rng) * size)
    rig.loops[n, k.PRELOAD] *= scale
    return {'scale': scale}


def _stiffness(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    scale = math.exp(sign(rng) * size)
    rig.loops[n, k.STIFFNESS] *= scale
    return {'scale': scale}


def _hysteresis(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    stretch = np.geomspace(2e-5, 3e-4, 5) * rng.uniform(0.6, 1.5)
    share = rng.dirichlet(np.full(5, 4.0))
    rig.yields[n] = size * share
    rig.slips[n] = rig.yields[n] / stretch
    return {'force': size, 'elongation': float(share @ stretch)}


def _creep(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    share, fast, slow = rng.uniform(0.2, 0.5), rng.uniform(0.3, 1.0), rng.uniform(2.0, 7.0)
    rig.loops[n, [k.FAST, k.FAST_TIME, k.SLOW, k.SLOW_TIME]] = (
        size * share, fast, size * (1.0 - share), slow,
    )  # fmt: skip
    return {'fraction': size}


def _slip(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    jump, start, length = sign(rng) * size, rng.uniform(2.0, 12.0), rng.uniform(0.01, 0.06)
    rig.loops[n, [k.SLIP, k.SLIP_START, k.SLIP_LENGTH]] = jump, start, length
    return {'jump': jump, 'time': start + 0.5 * length}


def _backlash(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    loop = 2 * m  # m1 hangs on M, L3 on L
    rig.loops[loop, k.DEAD] = 0.5 * size * abs(rig.routes[loop, m])
    return {'angle': size}


def _torque_gain(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    gain = math.exp(sign(rng) * size)
    rig.motors[m, k.GAIN] *= gain
    return {'gain': gain}


def _torque_bias(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    rig.motors[m, k.BIAS] = sign(rng) * size
    return {'torque': float(rig.motors[m, k.BIAS])}


def _ripple(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    cycles, phase = float(rng.integers(8, 41)), rng.uniform(-1.5, 1.5)
    rig.motors[m, [k.RIPPLE, k.RIPPLE_CYCLES, k.RIPPLE_PHASE, k.RIPPLE_SECOND]] = (
        size, cycles, phase, rng.uniform(-0.2, 0.2),
    )  # fmt: skip
    return {'amplitude': size, 'cycles': cycles, 'phase': phase}


def _saturation(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    limit = 2.5 / size
    rig.motors[m, k.SATURATION] = limit
    return {'limit': limit}


def _encoder_offset(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    angle = sign(rng) * size
    if e < 2:
        rig.motors[e, k.ZERO] += angle
    else:
        rig.joint_offset[e - 2] += angle
    return {'angle': angle}


def _encoder_gain(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    gain = math.exp(sign(rng) * size)
    if e < 2:
        rig.motors[e, k.SCALE] *= gain
    else:
        rig.joint_gain[e - 2] *= gain
    return {'gain': gain}


def _encoder_delay(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    if e < 2:
        rig.motors[e, k.AGE] = size
    else:
        rig.joint_delay[e - 2] = size
    return {'time': size}


def _torque_delay(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    rig.torque_delay[m] = size
    return {'time': size}


def _cell_delay(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.cell[2] = size
    return {'time': size}


def _rectified(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    rig.torque_rectified[m] = 1.0
    return {'rectified': 1.0}


def _cell_gain(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.cell[0] *= math.exp(sign(rng) * size)
    return {'gain': float(rig.cell[0])}


def _cell_bias(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.cell[1] += sign(rng) * size
    return {'force': float(rig.cell[1])}


def _contact_stiffness(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    scale = math.exp(size * (-1.0 if rng.random() < 0.7 else 1.0))
    rig.contact[k.CONTACT] *= scale
    return {'scale': scale}


def _contact_position(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    angle = sign(rng) * size
    rig.contact[k.WALL] += angle
    return {'angle': angle}


_ALL = at('pulley', 'M L 1 2 3')
_CABLES = at('cable', 'm1 12 L3')
_MOTORS = at('motor', 'M L')
_OUTER, _INNER = at('encoder', 'M L'), at('encoder', '1 2 3')
_CELL, _CONTACT = ('load_cell',), ('contact',)

#: every fault that a catalogue may have; an effect can have several, by where it acts
LAWS: tuple[Law, ...] = (
    Law('coulomb_friction', _ALL, 0.02, 0.5, _coulomb),
    Law('tension_friction', _ALL, 0.03, 0.3, _tension),
    Law('stribeck_friction', _ALL, 0.04, 0.4, _stribeck),
    Law('presliding_friction', _ALL, 0.04, 0.5, _presliding),
    Law('asymmetric_friction', _ALL, 0.03, 0.4, _asymmetric),
    Law('viscous_friction', _ALL, 0.3, 6.0, _viscous, spread=3.0),
    Law('pretension', _CABLES, 0.15, 0.8, _pretension, spread=1.0),
    Law('cable_stiffness', _CABLES, 0.06, 0.5, _stiffness, spread=1.0),
    Law('cable_hysteresis', _CABLES, 1.0, 9.0, _hysteresis),
    Law('cable_creep', _CABLES, 0.05, 0.4, _creep),
    Law('cable_slip', _CABLES, 8e-5, 6e-4, _slip, event=True),
    Law('backlash', _MOTORS, 1.5e-3, 2e-2, _backlash),
    Law('eccentricity', _ALL, 0.008, 0.1, _eccentric),
    Law('inertia', at('pulley', '3'), 0.15, 1.2, _inertia, spread=1.0),
    Law('inertia', at('pulley', 'M L 1 2'), 0.7, 2.9, _inertia, spread=1.0),
    Law('gravity', at('pulley', '2 3'), 0.04, 0.6, _gravity),
    Law('joint_spring', at('pulley', '1 2 3'), 0.15, 4.0, _spring),
    Law('torque_gain', _MOTORS, 0.03, 0.25, _torque_gain),
    Law('torque_bias', _MOTORS, 0.03, 0.3, _torque_bias),
    Law('torque_ripple', _MOTORS, 0.03, 0.3, _ripple),
    Law('torque_saturation', _MOTORS, 1.0, 5.0, _saturation),
    Law('encoder_offset', _OUTER, 2e-3, 2.5e-2, _encoder_offset),
    Law('encoder_offset', _INNER, 4e-4, 2e-2, _encoder_offset),
    Law('encoder_gain', _OUTER, 0.01, 0.1, _encoder_gain),
    Law('encoder_gain', _INNER, 0.005, 0.1, _encoder_gain),
    Law('sensor_delay', _OUTER, 1e-3, 1.2e-2, _encoder_delay),
    Law('sensor_delay', _INNER, 1.5e-3, 3e-2, _encoder_delay),
    Law('sensor_delay', at('torque', 'M L'), 4e-3, 4.5e-2, _torque_delay),
    Law('sensor_delay', _CELL, 4e-3, 4.5e-2, _cell_delay),
    Law('sensor_rectified', at('torque', 'M L'), 0.99, 1.01, _rectified),
    Law('load_cell_gain', _CELL, 0.015, 0.25, _cell_gain),
    Law('load_cell_bias', _CELL, 0.15, 2.5, _cell_bias),
    Law('contact_stiffness', _CONTACT, 0.3, 2.0, _contact_stiffness, spread=1.0),
    Law('contact_position', _CONTACT, 5e-4, 8e-3, _contact_position),
    Law('disturbance', _ALL, 0.08, 1.2, _disturbance, event=True),
)

_DRY = ('coulomb_friction', 'stribeck_friction', 'presliding_friction', 'asymmetric_friction')
_CONSTANT = ('torque_bias', 'gravity', 'joint_spring', 'disturbance')
_SHIFT = ('encoder_offset', 'contact_position', 'cable_slip')
_SOFT = ('pretension', 'cable_stiffness')
_SCALE = ('encoder_gain', 'eccentricity')

#: effects of a catalogue that hold each other as a special case: one is taken out with the others,
#: or the catalogue would still be able to explain what is withheld
KIN: Mapping[str, tuple[str, ...]] = {
    effect: kin for kin in (_DRY, _CONSTANT, _SHIFT, _SOFT, _SCALE) for effect in kin
} | {'disturbance': ('disturbance',), 'cable_slip': ('cable_slip',)}
