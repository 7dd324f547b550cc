"""
The laws of the generator's rig, of scalars and rows of its tables.

Read, joined with :mod:`tendon_ros.blind.kernel` and compiled; it uses nothing but arithmetic.
"""

from collections.abc import Sequence
import math

from tendon_ros.blind.columns import (
    ARM,
    BACKWARD,
    BIAS,
    CLOSED,
    CONTACT,
    CONTACT_DAMPING,
    COULOMB,
    CUBIC,
    DRAG,
    FORWARD,
    LOADED,
    NOTCH,
    NOTCH_AT,
    NOTCH_WIDTH,
    PAD,
    PAD_DEPTH,
    PUSH,
    PUSH_LENGTH,
    PUSH_START,
    RIPPLE,
    RIPPLE_CYCLES,
    RIPPLE_PHASE,
    RIPPLE_SECOND,
    SPRING,
    SPRING_REST,
    STATIC,
    STOP,
    STOP_AT,
    STRIBECK_SPEED,
    WALL,
    WEIGHT,
    WEIGHT_PHASE,
)

Row = Sequence[float]


def tension(table: Row, spacing: float, stretch: float) -> float:
    """Return the tension of one cable, from a table of even spacing; slack below zero."""
    if stretch <= 0.0:
        return 0.0
    place = stretch / spacing
    k = int(place)
    last = len(table) - 2
    if k > last:
        k = last
    return table[k] + (place - k) * (table[k + 1] - table[k])


def rounded_step(t: float, start: float, length: float) -> float:
    """Return 0 before, 1 after, and half a cosine over the length."""
    if t <= start:
        return 0.0
    if t >= start + length:
        return 1.0
    return 0.5 - 0.5 * math.cos(math.pi * (t - start) / length)


def pulse(t: float, start: float, length: float) -> float:
    """Return a pulse whose edges take a tenth of its length."""
    edge = 0.1 * length
    return rounded_step(t, start, edge) - rounded_step(t, start + length - edge, edge)


def softened(stretch: float, half: float) -> float:
    """Return what is left of an elongation beyond a play with rounded corners."""
    if half <= 0.0:
        return stretch
    corner = 0.1 * half
    over, under = stretch - half, -stretch - half
    return 0.5 * (
        over + math.sqrt(over * over + corner * corner)
        - under - math.sqrt(under * under + corner * corner)
    )  # fmt: skip


def aged(past: Row, newest: int, age: float) -> float:
    """Return a reading that is some ticks old."""
    place = newest - age
    if place <= 0.0:
        return past[0]
    k = int(place)
    if k >= newest:
        return past[newest]
    return past[k] + (place - k) * (past[k + 1] - past[k])


def friction_limit(row: Row, omega: float, bristle: float, load: float) -> float:
    """Return the friction at steady sliding [N m]: exponential in speed, linear in load."""
    limit = row[COULOMB] + row[LOADED] * load
    if row[STATIC] > 0.0:
        part = omega / row[STRIBECK_SPEED]
        limit += row[STATIC] * math.exp(-part * part)
    if row[FORWARD] + row[BACKWARD] > 0.0:
        way = omega if abs(omega) > 1e-6 else bristle
        limit += row[FORWARD] if way > 0.0 else row[BACKWARD]
    return limit


def hanging(row: Row, theta: float) -> float:
    """Return the torque of a weight [N m]."""
    return -row[WEIGHT] * math.sin(theta - row[WEIGHT_PHASE])


def other_torque(row: Row, theta: float, omega: float, t: float) -> float:
    """Return springs, weights, pushes and what no catalogue has [N m]."""
    torque = hanging(row, theta)
    torque -= row[SPRING] * (theta - row[SPRING_REST]) + row[CUBIC] * theta**3
    torque -= row[DRAG] * omega * abs(omega)
    if row[PUSH] != 0.0:
        torque += row[PUSH] * pulse(t, row[PUSH_START], row[PUSH_LENGTH])
    if row[NOTCH] != 0.0:
        part = (theta - row[NOTCH_AT]) / row[NOTCH_WIDTH]
        torque -= row[NOTCH] * part * math.exp(0.5 - 0.5 * part * part)
    if row[STOP] > 0.0 and theta > row[STOP_AT]:
        torque -= row[STOP] * (theta - row[STOP_AT])
    return torque


def contact_force(contact: Row, theta: float, omega: float) -> float:
    """Return the force at the tip [N]: spring and damper while they push, a soft pad before."""
    depth = theta - contact[WALL]
    if contact[CLOSED] < 0.5 or depth <= 0.0:
        return 0.0
    stretch = contact[ARM] * depth
    if contact[PAD] > 0.0:
        pad = contact[PAD_DEPTH]
        soft = stretch if stretch < pad else pad
        force = contact[CONTACT] * (stretch - soft + contact[PAD] * soft)
    else:
        force = contact[CONTACT] * stretch
    return max(0.0, force + contact[CONTACT_DAMPING] * contact[ARM] * omega)


def off_command(motor: Row, theta: float) -> float:
    """Return what a motor does besides what it is told: offset and cogging with a second wave."""
    torque = motor[BIAS]
    if motor[RIPPLE] != 0.0:
        turn = motor[RIPPLE_CYCLES] * theta - motor[RIPPLE_PHASE]
        torque += motor[RIPPLE] * (math.sin(turn) + motor[RIPPLE_SECOND] * math.sin(2.0 * turn))
    return torque
