"""
Forces: contacts, dry friction, controllers that act continuously, and the right-hand side.

Equations (1)-(6) of the paper, as a network: torque ``-C^T T(delta)`` on every pulley. Nothing
here knows of five pulleys.
"""

from __future__ import annotations

from tendon_ros.model.kernel.loops import clipped, limited, pull, smooth, wind
from tendon_ros.model.kernel.structure import (
    ACCELERATION, ACTIVE, AHEAD, ARM, BREAKAWAY, BRISTLE, BRISTLED, BUDGET, BUDGETS, BUDGET_L,
    BUDGET_W, COMMAND, CONTACT_ARM, CONTACT_DAMPING, CONTACT_LAW, CONTACT_ON,
    CONTACT_POSITION, CONTACT_PULLEY, CONTACT_RATIO, CONTACT_STIFFNESS, CURL, DAMPING,
    DITHER, DRIVE, DRIVEN, DRY, EPOCH, F, FORCE, FORCE_Q, FORCE_V, Floats, GAP, GEARED, INERTIA,
    INPUT, INTEGRAL, Ints, K, KD, KI, KP, LIMIT, LOAD, LOAD_T, LOAD_W, LOAD_WAY,
    LOOP_PULLEY, M, MODE, MOTION, MOTOR_BIAS, MOTOR_GAIN, MOTOR_KNEE, MOTOR_LIMIT, MOTOR_PULLEY, N,
    PUSH, PUSHED, RADIUS, REFERENCE, SIDE, STATE_A, STATE_B, STATE_RATE, STATE_T, STATE_Z,
    STILL, TENSION, TORQUE, TORQUES, TORQUE_T, TORQUE_W, TOTAL, TOUCH, TURN, U, WIDTH,
    budget_law, torque_law,
)  # fmt: skip


def touch(m: Floats, d: Ints, w: Floats, g: Ints, at: int) -> None:
    """Set force and event function of every contact: closed where that is positive."""
    for k in range(K):
        q = -m[CONTACT_POSITION + k]
        v = 0.0
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            q += m[CONTACT_RATIO + WIDTH * k + e] * w[at + i]
            v += m[CONTACT_RATIO + WIDTH * k + e] * w[at + N + i]
        arm = m[CONTACT_ARM + k]
        stiff = m[CONTACT_STIFFNESS + k] * arm
        damp = m[CONTACT_DAMPING + k] * arm
        if d[CONTACT_LAW + k] == 0:
            force = stiff * q + damp * v
            by_q = stiff
            by_v = damp
            w[GAP + k] = min(q, force / stiff)
        else:  # Hunt-Crossley: no jump at touch
            force = stiff * q * (1.0 + damp * v)
            by_q = stiff * (1.0 + damp * v)
            by_v = stiff * q * damp
            w[GAP + k] = min(q, 1.0 + damp * v)
        if d[CONTACT_ON + k] == 0:
            w[GAP + k] = -1.0
        if g[TOUCH + k] == 1:
            w[FORCE + k] = force
            w[FORCE_Q + k] = by_q
            w[FORCE_V + k] = by_v
        else:
            w[FORCE + k] = 0.0
            w[FORCE_Q + k] = 0.0
            w[FORCE_V + k] = 0.0


def burden(d: Ints, w: Floats) -> None:
    """
    Begin the load of every pulley: on one without cables, what acts on it from outside.

    Called when contacts and laws are all that the torques hold so far.
    """
    for i in range(N):
        way = 0.0
        if d[GEARED + i] == 1:
            way = 1.0 if w[TORQUE + i] > 0.0 else -1.0
        w[LOAD_WAY + i] = way
        w[LOAD + i] = way * w[TORQUE + i]
        w[LOAD_T + i] = way * w[TORQUE_T + i]
        w[LOAD_W + i] = way * w[TORQUE_W + i]


def press(m: Floats, d: Ints, w: Floats) -> None:
    """Add what cables, and couplings where there are no cables, put on every pulley."""
    for k in range(M):
        for e in range(WIDTH):
            n = WIDTH * k + e
            i = LOOP_PULLEY[n]
            if d[GEARED + i] == 0:
                w[LOAD + i] += abs(m[RADIUS + n]) * w[TOTAL + k]
            else:
                torque = m[ARM + n] * w[TURN + i] * w[TENSION + k]
                way = 1.0 if torque > 0.0 else -1.0
                w[LOAD + i] += way * torque
                w[LOAD_T + i] += way * m[ARM + n] * w[CURL + i] * w[TENSION + k]


def rub(m: Floats, d: Ints, w: Floats, g: Ints, at: int) -> None:
    """Set the largest dry friction of every pulley, and which part of it acts which way."""
    for i in range(N):
        w[BUDGET + i] = 0.0
        w[BUDGET_W + i] = 0.0
        w[BUDGET_L + i] = 0.0
        w[SIDE + i] = 0.0
    if d[BUDGETS + 1] == 0:
        return
    press(m, d, w)
    for i in range(N):
        omega = w[at + N + i]
        z = d[BRISTLE + i]
        if z >= 0:
            w[SIDE + i] = -w[at + 2 * N + z]
        elif d[DRIVE + i] == 1:
            w[SIDE + i] = -clipped(omega / m[STILL], -1.0, 1.0)
        elif g[MODE + i] != 2:
            w[SIDE + i] = -g[MODE + i]
    for a in range(d[BUDGETS + 1]):
        n = d[BUDGETS] + 4 * a
        i = d[n + 1]
        omega = w[at + N + i]
        # while sliding, speed is counted along the direction of sliding: smooth over a step
        way = 1.0 if omega > 0.0 else -1.0
        if d[DRY + i] == 1 and d[DRIVE + i] == 0:
            way = -w[SIDE + i]
        if way == 0.0:  # stuck: the budget of the direction in which it is pushed
            way = 1.0 if w[TORQUE + i] > 0.0 else -1.0
            omega = 0.0
        side = way
        if d[BRISTLE + i] >= 0:  # bristles that are bent forward rub as in forward motion
            side = 1.0 if w[SIDE + i] < 0.0 else -1.0
        limit, by_w, by_l = budget_law(d[n], way * omega, side, w[LOAD + i], m, d[n + 2])
        w[BUDGET + i] += limit
        w[BUDGET_W + i] += by_w * way
        w[BUDGET_L + i] += by_l
    if d[BRISTLED] == 0:
        return
    for i in range(N):
        z = d[BRISTLE + i]
        if z >= 0:
            # Dahl's law in units of the breakaway angle: the state is the part of the budget used;
            # a trembling goes there and back, and only takes away from it
            omega = w[at + N + i]
            value = w[at + 2 * N + z]
            per = 1.0 / m[BREAKAWAY + i]
            way = 1.0 if omega > 0.0 else -1.0
            dither = m[DITHER + i]
            w[STATE_RATE + z] = per * (omega * (1.0 - way * value) - dither * value)
            w[STATE_A + z] = 0.0
            w[STATE_B + z] = per * (1.0 - way * value)
            w[STATE_Z + z] = -per * (way * omega + dither)
            w[STATE_T + z] = -w[BUDGET + i]


def given_by(m: Floats, j: int, torque: float) -> tuple[float, float]:
    """Return the torque that motor j gives, and how much of its gain its limit lets through."""
    asked = m[MOTOR_GAIN + j] * torque
    given, part = limited(asked, m[MOTOR_LIMIT + j], m[MOTOR_KNEE + j])
    return given + m[MOTOR_BIAS + j], part


def drive(m: Floats, d: Ints, w: Floats, s: Floats, c: Floats, t: float, at: int) -> None:
    """Set the motors' torques where the controller acts continuously, and the torque signals."""
    for j in range(U):
        row = d[REFERENCE + j]
        if row < 0:
            continue
        i = MOTOR_PULLEY[j]
        value, slope, _ = smooth(s, row, t)
        z = d[INTEGRAL + j]
        error = value - w[at + i]
        wish = (
            m[KP + j] * error
            + m[KI + j] * w[at + 2 * N + z]
            + m[KD + j] * (m[AHEAD + j] * slope - w[at + N + i])
        )
        torque = clipped(wish, -m[LIMIT + j], m[LIMIT + j])
        c[COMMAND + j] = torque
        w[INPUT + i], part = given_by(m, j, torque)
        free = wish == torque and part > 0.0
        gain = m[MOTOR_GAIN + j] * part if free else 0.0
        w[TORQUE_T + i] -= gain * m[KP + j]
        w[TORQUE_W + i] -= gain * m[KD + j]
        w[STATE_RATE + z] = error if free else 0.0
        w[STATE_A + z] = -1.0 if free else 0.0
        w[STATE_B + z] = 0.0
        w[STATE_Z + z] = 0.0
        w[STATE_T + z] = gain * m[KI + j]


def evaluate(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, at: int
) -> None:
    """
    Set everything that holds at time t in the state ``w[at:]``, and the right-hand side ``w[F:]``.

    Prescribed pulleys must have been placed by :func:`prescribe`.
    """
    wind(m, d, w, c, at)
    pull(m, d, w, at)
    touch(m, d, w, g, at)
    for i in range(N):
        w[TORQUE + i] = 0.0
        w[TORQUE_T + i] = 0.0
        w[TORQUE_W + i] = 0.0
    for k in range(K):
        for e in range(WIDTH):
            i = CONTACT_PULLEY[WIDTH * k + e]
            w[TORQUE + i] -= m[CONTACT_RATIO + WIDTH * k + e] * m[CONTACT_ARM + k] * w[FORCE + k]
    for a in range(d[TORQUES + 1]):
        n = d[TORQUES] + 4 * a
        i = d[n + 1]
        torque, by_t, by_w = torque_law(d[n], w[at + i], w[at + N + i], w[EPOCH], m, d[n + 2])
        w[TORQUE + i] += torque
        w[TORQUE_T + i] += by_t
        w[TORQUE_W + i] += by_w
    burden(d, w)
    drive(m, d, w, s, c, t, at)
    for i in range(N):
        w[TORQUE + i] += w[INPUT + i] - m[DAMPING + i] * w[at + N + i]
        w[TORQUE_W + i] -= m[DAMPING + i]
    if d[PUSHED] > 0:
        for i in range(N):
            if d[PUSH + i] >= 0:
                push, _, _ = smooth(s, d[PUSH + i], t)
                w[TORQUE + i] += push
    for k in range(M):
        for e in range(WIDTH):
            i = LOOP_PULLEY[WIDTH * k + e]
            arm = m[ARM + WIDTH * k + e]
            w[TORQUE + i] -= arm * w[TURN + i] * w[TENSION + k]
            w[TORQUE_T + i] -= arm * w[CURL + i] * w[TENSION + k]
    rub(m, d, w, g, at)
    for i in range(N):
        w[F + i] = w[at + N + i]
        if g[MODE + i] == 0:
            w[F + N + i] = 0.0
        else:
            w[F + N + i] = (w[TORQUE + i] + w[SIDE + i] * w[BUDGET + i]) / m[INERTIA + i]
    if d[DRIVEN] > 0:  # what is prescribed is not integrated
        for i in range(N):
            if d[DRIVE + i] == 1:
                w[F + i] = 0.0
                w[F + N + i] = 0.0
                if d[BRISTLE + i] >= 0:  # they follow from the motion, see bend
                    w[STATE_RATE + d[BRISTLE + i]] = 0.0
    for z in range(d[ACTIVE]):
        w[F + 2 * N + z] = w[STATE_RATE + z]


def prescribe(m: Floats, d: Ints, w: Floats, s: Floats, t: float, at: int) -> None:
    """Place the pulleys whose motion is prescribed."""
    if d[DRIVEN] == 0:
        return
    for i in range(N):
        if d[DRIVE + i] == 1:
            value, slope, second = smooth(s, d[MOTION + i], t)
            w[at + i] = value
            w[at + N + i] = slope
            w[ACCELERATION + i] = second
