"""
One step of RODAS4, a stiffly accurate Rosenbrock method of order 4(3), on the reduced system.

Hairer and Wanner, "Solving Ordinary Differential Equations II", section IV.7: six stages, one
matrix, no Newton iteration. Angles follow velocities and every auxiliary state depends on one loop
or one pulley, so both are eliminated by hand; what is left is one banded matrix of the size of the
network, whose cost grows linearly with the cables.
"""

from __future__ import annotations

from tendon_ros.model.kernel.forces import evaluate, prescribe, smooth
from tendon_ros.model.kernel.structure import (
    FIRST,
    ACCELERATION, ACTIVE, ARM, BAND, BUDGET_L, BUDGET_W, CHI, CONTACT_ARM,
    CONTACT_PULLEY, CONTACT_RATIO, DELTA, DIM, DRIVE, F, FORCE_Q, FORCE_V, INERTIA, K, KAPPA, KD,
    KP, LOOP_PULLEY, M, MATRIX, MODE, MOTOR_GAIN, MOTOR_PULLEY, N, NEXT, OUTER, PSI, PUSH,
    RADIUS, REFERENCE, RIGHT, SIDE, SIGMA, SPAN, STAGE, START, STATE_A, STATE_B, STATE_LOOP,
    STATE_PULLEY, STATE_S, STATE_T, STATE_Z, TENSION_D, TENSION_R, TOLERANCE, TORQUE_T, TORQUE_W,
    TOTAL_D, TRIAL, TURN, U, WIDTH, Floats, Ints,
)  # fmt: skip

GAMMA = 0.25
A21 = 1.544
A31, A32 = 0.9466785280815826, 0.2557011698983284
A41, A42, A43 = 3.314825187068521, 2.896124015972201, 0.9986419139977817
A51, A52, A53, A54 = 1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895
C21 = -5.6688
C31, C32 = -2.430093356833875, -0.2063599157091915
C41, C42, C43 = -0.1073529058151375, -9.594562251023355, -20.47028614809616
C51, C52, C53, C54 = 7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616
C61, C62, C63 = 8.083246795921522, -7.981132988064893, -31.52159432874371
C64, C65 = 16.31930543123136, -6.058818238834054
T2, T3, T4 = 0.386, 0.21, 0.63
G1, G2, G3, G4 = 0.25, -0.1043, 0.1035, -0.03620000000000023
# dense output of order 3
D21, D22, D23 = 10.12623508344586, -7.487995877610167, -34.80091861555747
D24, D25 = -7.992771707568823, 1.025137723295662
D31, D32, D33 = -0.6762803392801253, 6.087714651680015, 16.43084320892478
D34, D35 = 24.76722511418386, -6.594389125716872
#: auxiliary states are of order one; this error of theirs counts as much as the angle's tolerance
STATE_TOLERANCE = 1e-5


def linearise(m: Floats, d: Ints, w: Floats) -> None:
    """Keep the derivatives of the state just evaluated while the stages of a step overwrite them."""
    for k in range(M):
        w[J_LOOP + k] = w[TENSION_D + k]
        w[J_LOOP_RATE + k] = w[TENSION_R + k]
        w[J_TOTAL + k] = w[TOTAL_D + k]
        for e in range(WIDTH):
            n = WIDTH * k + e
            i = LOOP_PULLEY[n]
            w[J_RADIUS + n] = m[RADIUS + n] * w[TURN + i]
            w[J_ARM + n] = m[ARM + n] * w[TURN + i]
            w[J_GRIP + n] = w[SIDE + i] * w[BUDGET_L + i] * abs(m[RADIUS + n])
    for i in range(N):
        w[J_ANGLE + i] = w[TORQUE_T + i]
        w[J_SPEED + i] = w[TORQUE_W + i] + w[SIDE + i] * w[BUDGET_W + i]
    for k in range(K):
        w[J_CONTACT + k] = m[CONTACT_ARM + k] * w[FORCE_Q + k]
        w[J_CONTACT_RATE + k] = m[CONTACT_ARM + k] * w[FORCE_V + k]
    for z in range(d[ACTIVE]):
        w[J_A + z] = w[STATE_A + z]
        w[J_B + z] = w[STATE_B + z]
        w[J_Z + z] = w[STATE_Z + z]
        w[J_T + z] = w[STATE_T + z]
        w[J_S + z] = w[STATE_S + z]


def still(d: Ints, g: Ints, i: int) -> bool:
    """Whether pulley i takes no part in the equations: it sticks, or its motion is prescribed."""
    return d[DRIVE + i] == 1 or g[MODE + i] == 0


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
            push = m[KP + j] * slope + m[KD + j] * second
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
            w[OUTER + N + i] -= m[CONTACT_RATIO + WIDTH * k + e] * push
    for i in range(N):
        if still(d, g, i):
            w[OUTER + N + i] = 0.0
        else:
            w[OUTER + N + i] /= m[INERTIA + i]


def factor(m: Floats, d: Ints, w: Floats, g: Ints, h: float) -> None:
    """Set up and factorise the reduced matrix for step h; rows of pulleys that are still are 1."""
    p = 1.0 / (GAMMA * h)
    for n in range(N * SPAN):
        w[MATRIX + n] = 0.0
    for i in range(N):
        w[MATRIX + SPAN * i + BAND] = m[INERTIA + i] * p - w[J_ANGLE + i] / p - w[J_SPEED + i]
    for k in range(M):
        w[KAPPA + k] = w[J_LOOP + k] / p + w[J_LOOP_RATE + k]
        w[SIGMA + k] = w[J_TOTAL + k] / p
    for z in range(d[ACTIVE]):
        by = (w[J_A + z] / p + w[J_B + z]) / (p - w[J_Z + z])
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
        stiff = w[J_CONTACT + k] / p + w[J_CONTACT_RATE + k]
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            for f in range(WIDTH):
                j = CONTACT_PULLEY[WIDTH * k + f]
                w[MATRIX + SPAN * i + BAND + j - i] += (
                    m[CONTACT_RATIO + WIDTH * k + e] * stiff * m[CONTACT_RATIO + WIDTH * k + f]
                )
    for i in range(N):
        if still(d, g, i):
            for n in range(SPAN):
                w[MATRIX + SPAN * i + n] = 0.0
            w[MATRIX + SPAN * i + BAND] = 1.0
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


def solve(m: Floats, d: Ints, w: Floats, g: Ints, h: float, to: int) -> None:
    """Solve for one stage: right-hand side in ``w[RIGHT:]``, solution into ``w[to:]``."""
    p = 1.0 / (GAMMA * h)
    per = GAMMA * h
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
            w[to + N + LOOP_PULLEY[n]] += w[J_GRIP + n] * w[SIGMA + k] - w[J_ARM + n] * w[KAPPA + k]
    for k in range(K):
        press = 0.0
        for e in range(WIDTH):
            press += m[CONTACT_RATIO + WIDTH * k + e] * w[RIGHT + CONTACT_PULLEY[WIDTH * k + e]]
        press *= w[J_CONTACT + k] * per
        for e in range(WIDTH):
            n = WIDTH * k + e
            w[to + N + CONTACT_PULLEY[n]] -= m[CONTACT_RATIO + n] * press
    for i in range(N):
        if still(d, g, i):
            w[to + N + i] = 0.0
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
                r = w[J_RADIUS + WIDTH * k + e]
                value += r * (w[J_A + z] * w[to + i] + w[J_B + z] * w[to + N + i])
        else:
            i = d[STATE_PULLEY + z]
            value += w[J_A + z] * w[to + i] + w[J_B + z] * w[to + N + i]
        w[to + 2 * N + z] = value / (p - w[J_Z + z])


def load(d: Ints, w: Floats, g: Ints, h: float, kick: float) -> None:
    """Start the right-hand side of a stage: f plus the direct dependence on time."""
    for i in range(N):
        w[RIGHT + i] = 0.0 if still(d, g, i) else w[F + i]
        w[RIGHT + N + i] = w[F + N + i] + h * kick * w[OUTER + N + i]
    for n in range(2 * N, 2 * N + d[ACTIVE]):
        w[RIGHT + n] = w[F + n] + h * kick * w[OUTER + n]


def step(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float
) -> float:
    """
    Take one step from ``w[START:]``, linearised there, to ``w[NEXT:]``; return its error.

    The error is in units of the tolerance: a step is good below 1.
    """
    size = 2 * N + d[ACTIVE]
    factor(m, d, w, g, h)
    u1 = STAGE
    u2 = STAGE + DIM
    u3 = STAGE + 2 * DIM
    u4 = STAGE + 3 * DIM
    u5 = STAGE + 4 * DIM
    u6 = STAGE + 5 * DIM
    per = 1.0 / h
    for n in range(size):
        w[F + n] = w[FIRST + n]
    load(d, w, g, h, G1)
    solve(m, d, w, g, h, u1)

    for n in range(size):
        w[TRIAL + n] = w[START + n] + A21 * w[u1 + n]
    prescribe(m, d, w, s, t + T2 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T2 * h, TRIAL)
    load(d, w, g, h, G2)
    for n in range(size):
        w[RIGHT + n] += per * (C21 * w[u1 + n])
    solve(m, d, w, g, h, u2)

    for n in range(size):
        w[TRIAL + n] = w[START + n] + A31 * w[u1 + n] + A32 * w[u2 + n]
    prescribe(m, d, w, s, t + T3 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T3 * h, TRIAL)
    load(d, w, g, h, G3)
    for n in range(size):
        w[RIGHT + n] += per * (C31 * w[u1 + n] + C32 * w[u2 + n])
    solve(m, d, w, g, h, u3)

    for n in range(size):
        w[TRIAL + n] = w[START + n] + A41 * w[u1 + n] + A42 * w[u2 + n] + A43 * w[u3 + n]
    prescribe(m, d, w, s, t + T4 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T4 * h, TRIAL)
    load(d, w, g, h, G4)
    for n in range(size):
        w[RIGHT + n] += per * (C41 * w[u1 + n] + C42 * w[u2 + n] + C43 * w[u3 + n])
    solve(m, d, w, g, h, u4)

    for n in range(size):
        w[TRIAL + n] = (
            w[START + n] + A51 * w[u1 + n] + A52 * w[u2 + n] + A53 * w[u3 + n] + A54 * w[u4 + n]
        )
    prescribe(m, d, w, s, t + h, TRIAL)
    evaluate(m, d, w, g, s, c, t + h, TRIAL)
    load(d, w, g, h, 0.0)
    for n in range(size):
        w[RIGHT + n] += per * (
            C51 * w[u1 + n] + C52 * w[u2 + n] + C53 * w[u3 + n] + C54 * w[u4 + n]
        )
    solve(m, d, w, g, h, u5)

    for n in range(size):
        w[TRIAL + n] += w[u5 + n]
    prescribe(m, d, w, s, t + h, TRIAL)
    evaluate(m, d, w, g, s, c, t + h, TRIAL)
    load(d, w, g, h, 0.0)
    for n in range(size):
        w[RIGHT + n] += per * (
            C61 * w[u1 + n] + C62 * w[u2 + n] + C63 * w[u3 + n] + C64 * w[u4 + n] + C65 * w[u5 + n]
        )
    solve(m, d, w, g, h, u6)

    total = 0.0
    for n in range(size):
        w[NEXT + n] = w[TRIAL + n] + w[u6 + n]
    for i in range(N):
        # an error in velocity counts by the angle it makes within the step or 10 ms
        a = w[u6 + i]
        b = w[u6 + N + i] * min(h, 0.01)
        total += a * a + b * b
    total /= m[TOLERANCE] * m[TOLERANCE]
    for n in range(2 * N, size):
        total += (w[u6 + n] / STATE_TOLERANCE) ** 2
    prescribe(m, d, w, s, t + h, NEXT)
    return float((total / size) ** 0.5)


def between(d: Ints, w: Floats, part: float, to: int) -> None:
    """Set the state at ``part`` (0..1) of the step just taken from its dense output into ``w[to:]``."""
    rest = 1.0 - part
    for n in range(2 * N + d[ACTIVE]):
        a = w[STAGE + n]
        b = w[STAGE + DIM + n]
        e = w[STAGE + 2 * DIM + n]
        f = w[STAGE + 3 * DIM + n]
        v = w[STAGE + 4 * DIM + n]
        first = D21 * a + D22 * b + D23 * e + D24 * f + D25 * v
        second = D31 * a + D32 * b + D33 * e + D34 * f + D35 * v
        w[to + n] = rest * w[START + n] + part * (
            w[NEXT + n] + rest * (first + part * second)
        )
