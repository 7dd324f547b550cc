"""Faults of cables, motors, sensors and the contact."""

from __future__ import annotations

import math

import numpy as np

from tendon_ros.blind import columns as k
from tendon_ros.blind.law import sign, Values
from tendon_ros.blind.rig import Rig


def pretension(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    """Change the preload."""
    scale = math.exp(sign(rng) * size)
    rig.loops[n, k.PRELOAD] *= scale
    return {'scale': scale}


def stiffness(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    """Change the tension curve by a factor."""
    scale = math.exp(sign(rng) * size)
    rig.loops[n, k.STIFFNESS] *= scale
    return {'scale': scale}


def hysteresis(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    """Add slip elements that yield one after the other."""
    stretch = np.geomspace(2e-5, 3e-4, 5) * rng.uniform(0.6, 1.5)
    share = rng.dirichlet(np.full(5, 4.0))
    rig.yields[n] = size * share
    rig.slips[n] = rig.yields[n] / stretch
    return {'force': size, 'elongation': float(share @ stretch)}


def creep(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    """Let the tension relax with two time constants."""
    share, fast, slow = rng.uniform(0.2, 0.5), rng.uniform(0.3, 1.0), rng.uniform(2.0, 7.0)
    rig.loops[n, [k.FAST, k.FAST_TIME, k.SLOW, k.SLOW_TIME]] = (
        size * share, fast, size * (1.0 - share), slow,
    )  # fmt: skip
    return {'fraction': size}


def slip(rig: Rig, n: int, size: float, rng: np.random.Generator) -> Values:
    """Let the rest length jump."""
    jump, start, length = sign(rng) * size, rng.uniform(2.0, 12.0), rng.uniform(0.01, 0.06)
    rig.loops[n, [k.SLIP, k.SLIP_START, k.SLIP_LENGTH]] = jump, start, length
    return {'jump': jump, 'time': start + 0.5 * length}


def backlash(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Give play between motor and cables: free, or held by friction."""
    held = rng.random() < 0.5
    if held:
        rig.motors[m, k.HELD] = size
    else:
        loop = 2 * m  # m1 hangs on M, L3 on L
        rig.loops[loop, k.DEAD] = 0.5 * size * abs(rig.routes[loop, m])
    return {'angle': size, 'held': float(held)}


def torque_gain(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Change the torque constant."""
    gain = math.exp(sign(rng) * size)
    rig.motors[m, k.GAIN] *= gain
    return {'gain': gain}


def torque_bias(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Add a torque that is not reported."""
    rig.motors[m, k.BIAS] = sign(rng) * size
    return {'torque': float(rig.motors[m, k.BIAS])}


def ripple(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Add cogging with a second wave."""
    cycles, phase = float(rng.integers(8, 41)), rng.uniform(-1.5, 1.5)
    rig.motors[m, [k.RIPPLE, k.RIPPLE_CYCLES, k.RIPPLE_PHASE, k.RIPPLE_SECOND]] = (
        size, cycles, phase, rng.uniform(-0.2, 0.2),
    )  # fmt: skip
    return {'amplitude': size, 'cycles': cycles, 'phase': phase}


def saturation(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Limit the torque with a rounded corner."""
    limit = 2.5 / size
    rig.motors[m, k.SATURATION] = limit
    return {'limit': limit}


def encoder_offset(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    """Shift the zero."""
    angle = sign(rng) * size
    if e < 2:
        rig.motors[e, k.ZERO] += angle
    else:
        rig.joint_offset[e - 2] += angle
    return {'angle': angle}


def encoder_gain(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    """Change the scale."""
    gain = math.exp(sign(rng) * size)
    if e < 2:
        rig.motors[e, k.SCALE] *= gain
    else:
        rig.joint_gain[e - 2] *= gain
    return {'gain': gain}


def encoder_delay(rig: Rig, e: int, size: float, rng: np.random.Generator) -> Values:
    """Report angles late."""
    if e < 2:
        rig.motors[e, k.AGE] = size
    else:
        rig.joint_delay[e - 2] = size
    return {'time': size}


def torque_delay(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Report torques late."""
    rig.torque_delay[m] = size
    return {'time': size}


def cell_delay(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    """Report forces late."""
    rig.cell[2] = size
    return {'time': size}


def rectified(rig: Rig, m: int, size: float, rng: np.random.Generator) -> Values:
    """Lose the sign."""
    rig.torque_rectified[m] = 1.0
    return {'rectified': 1.0}


def cell_gain(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    """Change the scale of the load cell."""
    rig.cell[0] *= math.exp(sign(rng) * size)
    return {'gain': float(rig.cell[0])}


def cell_bias(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    """Shift the zero of the load cell."""
    rig.cell[1] += sign(rng) * size
    return {'force': float(rig.cell[1])}


def contact_stiffness(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    """Change the stiffness of what is touched; mostly softer."""
    scale = math.exp(size * (-1.0 if rng.random() < 0.7 else 1.0))
    rig.contact[k.CONTACT] *= scale
    return {'scale': scale}


def contact_position(rig: Rig, _: int, size: float, rng: np.random.Generator) -> Values:
    """Move what is touched."""
    angle = sign(rng) * size
    rig.contact[k.WALL] += angle
    return {'angle': angle}
