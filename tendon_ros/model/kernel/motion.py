"""
Motion through time: steps under error control, events located, controllers and sensors at ticks.

Dry friction is a budget. A pulley slides one way, slides the other way, or sticks, and within a
step it does only one of these, so that the equations are smooth there; where that changes, the
step ends. A stuck pulley does not move at all. Contacts and slackening cables end steps likewise.
"""

from __future__ import annotations

from tendon_ros.model.kernel.forces import clipped, evaluate, prescribe
from tendon_ros.model.kernel.rosenbrock import between, linearise, outer, step
from tendon_ros.model.kernel.structure import (
    ACCELERATION, ACTIVE, ARM, BREAKS, BUDGET, CLOCK, COMMAND, CONTACT_ARM, COUNT, DRAWN, DRIVE, DRY,
    ENCODER, EPOCH, F, FIRST, FORCE, GAP, INERTIA, INPUT, K, KD, KI, KP, LAST, LIMIT, LOOP_PULLEY,
    M, MODE, MOTOR_BIAS, MOTOR_GAIN, MOTOR_LIMIT, MOTOR_PULLEY, N, NEXT, PAST, PENDING, PERIOD, Q,
    REMEMBERS,
    READING, REFERENCE, RING, ROW, SENSOR_DELAY, SENSOR_GAIN, SENSOR_INDEX, SENSOR_NOISE,
    SENSOR_OFFSET, SENSOR_RECTIFIED, SENSOR_RESOLUTION, SENSOR_SOURCE, SIDE, SLACK, SLACK_START,
    START, STEP, SUM, SWITCH, TENSION, TICK, TORQUE, TOUCH, TRIAL, TURN, U, WIDTH, WIDTH_ROW,
    Floats, Ints,
)  # fmt: skip

SMALLEST = 1e-10  # [s]
MOST_STEPS = 200_000  # between two ticks
SLIDE, STICK, MEET, SLACKEN = 0, 1, 2, 3  # kinds of events
DONE, DIVERGED = 0, 1


def state_at(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, at: int
) -> None:
    """Evaluate at ``w[at:]``, and let go the stuck pulleys that are pushed harder than they hold."""
    prescribe(m, d, w, s, t, at)
    evaluate(m, d, w, g, s, c, t, at)
    freed = False
    for i in range(N):
        if d[DRY + i] == 1 and g[MODE + i] == 0 and abs(w[TORQUE + i]) > w[BUDGET + i]:
            g[MODE + i] = 1 if w[TORQUE + i] > 0.0 else -1
            freed = True
    if freed:
        evaluate(m, d, w, g, s, c, t, at)


def begin(m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, y: Floats) -> None:
    """Take up the carried state: modes that fit it, forces that hold now."""
    for n in range(2 * N + d[ACTIVE]):
        w[START + n] = y[n]
    for i in range(N):
        if d[DRY + i] == 0 or d[DRIVE + i] == 1:
            g[MODE + i] = 2
        elif g[MODE + i] == 2:
            omega = w[START + N + i]
            g[MODE + i] = 1 if omega > 0.0 else (-1 if omega < 0.0 else 0)
    state_at(m, d, w, g, s, c, c[CLOCK], START)
    changed = False
    for k in range(K):
        closed = 1 if w[GAP + k] > 0.0 else 0
        if closed != g[TOUCH + k] and abs(w[GAP + k]) > 1e-12:
            g[TOUCH + k] = closed
            changed = True
    if changed:
        state_at(m, d, w, g, s, c, c[CLOCK], START)


def due(w: Floats, g: Ints, kind: int, index: int, at: int) -> float:
    """Return an event's function: positive as long as it has not happened. Forces are at ``at``."""
    if kind == SLIDE:
        return g[MODE + index] * w[at + N + index]
    if kind == STICK:
        return w[BUDGET + index] - abs(w[TORQUE + index])
    if kind == MEET:
        return w[GAP + index] if g[TOUCH + index] == 1 else -w[GAP + index]
    return w[SLACK + index] if w[SLACK_START + index] > 0.0 else -w[SLACK + index]


def locate(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float,
    kind: int, index: int, last: float,
) -> float:  # fmt: skip
    """Return the part of the step just taken at which an event happens (Illinois, dense output)."""
    low = 0.01
    between(d, w, low, TRIAL)
    prescribe(m, d, w, s, t + low * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + low * h, TRIAL)
    value = due(w, g, kind, index, TRIAL)
    if value <= 0.0:
        return low
    high = 1.0
    part = high
    for _ in range(12):
        part = (value * high - last * low) / (value - last)
        between(d, w, part, TRIAL)
        if kind != SLIDE:
            prescribe(m, d, w, s, t + part * h, TRIAL)
            evaluate(m, d, w, g, s, c, t + part * h, TRIAL)
        now = due(w, g, kind, index, TRIAL)
        if now > 0.0:
            low = part
            value = now
            last *= 0.5
        else:
            high = part
            last = now
            value *= 0.5
        if high - low < 1e-9 or abs(now) < 1e-13:
            break
    return part


def crossing(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float
) -> tuple[float, int, int]:
    """Return the first event of the step just taken: its part of the step (above 1: none), kind, index."""
    first = 2.0
    kind = -1
    index = -1
    # the forces at the end of the step are overwritten by the search: read them all first
    for i in range(N):
        w[PENDING + i] = 1.0
        if d[DRY + i] == 1 and g[MODE + i] != 2:
            w[PENDING + i] = due(w, g, STICK if g[MODE + i] == 0 else SLIDE, i, NEXT)
    for k in range(K):
        w[PENDING + N + k] = due(w, g, MEET, k, NEXT)
    for k in range(M):
        value = due(w, g, SLACKEN, k, NEXT)
        known = abs(w[SLACK_START + k]) > 1e-9 and value < -1e-9
        w[PENDING + N + K + k] = value if known else 1.0
    for n in range(N + K + M):
        last = w[PENDING + n]
        if last < 0.0:
            what = SLACKEN
            which = n - N - K
            if n < N:
                what = STICK if g[MODE + n] == 0 else SLIDE
                which = n
            elif n < N + K:
                what = MEET
                which = n - N
            part = locate(m, d, w, g, s, c, t, h, what, which, last)
            if part < first:
                first = part
                kind = what
                index = which
    return first, kind, index


def change(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, kind: int, index: int
) -> None:
    """Let an event happen in the state ``w[NEXT:]``."""
    if kind == SLIDE:
        w[NEXT + N + index] = 0.0
        g[MODE + index] = 0
    elif kind == STICK:
        g[MODE + index] = 1 if w[TORQUE + index] > 0.0 else -1
    elif kind == MEET:
        g[TOUCH + index] = 1 - g[TOUCH + index]
    state_at(m, d, w, g, s, c, t, NEXT)


def effort(m: Floats, d: Ints, w: Floats, c: Floats, j: int) -> float:
    """Return the torque that motor j reports: its command, or what a prescribed motion asks of it."""
    i = MOTOR_PULLEY[j]
    if d[DRIVE + i] == 0:
        return c[COMMAND + j]
    need = m[INERTIA + i] * w[ACCELERATION + i] - w[TORQUE + i] - w[SIDE + i] * w[BUDGET + i]
    return (need - m[MOTOR_BIAS + j]) / m[MOTOR_GAIN + j]


def sense(m: Floats, d: Ints, w: Floats, c: Floats, noise: Floats, at: int) -> None:
    """Let every sensor read the state ``w[at:]``, whose forces have been evaluated."""
    tick = int(c[TICK])
    slot = tick % RING
    for q in range(Q):
        source = SENSOR_SOURCE[q]
        index = SENSOR_INDEX[q]
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
            truth = m[ARM + index] * w[TURN + i] * w[TENSION + index // WIDTH]
        c[PAST + RING * q + slot] = truth
        late = m[SENSOR_DELAY + q] / m[PERIOD]
        back = int(late)
        back = min(back, tick)
        value = c[PAST + RING * q + (tick - back) % RING]
        if late > back and tick > back:
            older = c[PAST + RING * q + (tick - back - 1) % RING]
            value += (late - back) * (older - value)
        value = m[SENSOR_GAIN + q] * value + m[SENSOR_OFFSET + q]
        if d[SENSOR_RECTIFIED + q] == 1:
            value = abs(value)
        if len(noise) > 0:
            value += m[SENSOR_NOISE + q] * noise[Q * int(c[TICK] - c[DRAWN]) + q]
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
    """Write one row: time, angles, velocities, efforts, loop forces, contact forces, readings."""
    tick = int(c[TICK])
    if tick % every != 0:
        return
    o = WIDTH_ROW * int(c[ROW])
    if o + WIDTH_ROW > len(rows):
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
    for q in range(Q):
        rows[o + q] = c[READING + q]


def ticks_ahead(d: Ints, c: Floats, every: int) -> int:
    """Return how many ticks to pass: to the next recorded one, unless a delayed sensor remembers."""
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
        evaluate(m, d, w, g, s, c, due_at, TRIAL)
        c[TICK] += ahead
        sense(m, d, w, c, noise, TRIAL)
        record(m, d, w, c, due_at, rows, every, TRIAL)
        ahead = ticks_ahead(d, c, every)
        due_at = (c[TICK] + ahead) * m[PERIOD]


def advance(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, end: float,
    noise: Floats, rows: Floats, every: int, smoothly: int,
) -> int:  # fmt: skip
    """
    Integrate from ``c[CLOCK]`` to ``end``, state and forces in ``w[START:]`` at both.

    With ``smoothly`` the ticks of the sensors are passed without stopping, and recorded from the
    dense output.
    """
    t = c[CLOCK]
    steps = 0
    while t < end - SMALLEST:
        stop = end
        for b in range(d[BREAKS]):
            switch = m[d[SWITCH] + b]
            if t + SMALLEST < switch < stop:
                stop = switch
        w[EPOCH] = 0.5 * (t + stop)
        if d[BREAKS] > 0:
            state_at(m, d, w, g, s, c, t, START)
        while t < stop - SMALLEST:
            steps += 1
            linearise(m, d, w)
            outer(m, d, w, g, s, t)
            for n in range(2 * N + d[ACTIVE]):
                w[FIRST + n] = w[F + n]
            for k in range(M):
                w[SLACK_START + k] = w[SLACK + k]
            whole = stop - t
            h = min(c[STEP], whole)
            if h > 0.7 * whole and h < whole:
                h = 0.6 * whole  # two steps of similar size rather than a long and a tiny one
            error = step(m, d, w, g, s, c, t, h)
            while not error <= 1.0:
                g[COUNT + 1] += 1
                h *= clipped(0.9 * error**-0.25, 0.1, 0.7) if error < 1e300 else 0.1
                if h < SMALLEST or steps > MOST_STEPS:
                    return DIVERGED
                error = step(m, d, w, g, s, c, t, h)
            grown = h * clipped(0.9 * (error + 1e-10) ** -0.25, 0.2, 5.0)
            c[STEP] = max(grown, c[STEP]) if h == whole else grown
            g[COUNT] += 1
            evaluate(m, d, w, g, s, c, t + h, NEXT)
            part, kind, index = crossing(m, d, w, g, s, c, t, h)
            if part < 2.0:
                g[COUNT + 2] += 1
                h *= part
                step(m, d, w, g, s, c, t, h)
                evaluate(m, d, w, g, s, c, t + h, NEXT)
                if kind == SLIDE:  # refine: the dense output is of lower order than the step
                    pace = w[F + N + index]
                    miss = w[NEXT + N + index]
                    if abs(miss) > 1e-12 and abs(miss) < 0.5 * h * abs(pace):
                        h -= miss / pace
                        step(m, d, w, g, s, c, t, h)
                        evaluate(m, d, w, g, s, c, t + h, NEXT)
            if smoothly == 1:
                report(m, d, w, g, s, c, t, h, noise, rows, every)
            t = t + h if h < whole or part < 2.0 else stop
            if part < 2.0:
                change(m, d, w, g, s, c, t, kind, index)
            elif smoothly == 1:
                evaluate(m, d, w, g, s, c, t, NEXT)
            for n in range(2 * N + d[ACTIVE]):
                w[START + n] = w[NEXT + n]
            if steps > MOST_STEPS or not abs(w[START]) < 1e6:
                return DIVERGED
    c[CLOCK] = end
    return DONE


def control(m: Floats, d: Ints, w: Floats, c: Floats, setpoint: Floats, o: int) -> None:
    """Let every sampled controller (PID, limited) hold a new torque until the next tick."""
    for j in range(U):
        if d[REFERENCE + j] >= 0 or d[DRIVE + MOTOR_PULLEY[j]] == 1:
            continue
        error = setpoint[o + j] - c[READING + d[ENCODER + j]]
        if c[LAST + j] > 1e300:  # the first tick has no past
            c[LAST + j] = error
        total = c[SUM + j] + m[PERIOD] * error
        change_rate = (error - c[LAST + j]) / m[PERIOD]
        c[LAST + j] = error
        wish = m[KP + j] * error + m[KI + j] * total + m[KD + j] * change_rate
        torque = clipped(wish, -m[LIMIT + j], m[LIMIT + j])
        if torque == wish:  # the integral rests while the limit holds
            c[SUM + j] = total
        c[COMMAND + j] = torque
        applied = m[MOTOR_GAIN + j] * torque + m[MOTOR_BIAS + j]
        w[INPUT + MOTOR_PULLEY[j]] = clipped(applied, -m[MOTOR_LIMIT + j], m[MOTOR_LIMIT + j])


def rollout(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, y: Floats,
    setpoint: Floats, ticks: int, noise: Floats, rows: Floats, every: int, smoothly: int,
) -> int:  # fmt: skip
    """
    Run a number of ticks from the carried state; return DONE or DIVERGED.

    At a tick the sensors read, the controllers act on the readings, and the row is written; then
    the mechanics goes on to the next tick. ``smoothly`` is for what has no sampled controller
    (prescribed motion, continuous control): nothing stops at ticks.
    """
    c[DRAWN] = c[TICK]
    c[ROW] = 0.0
    begin(m, d, w, g, s, c, y)
    status = DONE
    if smoothly == 1:
        sense(m, d, w, c, noise, START)
        record(m, d, w, c, c[CLOCK], rows, every, START)
        last = c[TICK] + ticks
        status = advance(m, d, w, g, s, c, last * m[PERIOD], noise, rows, every, 1)
        c[TICK] = last
    else:
        for n in range(ticks):
            sense(m, d, w, c, noise, START)
            control(m, d, w, c, setpoint, U * n)
            state_at(m, d, w, g, s, c, c[CLOCK], START)
            for q in range(Q):
                if SENSOR_SOURCE[q] == 2:  # a torque is reported when it is commanded
                    sense(m, d, w, c, noise, START)
                    break
            record(m, d, w, c, c[CLOCK], rows, every, START)
            status = advance(
                m, d, w, g, s, c, (c[TICK] + 1.0) * m[PERIOD], noise, rows, every, 0
            )
            c[TICK] += 1.0
            if status != DONE:
                break
    for n in range(2 * N + d[ACTIVE]):
        y[n] = w[START + n]
    return status


def glide(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, y: Floats, end: float,
    row: Floats,
) -> int:  # fmt: skip
    """Go on to time ``end``, torques held, and write one row there: for observers."""
    begin(m, d, w, g, s, c, y)
    status = advance(m, d, w, g, s, c, end, row, row, 1, 0)
    c[ROW] = 0.0
    record(m, d, w, c, end, row, 1, START)
    linearise(m, d, w)
    for n in range(2 * N + d[ACTIVE]):
        y[n] = w[START + n]
    return status


def weigh(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, y: Floats
) -> None:
    """Evaluate and linearise at the state y without moving on, prescribed pulleys where y puts them."""
    for n in range(2 * N + d[ACTIVE]):
        w[START + n] = y[n]
    evaluate(m, d, w, g, s, c, c[CLOCK], START)
    linearise(m, d, w)
