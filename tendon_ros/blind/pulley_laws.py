"""Faults of pulleys: friction, inertia, and torques from outside."""

from __future__ import annotations

import math

import numpy as np

from tendon_ros.blind import columns as k
from tendon_ros.blind.law import dry, sign, Values
from tendon_ros.blind.rig import Rig


def coulomb(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Rub with the same torque at any speed."""
    rig.pulleys[p, k.COULOMB] += size
    dry(rig, p, size, rng.uniform(1.5e-4, 3e-4))
    return {'torque': size}


def tension(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Rub in proportion to the load of the cables."""
    rig.pulleys[p, k.LOADED] += size
    dry(rig, p, size * rig.load(p), rng.uniform(1.5e-4, 3e-4))
    return {'coefficient': size}


def stribeck(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Hold more at rest than in motion, falling with a Gaussian of speed."""
    sliding, speed = size * rng.uniform(0.2, 0.7), math.exp(rng.uniform(-4.0, -1.9))
    row = rig.pulleys[p]
    row[k.STATIC] += size
    row[k.COULOMB] += sliding
    row[k.STRIBECK_SPEED] = speed
    dry(rig, p, size + sliding, rng.uniform(1.5e-4, 3e-4))
    half = speed * math.sqrt(math.log(2.0))  # at which half of the static part is gone
    return {'static': size, 'sliding': sliding, 'speed': half}


def presliding(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Rub after bristles have bent over a wide angle."""
    angle = math.exp(rng.uniform(math.log(4e-3), math.log(2e-2)))
    rig.pulleys[p, k.COULOMB] += size
    dry(rig, p, size, angle)
    return {'torque': size, 'angle': angle}


def asymmetric(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Rub more one way than the other."""
    part = sign(rng) * rng.uniform(0.4, 0.95)
    forward, backward = size * (1.0 + part), size * (1.0 - part)
    rig.pulleys[p, [k.FORWARD, k.BACKWARD]] += forward, backward
    dry(rig, p, size, rng.uniform(1.5e-4, 3e-4))
    return {'forward': forward, 'backward': backward}


def viscous(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Change the damper."""
    less = rng.random() < 0.3
    row = rig.pulleys[p]
    added = row[k.DAMPING] * (math.exp(-size) - 1.0 if less else size)
    row[k.DAMPING] += added
    return {'damping': float(added)}


def inertia(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Change the inertia; mostly more."""
    scale = math.exp(size * (sign(rng) if p == 4 else 1.0))
    rig.pulleys[p, k.INERTIA] *= scale
    return {'scale': scale}


def gravity(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Hang a weight on it."""
    phase = rng.uniform(-1.5, 1.5)
    rig.pulleys[p, [k.WEIGHT, k.WEIGHT_PHASE]] = size, phase
    return {'torque': size, 'phase': phase}


def spring(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Tie a spring to it."""
    rest = rng.uniform(-0.15, 0.15)
    rig.pulleys[p, [k.SPRING, k.SPRING_REST]] = size, rest
    return {'stiffness': size, 'rest': rest}


def eccentric(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Bore it off its centre."""
    amplitude, phase = sign(rng) * size, rng.uniform(-1.4, 1.4)
    rig.pulleys[p, [k.ECCENTRIC, k.ECCENTRIC_PHASE]] = amplitude, phase
    return {'amplitude': amplitude, 'phase': phase}


def disturbance(rig: Rig, p: int, size: float, rng: np.random.Generator) -> Values:
    """Push it for a while."""
    torque, start, length = sign(rng) * size, rng.uniform(2.0, 11.5), rng.uniform(0.3, 1.6)
    rig.pulleys[p, [k.PUSH, k.PUSH_START, k.PUSH_LENGTH]] = torque, start, length
    # the edges take a tenth each: a rectangle of the same area begins and ends half-way up
    return {'torque': torque, 'start': start + 0.05 * length, 'duration': 0.9 * length}
