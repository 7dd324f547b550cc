"""
Cable loops and signals: elongation, net force and sum of tensions of every loop, with derivatives.

Elongation ``delta = C theta``, net force of a loop ``T(delta) = t(d0 + delta) - t(d0 - delta)``:
two preloaded cables. Effects add to elongation and tension, let them relax, and may let a radius
vary.
"""

from __future__ import annotations

from tendon_ros.model.kernel.structure import (
    CURL, CURVE_BELOW, CURVE_CELLS, CURVE_OFFSET, CURVE_RATE, CURVE_START, DELTA, DRUM,
    ELONGATIONS, EPOCH, FOLLOW, Floats, Ints, LASH, LOOP_DAMPING, LOOP_PULLEY, M, N, PLAY,
    PRELOAD, RADIUS, RATE, RELAXATIONS, SCALE, SHIFT, SHIFT_D, SLACK, STATE_A, STATE_B,
    STATE_RATE, STATE_S, STATE_T, STATE_Z, TENSION, TENSIONS, TENSION_D, TENSION_R, TOTAL,
    TOTAL_D, TURN, WIDTH, WINDINGS, WOUND, elongation_law, relaxation_law, tension_law,
    winding_law,
)  # fmt: skip

#: part of a sample by which a motion's last one may be missed
NEARLY = 1e-6


def clipped(value: float, low: float, high: float) -> float:
    """Return the value, no less than low and no more than high."""
    return low if value < low else (high if value > high else value)


def limited(torque: float, limit: float, knee: float) -> tuple[float, float]:
    """Return the torque that a limited motor gives, and its slope by the one that is asked for."""
    size = abs(torque)
    width = max(knee, 1e-9) * limit
    within = clipped((size - (limit - width)) / (2.0 * width), 0.0, 1.0)
    given = min(size, limit - width) + 2.0 * width * within * (1.0 - 0.5 * within)
    return (given if torque > 0.0 else -given), 1.0 - within


def smooth(s: Floats, row: int, t: float) -> tuple[float, float, float]:
    """Return signal ``row`` at time t with its two derivatives, as ``Signals`` says; ends held."""
    rows = int(s[3])
    samples = int(s[2])
    u = (t - s[0]) * s[1]
    at = 4 + row * samples
    to = at + rows * samples
    more = to + rows * samples
    if u < 0.0:
        return s[at], 0.0, 0.0
    # at its last sample a motion has not stopped
    if samples == 1 or u > samples - 1 + NEARLY:
        return s[at + samples - 1], 0.0, 0.0
    cell = min(int(u), samples - 2)
    u -= cell
    a = s[at + cell]
    p = s[to + cell] / s[1]
    q = s[to + cell + 1] / s[1]
    rise = s[at + cell + 1] - a
    b = 3.0 * rise - 2.0 * p - q
    e = p + q - 2.0 * rise
    return (
        a + u * (p + u * (b + u * e)),
        (p + u * (2.0 * b + 3.0 * u * e)) * s[1],
        (2.0 * b + 6.0 * u * e) * s[1] * s[1]
        + (1.0 - u) * s[more + cell]
        + u * s[more + cell + 1],
    )


def cable(m: Floats, d: Ints, k: int, x: float) -> tuple[float, float]:
    """Return tension [N] and slope [N/m] of one cable of loop k at elongation x [m]."""
    u = (x - m[CURVE_START + k]) * m[CURVE_RATE + k]
    o = d[CURVE_OFFSET + k]
    if u <= 0.0:
        slope = m[CURVE_BELOW + k]
        return m[o] + slope * (x - m[CURVE_START + k]), slope
    cells = d[CURVE_CELLS + k]
    beyond = 0.0
    if u < cells:
        cell = int(u)
        u -= cell
    else:  # beyond the last point the curve goes on straight
        cell = cells - 1
        beyond = u - cells
        u = 1.0
    o += 4 * cell
    slope = m[o + 1] + u * (2.0 * m[o + 2] + 3.0 * u * m[o + 3])
    value = m[o] + u * (m[o + 1] + u * (m[o + 2] + u * m[o + 3]))
    return value + beyond * slope, slope * m[CURVE_RATE + k]


def wind(m: Floats, d: Ints, w: Floats, c: Floats, at: int) -> None:
    """Set the angles that the cables see, and how they turn with the pulleys."""
    for i in range(N):
        w[WOUND + i] = w[at + i]
        w[TURN + i] = 1.0
        w[CURL + i] = 0.0
        w[FOLLOW + i] = 1.0
        if m[LASH + i] > 0.0:
            behind = clipped(c[DRUM + i], w[at + i] - m[LASH + i], w[at + i] + m[LASH + i])
            if behind == c[DRUM + i]:
                w[FOLLOW + i] = 0.0
            w[WOUND + i] = behind
    for a in range(d[WINDINGS + 1]):
        n = d[WINDINGS] + 4 * a
        i = d[n + 1]
        arc, slope, curl = winding_law(d[n], w[at + i], m, d[n + 2])
        w[WOUND + i] += arc
        w[TURN + i] += slope
        w[CURL + i] += curl


def both(m: Floats, d: Ints, k: int, x: float) -> tuple[float, float, float, float]:
    """Return net force and sum of tensions [N] of loop k at elongation x [m], each with slope."""
    half = 0.5 * m[PLAY + k]
    inner = 0.0 if -half < x < half else 1.0
    x -= clipped(x, -half, half)
    first, slope = cable(m, d, k, m[PRELOAD + k] + x)
    second, other = cable(m, d, k, m[PRELOAD + k] - x)
    scale = m[SCALE + k]
    return (
        scale * (first - second),
        scale * (slope + other) * inner,
        scale * (first + second),
        scale * (slope - other) * inner,
    )


def relax(m: Floats, d: Ints, w: Floats, at: int) -> None:
    """Take from net forces and sums of tensions what has relaxed."""
    for a in range(d[RELAXATIONS + 1]):
        n = d[RELAXATIONS] + 4 * a
        k = d[n + 1]
        z = d[n + 3]
        x = w[DELTA + k] + w[SHIFT + k]
        settled, by_z, part, share, dz, dz_x, dz_z = relaxation_law(
            d[n], x, w[at + 2 * N + z], m, d[n + 2]
        )
        rest = 1.0 - share
        net, net_x, total, total_x = both(m, d, k, x)
        left, left_x, grip, grip_x = both(m, d, k, x - part * settled)
        gone, gone_x, lost, lost_x = both(m, d, k, settled)
        _, _, preload, _ = both(m, d, k, 0.0)
        w[TENSION + k] += rest * (left - net) - share * part * gone
        w[TENSION_D + k] += rest * (left_x - net_x) * w[SHIFT_D + k]
        w[TOTAL + k] += rest * (grip - total) - share * part * (lost - preload)
        w[TOTAL_D + k] += rest * (grip_x - total_x) * w[SHIFT_D + k]
        w[STATE_RATE + z] = dz
        w[STATE_A + z] = dz_x * w[SHIFT_D + k]
        w[STATE_B + z] = 0.0
        w[STATE_Z + z] = dz_z
        w[STATE_T + z] = -part * by_z * (rest * left_x + share * gone_x)
        w[STATE_S + z] = -part * by_z * (rest * grip_x + share * lost_x)


def pull(m: Floats, d: Ints, w: Floats, at: int) -> None:
    """Set elongation, net force and sum of tensions of every loop, with derivatives."""
    for k in range(M):
        delta = 0.0
        rate = 0.0
        for e in range(WIDTH):
            i = LOOP_PULLEY[WIDTH * k + e]
            r = m[RADIUS + WIDTH * k + e]
            delta += r * w[WOUND + i]
            rate += r * w[FOLLOW + i] * w[TURN + i] * w[at + N + i]
        w[DELTA + k] = delta
        w[RATE + k] = rate
        w[SHIFT + k] = 0.0
        w[SHIFT_D + k] = 1.0
    for a in range(d[ELONGATIONS + 1]):
        n = d[ELONGATIONS] + 4 * a
        k = d[n + 1]
        shift, by_d = elongation_law(d[n], w[DELTA + k], w[EPOCH], m, d[n + 2])
        w[SHIFT + k] += shift
        w[SHIFT_D + k] += by_d
    for k in range(M):
        x = w[DELTA + k] + w[SHIFT + k]
        net, net_x, total, total_x = both(m, d, k, x)
        w[TENSION + k] = net + m[LOOP_DAMPING + k] * w[RATE + k]
        w[TENSION_D + k] = net_x * w[SHIFT_D + k]
        w[TENSION_R + k] = m[LOOP_DAMPING + k]
        w[TOTAL + k] = total
        w[TOTAL_D + k] = total_x * w[SHIFT_D + k]
        w[SLACK + k] = m[PRELOAD + k] - m[CURVE_START + k] - max(0.0, abs(x) - 0.5 * m[PLAY + k])
    if d[RELAXATIONS + 1] > 0:
        relax(m, d, w, at)
    for a in range(d[TENSIONS + 1]):
        n = d[TENSIONS] + 4 * a
        k = d[n + 1]
        z = d[n + 3]
        value = w[at + 2 * N + z] if z >= 0 else 0.0
        extra, by_d, by_r, by_z, dz, dz_d, dz_r, dz_z = tension_law(
            d[n], w[DELTA + k], w[RATE + k], value, w[EPOCH], m, d[n + 2]
        )
        w[TENSION + k] += extra
        w[TENSION_D + k] += by_d
        w[TENSION_R + k] += by_r
        if z >= 0:
            w[STATE_RATE + z] = dz
            w[STATE_A + z] = dz_d
            w[STATE_B + z] = dz_r
            w[STATE_Z + z] = dz_z
            w[STATE_T + z] = by_z
            w[STATE_S + z] = 0.0
