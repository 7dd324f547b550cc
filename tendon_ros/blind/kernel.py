"""
The bench's own equations of motion, one millisecond after the other.

This file is read, compiled and run by :func:`tendon_ros.model.engine.engine_of`; it uses nothing
but arithmetic and arrays. Rows of the tables are pulleys M, L, 1, 2, 3, loops m1, 12, L3 and
motors M, L; their columns have the names below. Integration is semi-implicit Euler in steps of
some ten microseconds, dampers taken at the end of a step.
"""

import math

import numpy as np

# columns of the pulleys' table
INERTIA, DAMPING, COULOMB, LOADED, STATIC, STRIBECK_SPEED, FORWARD, BACKWARD = range(8)
BRISTLE, BRISTLE_DAMPING, ECCENTRIC, ECCENTRIC_PHASE, WEIGHT, WEIGHT_PHASE = range(8, 14)
SPRING, SPRING_REST, PUSH, PUSH_START, PUSH_LENGTH, DRAG, CUBIC = range(14, 21)
NOTCH, NOTCH_AT, NOTCH_WIDTH, STOP, STOP_AT, WARMING, WARMING_TIME = range(21, 28)
FLATTENING, SIDED, PULLEY_COLUMNS = range(28, 31)

# columns of the loops' table
STIFFNESS, PRELOAD, PRELOAD_STRETCH, DEAD, FAST, FAST_TIME, SLOW, SLOW_TIME = range(8)
SLIP, SLIP_START, SLIP_LENGTH, CABLE_DAMPING, LOOP_COLUMNS = range(8, 13)

# columns of the motors' table
KP, KI, KD, LIMIT, GAIN, BIAS, RIPPLE, RIPPLE_CYCLES, RIPPLE_PHASE, RIPPLE_SECOND = range(10)
SATURATION, LAG, CROSSTALK, DROP, DROP_START, DROP_LENGTH = range(10, 16)
ZERO, SCALE, RESOLUTION, AGE, CYCLIC, CYCLES, MOTOR_COLUMNS = range(16, 23)

# numbers of the contact
CONTACT, CONTACT_DAMPING, WALL, ARM, CLOSED, PAD, PAD_DEPTH, CONTACT_NUMBERS = range(8)

# columns of what comes out, once a tick
ANGLE, SPEED, EFFORT, FORCE, READING, OUT_COLUMNS = 0, 5, 10, 12, 13, 15


def tension(table, spacing, stretch):
    """Return the tension of one cable, from a table of even spacing; slack below zero."""
    if stretch <= 0.0:
        return 0.0
    place = stretch / spacing
    k = int(place)
    last = table.shape[0] - 2
    if k > last:
        k = last
    return table[k] + (place - k) * (table[k + 1] - table[k])


def rounded_step(t, start, length):
    """Return 0 before, 1 after, and half a cosine over the length."""
    if t <= start:
        return 0.0
    if t >= start + length:
        return 1.0
    return 0.5 - 0.5 * math.cos(math.pi * (t - start) / length)


def pulse(t, start, length):
    """Return a pulse whose edges take a tenth of its length."""
    edge = 0.1 * length
    return rounded_step(t, start, edge) - rounded_step(t, start + length - edge, edge)


def softened(stretch, half):
    """Return what is left of an elongation beyond a play with rounded corners."""
    if half <= 0.0:
        return stretch
    corner = 0.1 * half
    over, under = stretch - half, -stretch - half
    return 0.5 * (
        over + math.sqrt(over * over + corner * corner)
        - under - math.sqrt(under * under + corner * corner)
    )  # fmt: skip


def aged(past, newest, age):
    """Return a reading that is some ticks old."""
    place = newest - age
    if place <= 0.0:
        return past[0]
    k = int(place)
    if k >= newest:
        return past[newest]
    return past[k] + (place - k) * (past[k + 1] - past[k])


def friction_limit(row, omega, bristle, load):
    """Return the friction at steady sliding [N m]: exponential in speed, linear in load."""
    limit = row[COULOMB] + row[LOADED] * load
    if row[STATIC] > 0.0:
        part = omega / row[STRIBECK_SPEED]
        limit += row[STATIC] * math.exp(-part * part)
    if row[FORWARD] + row[BACKWARD] > 0.0:
        way = omega if abs(omega) > 1e-6 else bristle
        limit += row[FORWARD] if way > 0.0 else row[BACKWARD]
    return limit


def other_torque(row, theta, omega, t):
    """Return springs, weights, pushes and what no catalogue has [N m]."""
    torque = -row[WEIGHT] * math.sin(theta - row[WEIGHT_PHASE])
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


def contact_force(contact, theta, omega):
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


def run(
    step, substeps, start, setpoint, drive, routes, pulleys, loops, slips, yields, motors,
    contact, table, spacing, out,
):  # fmt: skip
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
    before = np.zeros(3)
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


def off_command(motor, theta):
    """Return what a motor does besides what it is told: offset and cogging with a second wave."""
    torque = motor[BIAS]
    if motor[RIPPLE] != 0.0:
        turn = motor[RIPPLE_CYCLES] * theta - motor[RIPPLE_PHASE]
        torque += motor[RIPPLE] * (math.sin(turn) + motor[RIPPLE_SECOND] * math.sin(2.0 * turn))
    return torque
