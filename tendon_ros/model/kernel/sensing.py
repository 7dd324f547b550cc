"""Ticks: what the sensors read, what the sampled controllers do about it, what is recorded."""

from __future__ import annotations

from tendon_ros.model.kernel.bristles import bend
from tendon_ros.model.kernel.events import state_at
from tendon_ros.model.kernel.forces import evaluate, given_by, prescribe
from tendon_ros.model.kernel.loops import clipped
from tendon_ros.model.kernel.rosenbrock import between
from tendon_ros.model.kernel.structure import (
    ACCELERATION, AHEAD, ARM, BEFORE, BUDGET, CLOCK, COMMAND, CONTACT_ARM, DRAWN, DRIVE, ENCODER,
    F, FORCE, Floats, INERTIA, INPUT, Ints, K, KD, KI, KP, LAST, LIMIT, LOOP_PULLEY, M, MODE,
    MOTOR_BIAS, MOTOR_GAIN, MOTOR_PULLEY, N, NOISY, PAST, PERIOD, READING,
    READINGS, REFERENCE, REMEMBERS, RING, ROOM, ROW, SENSOR_DELAY, SENSOR_GAIN, SENSOR_INDEX,
    SENSOR_KEPT, SENSOR_LAG, SENSOR_NOISE, SENSOR_OFFSET, SENSOR_RECTIFIED, SENSOR_RESOLUTION,
    SENSOR_SOURCE, SENSORS, SIDE, SMOOTH, START, SUM, TENSION, TICK, TORQUE, TRIAL, TURN, U, WIDTH,
)  # fmt: skip

SMALLEST = 1e-10  # times nearer than this are one [s]


def effort(m: Floats, d: Ints, w: Floats, c: Floats, j: int) -> float:
    """Return the torque that motor j reports: its command, or what its motion asks for."""
    i = MOTOR_PULLEY[j]
    if d[DRIVE + i] == 0:
        return c[COMMAND + j]
    need = m[INERTIA + i] * w[ACCELERATION + i] - w[TORQUE + i] - w[SIDE + i] * w[BUDGET + i]
    return (need - m[MOTOR_BIAS + j]) / m[MOTOR_GAIN + j]


def delayed(m: Floats, c: Floats, q: int, tick: int, truth: float) -> float:
    """Remember what sensor q sees at a tick, and return what it saw a delay ago."""
    c[PAST + RING * q + tick % RING] = truth
    late = m[SENSOR_DELAY + q] / m[PERIOD]
    back = min(int(late), tick)
    value = c[PAST + RING * q + (tick - back) % RING]
    if late > back and tick > back:
        older = c[PAST + RING * q + (tick - back - 1) % RING]
        value += (late - back) * (older - value)
    return value


def smoothed(m: Floats, c: Floats, q: int, value: float) -> float:
    """Return what the low-pass filter of sensor q makes of a value that went straight there."""
    if c[SMOOTH + q] > 1e300:  # the first tick has no past
        c[SMOOTH + q] = value
        c[BEFORE + q] = value
    behind = m[SENSOR_LAG + q] * (value - c[BEFORE + q])
    held = c[SMOOTH + q] - c[BEFORE + q] + behind
    c[SMOOTH + q] = value - behind + held * m[SENSOR_KEPT + q]
    c[BEFORE + q] = value
    return c[SMOOTH + q]


def sense(m: Floats, d: Ints, w: Floats, c: Floats, noise: Floats, at: int, torques: int) -> None:
    """
    Let sensors read the state ``w[at:]``, whose forces have been evaluated.

    Those of the motors' torques (``torques`` 1) read after the controllers have acted, all others
    (``torques`` 0) before.
    """
    tick = int(c[TICK])
    sensors = d[SENSORS]
    for q in range(sensors):
        source = d[SENSOR_SOURCE + q]
        if (source == 2) != (torques == 1):
            continue
        index = d[SENSOR_INDEX + q]
        truth = 0.0
        if source == 0:
            truth = w[at + index]
        elif source == 1:
            truth = w[at + N + index]
        elif source == 2:
            truth = effort(m, d, w, c, index)
        elif source == 3:
            truth = w[FORCE + index]
        elif source == 4:
            truth = w[FORCE + index] * m[CONTACT_ARM + index]
        else:
            i = LOOP_PULLEY[index]
            truth = -m[ARM + index] * w[TURN + i] * w[TENSION + index // WIDTH]
        value = truth
        if d[REMEMBERS] == 1:
            value = delayed(m, c, q, tick, truth)
        value = m[SENSOR_GAIN + q] * value + m[SENSOR_OFFSET + q]
        if d[SENSOR_RECTIFIED + q] == 1:
            value = abs(value)
        if m[SENSOR_LAG + q] > 0.0:
            value = smoothed(m, c, q, value)
        if c[NOISY] > 0.0:
            value += m[SENSOR_NOISE + q] * noise[sensors * int(c[TICK] - c[DRAWN]) + q]
        if m[SENSOR_RESOLUTION + q] > 0.0:
            counts = value / m[SENSOR_RESOLUTION + q] + 0.5
            whole = int(counts)
            if whole > counts:
                whole -= 1
            value = whole * m[SENSOR_RESOLUTION + q]
        c[READING + q] = value


def record(
    m: Floats, d: Ints, w: Floats, c: Floats, t: float, rows: Floats, every: int, at: int
) -> None:
    """
    Write one row of what happens at a tick.

    Time, angles, velocities, efforts, forces of loops and contacts, dry friction at the motors and
    the most that it could be, readings.
    """
    tick = int(c[TICK])
    if tick % every != 0:
        return
    o = (READINGS + d[SENSORS]) * int(c[ROW])
    if c[ROW] >= c[ROOM]:
        return
    c[ROW] += 1.0
    rows[o] = t
    o += 1
    for n in range(2 * N):
        rows[o + n] = w[at + n]
    o += 2 * N
    for j in range(U):
        rows[o + j] = effort(m, d, w, c, j)
    o += U
    for k in range(M):
        rows[o + k] = w[TENSION + k]
    o += M
    for k in range(K):
        rows[o + k] = w[FORCE + k]
    o += K
    for j in range(U):
        i = MOTOR_PULLEY[j]
        rows[o + j] = w[SIDE + i] * w[BUDGET + i]
        rows[o + U + j] = w[BUDGET + i]
    o += 2 * U
    for q in range(d[SENSORS]):
        rows[o + q] = c[READING + q]


def ticks_ahead(d: Ints, c: Floats, every: int) -> int:
    """Return how many ticks to pass: to the next recorded one, if no sensor remembers."""
    return 1 if d[REMEMBERS] == 1 else every - int(c[TICK]) % every


def report(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float,
    noise: Floats, rows: Floats, every: int,
) -> None:  # fmt: skip
    """Record the ticks that the step just taken has passed, from its dense output."""
    ahead = ticks_ahead(d, c, every)
    due_at = (c[TICK] + ahead) * m[PERIOD]
    while due_at <= t + h + SMALLEST:
        part = min((due_at - t) / h, 1.0)
        between(d, w, part, TRIAL)
        prescribe(m, d, w, s, due_at, TRIAL)
        bend(m, d, w, s, t, due_at, TRIAL)
        evaluate(m, d, w, g, s, c, due_at, TRIAL)
        c[TICK] += ahead
        sense(m, d, w, c, noise, TRIAL, 0)
        sense(m, d, w, c, noise, TRIAL, 1)
        record(m, d, w, c, due_at, rows, every, TRIAL)
        ahead = ticks_ahead(d, c, every)
        due_at = (c[TICK] + ahead) * m[PERIOD]


def control(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, setpoint: Floats, o: int
) -> None:
    """
    Let every sampled controller (PID, limited) hold a new torque until the next tick.

    Forces at ``w[START:]`` have been evaluated, and hold with the new torques afterwards.
    """
    afresh = 0
    for j in range(U):
        i = MOTOR_PULLEY[j]
        if d[REFERENCE + j] >= 0 or d[DRIVE + i] == 1:
            continue
        reading = c[READING + d[ENCODER + j]]
        error = setpoint[o + j] - reading
        ahead = m[AHEAD + j] * setpoint[o + j] - reading
        if c[LAST + j] > 1e300:  # the first tick has no past
            c[LAST + j] = ahead
        total = c[SUM + j] + m[PERIOD] * error
        change_rate = (ahead - c[LAST + j]) / m[PERIOD]
        c[LAST + j] = ahead
        wish = m[KP + j] * error + m[KI + j] * total + m[KD + j] * change_rate
        torque = clipped(wish, -m[LIMIT + j], m[LIMIT + j])
        if torque == wish:  # the integral rests while the limit holds
            c[SUM + j] = total
        c[COMMAND + j] = torque
        applied, _ = given_by(m, j, torque)
        w[TORQUE + i] += applied - w[INPUT + i]
        w[INPUT + i] = applied
        if g[MODE + i] == 0:
            afresh = 1
        else:
            w[F + N + i] = (w[TORQUE + i] + w[SIDE + i] * w[BUDGET + i]) / m[INERTIA + i]
    if afresh == 1:  # a stuck pulley may let go
        state_at(m, d, w, g, s, c, c[CLOCK], START)
