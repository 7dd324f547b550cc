"""
The linear system of a step: derivatives, and the matrix that they make.

Angles follow velocities and every auxiliary state depends on one loop or one pulley, so both are
eliminated by hand; what is left is one banded matrix of the size of the network, whose cost grows
linearly with the cables.
"""

from __future__ import annotations

from tendon_ros.model.kernel.loops import smooth
from tendon_ros.model.kernel.structure import (
    ACCELERATION, ACTIVE, AHEAD, ARM, BAND, BUDGET_L, BUDGET_W, CHI, CONTACT_ARM, CONTACT_PULLEY,
    CONTACT_RATIO, DRIVE, FOLLOW, FORCE_Q, FORCE_V, Floats, GEARED, INERTIA, INTEGRAL, Ints,
    J_A, J_ANGLE, J_ARM, J_B, J_CONTACT, J_CONTACT_RATE, J_GRIP, J_LOOP, J_LOOP_RATE, J_PRESS,
    J_RADIUS, J_S, J_SPEED, J_T, J_TOTAL, J_Z, K, KAPPA, KD, KP, LOAD_T, LOAD_W, LOAD_WAY,
    LOOP_PULLEY, M, MATRIX, MODE, MOTOR_GAIN, MOTOR_PULLEY, N, OUTER, PUSH, RADIUS, REFERENCE,
    RIGHT, SIDE, SIGMA, SPAN, START, STATE_A, STATE_B, STATE_LOOP, STATE_PULLEY, STATE_S,
    STATE_T, STATE_Z, TENSION, TENSION_D, TENSION_R, TORQUE_T, TORQUE_W, TOTAL_D, TURN, U,
    WIDTH,
)  # fmt: skip


def linearise(m: Floats, d: Ints, w: Floats) -> None:
    """Keep the derivatives just evaluated, which the stages of a step overwrite."""
    for k in range(M):
        w[J_LOOP + k] = w[TENSION_D + k]
        w[J_LOOP_RATE + k] = w[TENSION_R + k]
        w[J_TOTAL + k] = w[TOTAL_D + k]
        for e in range(WIDTH):
            n = WIDTH * k + e
            i = LOOP_PULLEY[n]
            w[J_RADIUS + n] = m[RADIUS + n] * w[TURN + i] * w[FOLLOW + i]
            grip = w[SIDE + i] * w[BUDGET_L + i]
            w[J_ARM + n] = m[ARM + n] * w[TURN + i]
            w[J_GRIP + n] = grip * abs(m[RADIUS + n])
            if d[GEARED + i] == 1:  # its couplings press by what they transmit
                way = 1.0 if w[J_ARM + n] * w[TENSION + k] > 0.0 else -1.0
                w[J_ARM + n] *= 1.0 - way * grip
    for i in range(N):
        grip = w[SIDE + i] * w[BUDGET_L + i]
        w[J_ANGLE + i] = w[TORQUE_T + i] + grip * w[LOAD_T + i]
        w[J_SPEED + i] = w[TORQUE_W + i] + grip * w[LOAD_W + i] + w[SIDE + i] * w[BUDGET_W + i]
    for k in range(K):
        w[J_CONTACT + k] = m[CONTACT_ARM + k] * w[FORCE_Q + k]
        w[J_CONTACT_RATE + k] = m[CONTACT_ARM + k] * w[FORCE_V + k]
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            grip = w[SIDE + i] * w[BUDGET_L + i] * w[LOAD_WAY + i]
            w[J_PRESS + WIDTH * k + e] = m[CONTACT_RATIO + WIDTH * k + e] * (1.0 + grip)
    for z in range(d[ACTIVE]):
        w[J_A + z] = w[STATE_A + z]
        w[J_B + z] = w[STATE_B + z]
        w[J_Z + z] = w[STATE_Z + z]
        w[J_T + z] = w[STATE_T + z]
        w[J_S + z] = w[STATE_S + z]


def still(d: Ints, g: Ints, i: int) -> bool:
    """Whether pulley i takes no part in the equations: it sticks, or its motion is prescribed."""
    return d[DRIVE + i] == 1 or g[MODE + i] == 0


def hold(d: Ints, w: Floats, g: Ints) -> None:
    """Take the rows of pulleys that are still (stuck or prescribed) out of the equations."""
    for i in range(N):
        if not still(d, g, i):
            continue
        w[J_ANGLE + i] = 0.0
        w[J_SPEED + i] = 0.0
        for n in range(M * WIDTH):
            if LOOP_PULLEY[n] == i:
                w[J_ARM + n] = 0.0
                w[J_GRIP + n] = 0.0
        for n in range(K * WIDTH):
            if CONTACT_PULLEY[n] == i:
                w[J_PRESS + n] = 0.0
        for z in range(d[ACTIVE]):
            if d[STATE_PULLEY + z] == i:
                w[J_T + z] = 0.0


def outer(m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, t: float) -> None:
    """Set the derivative of the right-hand side by time: what signals and prescribed motion do."""
    for n in range(2 * N + d[ACTIVE]):
        w[OUTER + n] = 0.0
    for i in range(N):
        if d[PUSH + i] >= 0:
            _, slope, _ = smooth(s, d[PUSH + i], t)
            w[OUTER + N + i] += slope
    for j in range(U):
        z = d[INTEGRAL + j]
        if z >= 0 and w[STATE_A + z] != 0.0:  # a saturated controller has no derivative
            _, slope, second = smooth(s, d[REFERENCE + j], t)
            push = m[KP + j] * slope + m[KD + j] * m[AHEAD + j] * second
            w[OUTER + N + MOTOR_PULLEY[j]] += m[MOTOR_GAIN + j] * push
            w[OUTER + 2 * N + z] += slope
    for k in range(M):
        by_angle = 0.0
        by_rate = 0.0
        for e in range(WIDTH):
            i = LOOP_PULLEY[WIDTH * k + e]
            if d[DRIVE + i] == 1:
                by_angle += w[J_RADIUS + WIDTH * k + e] * w[START + N + i]
                by_rate += w[J_RADIUS + WIDTH * k + e] * w[ACCELERATION + i]
        by_force = w[J_LOOP + k] * by_angle + w[J_LOOP_RATE + k] * by_rate
        by_total = w[J_TOTAL + k] * by_angle
        for e in range(WIDTH):
            n = WIDTH * k + e
            w[OUTER + N + LOOP_PULLEY[n]] += w[J_GRIP + n] * by_total - w[J_ARM + n] * by_force
        for z in range(d[ACTIVE]):
            if d[STATE_LOOP + z] == k:
                w[OUTER + 2 * N + z] += w[J_A + z] * by_angle + w[J_B + z] * by_rate
    for k in range(K):
        push = 0.0
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            if d[DRIVE + i] == 1:
                ratio = m[CONTACT_RATIO + WIDTH * k + e]
                push += ratio * w[J_CONTACT + k] * w[START + N + i]
                push += ratio * w[J_CONTACT_RATE + k] * w[ACCELERATION + i]
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            w[OUTER + N + i] -= w[J_PRESS + WIDTH * k + e] * push
    for i in range(N):
        if still(d, g, i):
            w[OUTER + N + i] = 0.0
        else:
            w[OUTER + N + i] /= m[INERTIA + i]


def factor(m: Floats, d: Ints, w: Floats, p: float, per: float) -> None:
    """Set up and factorise the reduced matrix for a step with p = 1 / (gamma h) = 1 / per."""
    for n in range(N * SPAN):
        w[MATRIX + n] = 0.0
    for i in range(N):
        w[MATRIX + SPAN * i + BAND] = m[INERTIA + i] * p - w[J_ANGLE + i] * per - w[J_SPEED + i]
    for k in range(M):
        w[KAPPA + k] = w[J_LOOP + k] * per + w[J_LOOP_RATE + k]
        w[SIGMA + k] = w[J_TOTAL + k] * per
    for z in range(d[ACTIVE]):
        by = (w[J_A + z] * per + w[J_B + z]) / (p - w[J_Z + z])
        k = d[STATE_LOOP + z]
        if k >= 0:
            w[KAPPA + k] += w[J_T + z] * by
            w[SIGMA + k] += w[J_S + z] * by
        else:
            w[MATRIX + SPAN * d[STATE_PULLEY + z] + BAND] -= w[J_T + z] * by
    for k in range(M):
        for e in range(WIDTH):
            n = WIDTH * k + e
            i = LOOP_PULLEY[n]
            row = w[J_ARM + n] * w[KAPPA + k] - w[J_GRIP + n] * w[SIGMA + k]
            for f in range(WIDTH):
                j = LOOP_PULLEY[WIDTH * k + f]
                w[MATRIX + SPAN * i + BAND + j - i] += row * w[J_RADIUS + WIDTH * k + f]
    for k in range(K):
        stiff = w[J_CONTACT + k] * per + w[J_CONTACT_RATE + k]
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            for f in range(WIDTH):
                j = CONTACT_PULLEY[WIDTH * k + f]
                w[MATRIX + SPAN * i + BAND + j - i] += (
                    w[J_PRESS + WIDTH * k + e] * stiff * m[CONTACT_RATIO + WIDTH * k + f]
                )
    # LU within the band, without pivoting: the inertia keeps the diagonal in front
    for i in range(N):
        pivot = 1.0 / w[MATRIX + SPAN * i + BAND]
        w[MATRIX + SPAN * i + BAND] = pivot
        for r in range(1, BAND + 1):
            if i + r < N:
                low = MATRIX + SPAN * (i + r) + BAND - r
                w[low] *= pivot
                for n in range(1, BAND + 1):
                    w[low + n] -= w[low] * w[MATRIX + SPAN * i + BAND + n]


def solve(m: Floats, d: Ints, w: Floats, p: float, per: float, to: int) -> None:
    """Solve for one stage: right-hand side in ``w[RIGHT:]``, solution into ``w[to:]``."""
    for i in range(N):
        w[to + N + i] = m[INERTIA + i] * w[RIGHT + N + i] + w[J_ANGLE + i] * w[RIGHT + i] * per
    for k in range(M):
        delta = 0.0
        for e in range(WIDTH):
            delta += w[J_RADIUS + WIDTH * k + e] * w[RIGHT + LOOP_PULLEY[WIDTH * k + e]]
        delta *= per
        w[KAPPA + k] = w[J_LOOP + k] * delta
        w[SIGMA + k] = w[J_TOTAL + k] * delta
        w[CHI + k] = delta
    for z in range(d[ACTIVE]):
        k = d[STATE_LOOP + z]
        if k >= 0:
            value = (w[RIGHT + 2 * N + z] + w[J_A + z] * w[CHI + k]) / (p - w[J_Z + z])
            w[KAPPA + k] += w[J_T + z] * value
            w[SIGMA + k] += w[J_S + z] * value
        else:
            i = d[STATE_PULLEY + z]
            value = (w[RIGHT + 2 * N + z] + w[J_A + z] * w[RIGHT + i] * per) / (p - w[J_Z + z])
            w[to + N + i] += w[J_T + z] * value
    for k in range(M):
        for e in range(WIDTH):
            n = WIDTH * k + e
            pull_back = w[J_ARM + n] * w[KAPPA + k]
            w[to + N + LOOP_PULLEY[n]] += w[J_GRIP + n] * w[SIGMA + k] - pull_back
    for k in range(K):
        press = 0.0
        for e in range(WIDTH):
            press += m[CONTACT_RATIO + WIDTH * k + e] * w[RIGHT + CONTACT_PULLEY[WIDTH * k + e]]
        press *= w[J_CONTACT + k] * per
        for e in range(WIDTH):
            n = WIDTH * k + e
            w[to + N + CONTACT_PULLEY[n]] -= w[J_PRESS + n] * press
    for i in range(N):
        for r in range(1, BAND + 1):
            if i - r >= 0:
                w[to + N + i] -= w[MATRIX + SPAN * i + BAND - r] * w[to + N + i - r]
    for b in range(N):
        i = N - 1 - b
        for r in range(1, BAND + 1):
            if i + r < N:
                w[to + N + i] -= w[MATRIX + SPAN * i + BAND + r] * w[to + N + i + r]
        w[to + N + i] *= w[MATRIX + SPAN * i + BAND]
        w[to + i] = (w[RIGHT + i] + w[to + N + i]) * per
    for z in range(d[ACTIVE]):
        k = d[STATE_LOOP + z]
        value = w[RIGHT + 2 * N + z]
        if k >= 0:
            for e in range(WIDTH):
                i = LOOP_PULLEY[WIDTH * k + e]
                radius = w[J_RADIUS + WIDTH * k + e]
                value += radius * (w[J_A + z] * w[to + i] + w[J_B + z] * w[to + N + i])
        else:
            i = d[STATE_PULLEY + z]
            value += w[J_A + z] * w[to + i] + w[J_B + z] * w[to + N + i]
        w[to + 2 * N + z] = value / (p - w[J_Z + z])
