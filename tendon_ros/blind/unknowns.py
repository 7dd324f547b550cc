"""
Faults that no catalogue has: each at a place, none the special case of a known one.

They are drawn and sized like the others; see :mod:`tendon_ros.blind.law`.
"""

from __future__ import annotations

import numpy as np

from tendon_ros.blind import columns as k
from tendon_ros.blind.law import at, dry, Law, sign, Values
from tendon_ros.blind.rig import Rig


def _notch(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    place, width = rng.uniform(-0.04, 0.09), rng.uniform(0.008, 0.02)
    rig.pulleys[p, [k.NOTCH, k.NOTCH_AT, k.NOTCH_WIDTH]] = size, place, width
    return {'torque': size, 'at': place, 'width': width}


def _cubic(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.CUBIC] = size
    return {'stiffness': size}


def _drag(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.DRAG] = size
    return {'drag': size}


def _stop(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    place = rng.uniform(0.0, 0.04)
    rig.pulleys[p, [k.STOP, k.STOP_AT]] = size, place
    return {'stiffness': size, 'at': place}


def _warming(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    time = rng.uniform(3.0, 8.0)
    rig.pulleys[p, k.DAMPING] *= 1.0 + 0.3 * size
    rig.pulleys[p, [k.WARMING, k.WARMING_TIME]] = -min(0.95, 0.3 + 0.1 * size), time
    return {'size': size, 'time': time}


def _flattening(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.FLATTENING] = size
    return {'per_newton': size}


def _sided(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    rig.pulleys[p, k.SIDED] = size
    dry(rig, p, 0.05 * size, 2e-4)
    return {'torque_per_angle': size}


def _lag(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    rig.motors[m, k.LAG] = size
    return {'time': size}


def _crosstalk(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    rig.motors[m, k.CROSSTALK] = sign(rng) * size
    return {'part': float(rig.motors[m, k.CROSSTALK])}


def _drop(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    start, length = rng.uniform(2.5, 10.0), rng.uniform(0.8, 2.5)
    rig.motors[m, [k.DROP, k.DROP_START, k.DROP_LENGTH]] = min(size, 0.9), start, length
    return {'part': min(size, 0.9), 'start': start, 'duration': length}


def _cyclic(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    cycles = float(rng.integers(20, 80))
    if e < 2:
        rig.motors[e, [k.CYCLIC, k.CYCLES]] = size, cycles
    else:
        rig.joint_cyclic[e - 2] = size
    return {'angle': size, 'cycles': cycles}


def _cell_lag(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.cell[3] = size
    return {'time': size}


def _cell_curved(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.cell[4] = -size
    return {'per_newton': -size}


def _pad(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    rig.contact[[k.PAD, k.PAD_DEPTH]] = rng.uniform(0.02, 0.06), size
    return {'depth': size}


def _cable_damping(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    rig.loops[n, k.CABLE_DAMPING] = size
    return {'damping': size}


_CELL = ('load_cell',)

#: every fault that no catalogue has
UNKNOWNS: tuple[Law, ...] = (
    Law('unknown_notch', at('pulley', '1 3'), 0.08, 0.6, _notch),
    Law('unknown_cubic_spring', at('pulley', '1 2 3'), 8.0, 300.0, _cubic),
    Law('unknown_drag', at('pulley', '1 2 3'), 0.08, 2.0, _drag),
    Law('unknown_stop', at('pulley', '1 3'), 2.0, 40.0, _stop),
    Law('unknown_warming', at('pulley', 'M L 1 2 3'), 1.0, 10.0, _warming),
    Law('unknown_flattening', at('pulley', '1 2 3'), 3e-4, 6e-3, _flattening),
    Law('unknown_sided_friction', at('pulley', '1 2 3'), 0.4, 6.0, _sided),
    Law('unknown_torque_lag', at('motor', 'M L'), 5e-3, 5e-2, _lag),
    Law('unknown_crosstalk', at('motor', 'M L'), 0.02, 0.2, _crosstalk),
    Law('unknown_torque_drop', at('motor', 'M L'), 0.1, 0.8, _drop, event=True),
    Law('unknown_encoder_ripple', at('encoder', 'M L'), 4e-4, 5e-3, _cyclic),
    Law('unknown_encoder_ripple', at('encoder', '1 2 3'), 4e-4, 5e-3, _cyclic),
    Law('unknown_cell_lag', _CELL, 0.05, 0.4, _cell_lag),
    Law('unknown_cell_curve', _CELL, 4e-4, 6e-3, _cell_curved),
    Law('unknown_pad', ('contact',), 3e-5, 5e-4, _pad),
    Law('unknown_cable_damping', at('cable', 'm1 12 L3'), 60.0, 2000.0, _cable_damping),
)

_M, _MOTOR_M = ('pulley_M',), ('motor_M',)

#: the same of one body on a motor
AXIS_UNKNOWNS: tuple[Law, ...] = (
    Law('unknown_cubic_spring', _M, 0.05, 2.0, _cubic),
    Law('unknown_drag', _M, 5e-3, 0.1, _drag),
    Law('unknown_stop', _M, 0.1, 2.0, _stop),
    Law('unknown_warming', _M, 1.0, 10.0, _warming),
    Law('unknown_sided_friction', _M, 0.04, 0.6, _sided),
    Law('unknown_torque_lag', _MOTOR_M, 5e-3, 5e-2, _lag),
    Law('unknown_torque_drop', _MOTOR_M, 0.1, 0.8, _drop, event=True),
    Law('unknown_encoder_ripple', at('encoder', 'M'), 4e-4, 5e-3, _cyclic),
)
