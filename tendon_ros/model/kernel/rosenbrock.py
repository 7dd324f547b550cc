"""
One step of RODAS4, a stiffly accurate Rosenbrock method of order 4(3).

Hairer and Wanner, "Solving Ordinary Differential Equations II", section IV.7: six stages, one
matrix, no Newton iteration.
"""

from __future__ import annotations

import math

from tendon_ros.model.kernel.forces import evaluate, prescribe
from tendon_ros.model.kernel.linear import factor, solve
from tendon_ros.model.kernel.structure import (
    ACTIVE, DIM, F, FIRST, Floats, Ints, N, NEXT, OUTER, RIGHT, STAGE, START, TOLERANCE, TRIAL,
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
#: auxiliary states are of order one: so many times the angle's tolerance is as bad in them
STATE_RATIO = 100.0


def load(d: Ints, w: Floats, kick: float) -> None:
    """Start the right-hand side of a stage: f plus the direct dependence on time."""
    for n in range(2 * N):
        w[RIGHT + n] = w[F + n] + kick * w[OUTER + n]
    for n in range(2 * N, 2 * N + d[ACTIVE]):
        w[RIGHT + n] = w[F + n] + kick * w[OUTER + n]


def step(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float
) -> float:
    """
    Take one step from ``w[START:]``, linearised there, to ``w[NEXT:]``; return its error.

    The error is in units of the tolerance: a step is good below 1.
    """
    size = 2 * N + d[ACTIVE]
    p = 1.0 / (GAMMA * h)
    gamma_h = GAMMA * h
    factor(m, d, w, p, gamma_h)
    u1 = STAGE
    u2 = STAGE + DIM
    u3 = STAGE + 2 * DIM
    u4 = STAGE + 3 * DIM
    u5 = STAGE + 4 * DIM
    u6 = STAGE + 5 * DIM
    per = 1.0 / h
    for n in range(2 * N):
        w[F + n] = w[FIRST + n]
    for n in range(2 * N, size):
        w[F + n] = w[FIRST + n]
    load(d, w, h * G1)
    solve(m, d, w, p, gamma_h, u1)

    for n in range(2 * N):
        w[TRIAL + n] = w[START + n] + A21 * w[u1 + n]
    for n in range(2 * N, size):
        w[TRIAL + n] = w[START + n] + A21 * w[u1 + n]
    prescribe(m, d, w, s, t + T2 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T2 * h, TRIAL)
    load(d, w, h * G2)
    for n in range(2 * N):
        w[RIGHT + n] += per * (C21 * w[u1 + n])
    for n in range(2 * N, size):
        w[RIGHT + n] += per * (C21 * w[u1 + n])
    solve(m, d, w, p, gamma_h, u2)

    for n in range(2 * N):
        w[TRIAL + n] = w[START + n] + A31 * w[u1 + n] + A32 * w[u2 + n]
    for n in range(2 * N, size):
        w[TRIAL + n] = w[START + n] + A31 * w[u1 + n] + A32 * w[u2 + n]
    prescribe(m, d, w, s, t + T3 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T3 * h, TRIAL)
    load(d, w, h * G3)
    for n in range(2 * N):
        w[RIGHT + n] += per * (C31 * w[u1 + n] + C32 * w[u2 + n])
    for n in range(2 * N, size):
        w[RIGHT + n] += per * (C31 * w[u1 + n] + C32 * w[u2 + n])
    solve(m, d, w, p, gamma_h, u3)

    for n in range(2 * N):
        w[TRIAL + n] = w[START + n] + A41 * w[u1 + n] + A42 * w[u2 + n] + A43 * w[u3 + n]
    for n in range(2 * N, size):
        w[TRIAL + n] = w[START + n] + A41 * w[u1 + n] + A42 * w[u2 + n] + A43 * w[u3 + n]
    prescribe(m, d, w, s, t + T4 * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + T4 * h, TRIAL)
    load(d, w, h * G4)
    for n in range(2 * N):
        w[RIGHT + n] += per * (C41 * w[u1 + n] + C42 * w[u2 + n] + C43 * w[u3 + n])
    for n in range(2 * N, size):
        w[RIGHT + n] += per * (C41 * w[u1 + n] + C42 * w[u2 + n] + C43 * w[u3 + n])
    solve(m, d, w, p, gamma_h, u4)

    for n in range(2 * N):
        w[TRIAL + n] = (
            w[START + n] + A51 * w[u1 + n] + A52 * w[u2 + n] + A53 * w[u3 + n] + A54 * w[u4 + n]
        )
    for n in range(2 * N, size):
        w[TRIAL + n] = (
            w[START + n] + A51 * w[u1 + n] + A52 * w[u2 + n] + A53 * w[u3 + n] + A54 * w[u4 + n]
        )
    prescribe(m, d, w, s, t + h, TRIAL)
    evaluate(m, d, w, g, s, c, t + h, TRIAL)
    load(d, w, 0.0)
    for n in range(2 * N):
        w[RIGHT + n] += per * (
            C51 * w[u1 + n] + C52 * w[u2 + n] + C53 * w[u3 + n] + C54 * w[u4 + n]
        )
    for n in range(2 * N, size):
        w[RIGHT + n] += per * (
            C51 * w[u1 + n] + C52 * w[u2 + n] + C53 * w[u3 + n] + C54 * w[u4 + n]
        )
    solve(m, d, w, p, gamma_h, u5)

    for n in range(2 * N):
        w[TRIAL + n] += w[u5 + n]
    for n in range(2 * N, size):
        w[TRIAL + n] += w[u5 + n]
    prescribe(m, d, w, s, t + h, TRIAL)
    evaluate(m, d, w, g, s, c, t + h, TRIAL)
    load(d, w, 0.0)
    for n in range(2 * N):
        w[RIGHT + n] += per * (
            C61 * w[u1 + n] + C62 * w[u2 + n] + C63 * w[u3 + n] + C64 * w[u4 + n] + C65 * w[u5 + n]
        )
    for n in range(2 * N, size):
        w[RIGHT + n] += per * (
            C61 * w[u1 + n] + C62 * w[u2 + n] + C63 * w[u3 + n] + C64 * w[u4 + n] + C65 * w[u5 + n]
        )
    solve(m, d, w, p, gamma_h, u6)

    total = 0.0
    for n in range(2 * N):
        w[NEXT + n] = w[TRIAL + n] + w[u6 + n]
    for n in range(2 * N, size):
        w[NEXT + n] = w[TRIAL + n] + w[u6 + n]
    for i in range(N):
        # an error in velocity counts by the angle it makes within the step or 10 ms
        a = w[u6 + i]
        b = w[u6 + N + i] * min(h, 0.01)
        total += a * a + b * b
    for n in range(2 * N, size):
        total += (w[u6 + n] / STATE_RATIO) ** 2
    total /= m[TOLERANCE] * m[TOLERANCE]
    prescribe(m, d, w, s, t + h, NEXT)
    return math.sqrt(total / size)


def between(d: Ints, w: Floats, part: float, to: int) -> None:
    """Set ``w[to:]`` to the state at ``part`` (0..1) of the step just taken: dense output."""
    rest = 1.0 - part
    for n in range(2 * N + d[ACTIVE]):
        a = w[STAGE + n]
        b = w[STAGE + DIM + n]
        e = w[STAGE + 2 * DIM + n]
        f = w[STAGE + 3 * DIM + n]
        v = w[STAGE + 4 * DIM + n]
        first = D21 * a + D22 * b + D23 * e + D24 * f + D25 * v
        second = D31 * a + D32 * b + D33 * e + D34 * f + D35 * v
        w[to + n] = rest * w[START + n] + part * (w[NEXT + n] + rest * (first + part * second))
