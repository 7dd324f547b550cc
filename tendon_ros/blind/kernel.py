"""
The generator's own equations of motion, one tick of the controllers after the other.

:mod:`tendon_ros.blind.rig` has this file joined with the two that it imports, compiled and run.
Integration is semi-implicit Euler in steps of some ten microseconds, dampers taken at the end of
a step.
"""

import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.blind.columns import (
    AGE,
    ANGLE,
    ARM,
    BRISTLE,
    BRISTLE_DAMPING,
    CABLE_DAMPING,
    CROSSTALK,
    CYCLES,
    CYCLIC,
    DAMPING,
    DEAD,
    DROP,
    DROP_LENGTH,
    DROP_START,
    ECCENTRIC,
    ECCENTRIC_PHASE,
    EFFORT,
    FAST,
    FAST_TIME,
    FLATTENING,
    FORCE,
    GAIN,
    HELD,
    INERTIA,
    KD,
    KI,
    KP,
    LAG,
    LIMIT,
    PRELOAD,
    PRELOAD_STRETCH,
    READING,
    RESOLUTION,
    SATURATION,
    SCALE,
    SIDED,
    SLIP,
    SLIP_LENGTH,
    SLIP_START,
    SLOW,
    SLOW_TIME,
    SPEED,
    STIFFNESS,
    WARMING,
    WARMING_TIME,
    ZERO,
)
from tendon_ros.blind.forces import (
    aged,
    contact_force,
    friction_limit,
    hanging,
    off_command,
    other_torque,
    pulse,
    rounded_step,
    Row,
    softened,
    tension,
)

Floats = NDArray[np.float64]


def run(
    step: float,
    substeps: int,
    start: float,
    setpoint: Floats,
    drive: Floats,
    routes: Floats,
    pulleys: Floats,
    loops: Floats,
    slips: Floats,
    yields: Floats,
    motors: Floats,
    contact: Row,
    table: Row,
    spacing: float,
    out: Floats,
) -> int:
    """
    Run the rig tick by tick; with a drive its motors are moved, and their torque is what comes.

    ``setpoint`` (n, 2); ``drive`` (n + 1, 4): angles and speeds of both motors, or without rows;
    ``slips`` and ``yields`` (3, k): stiffness [N/m] and limit [N] of the loops' slip elements;
    ``start``: the time of the first tick; ``out``: (n, OUT_COLUMNS). Returns 0, or the tick after
    which a number was none.
    """
    driven = drive.shape[0] > 0
    ticks = setpoint.shape[0]
    tick = step * substeps
    theta, omega, bristle = np.zeros(5), np.zeros(5), np.zeros(5)
    wound, lever, torque, load = np.zeros(5), np.ones(5), np.zeros(5), np.zeros(5)
    fast, slow = np.zeros(3), np.zeros(3)
    pulled = np.zeros(slips.shape)
    before, behind = np.zeros(3), np.zeros(2)
    total, command, arrived, wanted, mean = (
        np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2),
    )  # fmt: skip
    last_error = np.zeros(2)
    past = np.zeros((2, ticks))
    first = True
    for n in range(ticks):
        if driven:
            for m in range(2):
                theta[m], omega[m] = drive[n, m], drive[n, 2 + m]
        for m in range(2):
            row = motors[m]
            angle = theta[m]
            reading = row[SCALE] * angle + row[ZERO]
            if row[CYCLIC] != 0.0:
                reading += row[CYCLIC] * math.sin(row[CYCLES] * angle)
            past[m, n] = reading
            reading = aged(past[m], n, row[AGE] / tick)
            out[n, READING + m] = reading
            if driven:
                continue
            seen = math.floor(reading / row[RESOLUTION] + 0.5) * row[RESOLUTION]
            error = setpoint[n, m] - seen
            if n == 0:
                last_error[m] = error
            asked = (
                row[KP] * error
                + row[KI] * (total[m] + error * tick)
                + row[KD] * (error - last_error[m]) / tick
            )
            if abs(asked) < row[LIMIT]:
                total[m] += error * tick
            last_error[m] = error
            command[m] = min(row[LIMIT], max(-row[LIMIT], asked))
        for p in range(5):
            out[n, ANGLE + p] = theta[p]
            out[n, SPEED + p] = omega[p]
        out[n, FORCE] = contact_force(contact, theta[3], omega[3])
        mean[0], mean[1] = 0.0, 0.0
        for s in range(substeps):
            t = start + n * tick + s * step
            for p in range(5):
                torque[p], load[p] = 0.0, 0.0
                wound[p] = theta[p]
                if p < 2 and motors[p, HELD] > 0.0:
                    half = 0.5 * motors[p, HELD]
                    behind[p] = min(theta[p] + half, max(theta[p] - half, behind[p]))
                    wound[p] = behind[p]
                e = pulleys[p, ECCENTRIC]
                if e != 0.0:
                    turn = theta[p] - pulleys[p, ECCENTRIC_PHASE]
                    wound[p] += e * (math.sin(turn) + math.sin(pulleys[p, ECCENTRIC_PHASE]))
                    lever[p] = 1.0 + e * math.cos(turn)
            for k in range(3):
                row = loops[k]
                stretch = 0.0
                for p in range(5):
                    stretch += routes[k, p] * wound[p]
                if row[SLIP] != 0.0:
                    stretch += row[SLIP] * rounded_step(t, row[SLIP_START], row[SLIP_LENGTH])
                if first:
                    before[k] = stretch
                change = stretch - before[k]
                before[k] = stretch
                x = softened(stretch, row[DEAD])
                one = row[STIFFNESS] * tension(table, spacing, row[PRELOAD_STRETCH] + x)
                two = row[STIFFNESS] * tension(table, spacing, row[PRELOAD_STRETCH] - x)
                force = one - two
                if row[FAST] > 0.0 or row[SLOW] > 0.0:
                    elastic = force
                    force -= row[FAST] * fast[k] + row[SLOW] * slow[k]
                    fast[k] += step * (elastic - fast[k]) / row[FAST_TIME]
                    slow[k] += step * (elastic - slow[k]) / row[SLOW_TIME]
                for i in range(slips.shape[1]):
                    if slips[k, i] > 0.0:
                        most = yields[k, i]
                        now = pulled[k, i] + slips[k, i] * change
                        pulled[k, i] = min(most, max(-most, now))
                        force += pulled[k, i]
                force += row[CABLE_DAMPING] * change / step
                for p in range(5):
                    arm = routes[k, p] * lever[p]
                    if arm != 0.0:
                        if pulleys[p, FLATTENING] != 0.0:
                            arm *= 1.0 - pulleys[p, FLATTENING] * (one + two - 2.0 * row[PRELOAD])
                        torque[p] -= arm * force
                        load[p] += abs(routes[k, p]) * (one + two)
            first = False
            torque[3] -= contact[ARM] * contact_force(contact, theta[3], omega[3])
            for p in range(5):
                row = pulleys[p]
                torque[p] += other_torque(row, theta[p], omega[p], t)
                stiffness = row[BRISTLE]
                if stiffness > 0.0:
                    if load[p] == 0.0:  # no cable: what hangs on it is what presses
                        load[p] = abs(hanging(row, theta[p]))
                    limit = friction_limit(row, omega[p], bristle[p], load[p])
                    limit += row[SIDED] * abs(theta[p])
                    if limit > 1e-9:
                        old = bristle[p]
                        fade = 1.0 + step * stiffness * abs(omega[p]) / limit
                        bristle[p] = (old + step * omega[p]) / fade
                        rate = (bristle[p] - old) / step
                        torque[p] -= stiffness * bristle[p] + row[BRISTLE_DAMPING] * rate
            for p in range(5):
                row = pulleys[p]
                damping = row[DAMPING]
                if row[WARMING] != 0.0:
                    damping *= 1.0 + row[WARMING] * (1.0 - math.exp(-t / row[WARMING_TIME]))
                if p < 2 and driven:
                    mean[p] += damping * omega[p] - torque[p]
                    part = (s + 1.0) / substeps
                    a, b = drive[n, p], drive[n + 1, p]
                    va, vb = drive[n, 2 + p] * tick, drive[n + 1, 2 + p] * tick
                    square, cube = part * part, part * part * part
                    theta[p] = (
                        a + va * (part - 2.0 * square + cube)
                        + (b - a) * (3.0 * square - 2.0 * cube) + vb * (cube - square)
                    )  # fmt: skip
                    omega[p] += (drive[n + 1, 2 + p] - drive[n, 2 + p]) / substeps
                    continue
                if p < 2:
                    motor = motors[p]
                    force = motor[GAIN] * (command[p] + motor[CROSSTALK] * command[1 - p])
                    if motor[DROP] != 0.0:
                        force *= 1.0 - motor[DROP] * pulse(
                            t, motor[DROP_START], motor[DROP_LENGTH]
                        )
                    part = abs(force) / motor[SATURATION]
                    force /= math.sqrt(math.sqrt(math.sqrt(1.0 + part**8)))
                    if motor[LAG] > 0.0:
                        arrived[p] += step * (force - arrived[p]) / motor[LAG]
                        force = arrived[p]
                    torque[p] += force + off_command(motor, theta[p])
                omega[p] = (omega[p] + step * torque[p] / row[INERTIA]) / (
                    1.0 + step * damping / row[INERTIA]
                )
                theta[p] += step * omega[p]
        for m in range(2):
            if driven:
                gained = drive[n + 1, 2 + m] - drive[n, 2 + m]
                needed = pulleys[m, INERTIA] * gained / tick + mean[m] / substeps
                wanted[m] = (needed - off_command(motors[m], drive[n, m])) / motors[m, GAIN]
                part = min(0.999, abs(wanted[m] * motors[m, GAIN]) / motors[m, SATURATION])
                wanted[m] /= math.sqrt(math.sqrt(math.sqrt(1.0 - part**8)))
            else:
                wanted[m] = command[m]
            out[n, EFFORT + m] = wanted[m]
        if not math.isfinite(theta[0] + theta[1] + theta[2] + theta[3] + theta[4]):
            return n + 1
    return 0
