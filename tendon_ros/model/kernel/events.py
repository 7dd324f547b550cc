"""
Events: where a pulley sticks or lets go, a contact closes or opens, a cable goes slack.

Dry friction is a budget. A pulley slides one way, slides the other way, or sticks, and within a
step it does only one of these, so that the equations are smooth there; where that changes, the
step ends. A stuck pulley does not move at all. Contacts and slackening cables end steps likewise.
"""

from __future__ import annotations

from tendon_ros.model.kernel.forces import evaluate, prescribe
from tendon_ros.model.kernel.rosenbrock import between
from tendon_ros.model.kernel.structure import (
    ACTIVE, BUDGET, CLOCK, COUNT, DRIVE, DRY, Floats, GAP, Ints, K, M, MODE, N,
    NEXT, PENDING, SLACK, SLACK_START, START, TORQUE, TOUCH, TRIAL,
)  # fmt: skip

SLIDE, STICK, MEET, SLACKEN = 0, 1, 2, 3  # kinds of events
#: friction holds a little more than its budget: a pulley that has come to rest where the two are
#: equal must not be let go, and caught again, by rounding
GRIP = 1.0 + 1e-9


def state_at(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, at: int
) -> None:
    """Evaluate at ``w[at:]``, and let go the stuck pulleys that are pushed too hard."""
    prescribe(m, d, w, s, t, at)
    evaluate(m, d, w, g, s, c, t, at)
    freed = False
    for i in range(N):
        if d[DRY + i] == 1 and g[MODE + i] == 0 and abs(w[TORQUE + i]) > GRIP * w[BUDGET + i]:
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
    """Return an event's function: positive until it happens. Forces are those at ``at``."""
    if kind == SLIDE:
        return g[MODE + index] * w[at + N + index]
    if kind == STICK:
        return GRIP * w[BUDGET + index] - abs(w[TORQUE + index])
    if kind == MEET:
        return w[GAP + index] if g[TOUCH + index] == 1 else -w[GAP + index]
    return w[SLACK + index] if w[SLACK_START + index] > 0.0 else -w[SLACK + index]


def locate(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float,
    kind: int, index: int, last: float,
) -> float:  # fmt: skip
    """Return the part of the step just taken at which an event happens: Illinois."""
    low = 1e-6
    between(d, w, low, TRIAL)
    prescribe(m, d, w, s, t + low * h, TRIAL)
    evaluate(m, d, w, g, s, c, t + low * h, TRIAL)
    value = due(w, g, kind, index, TRIAL)
    if value <= 0.0:
        return low
    high = 1.0
    part = high
    side = 0
    for _ in range(20):
        part = (value * high - last * low) / (value - last)
        between(d, w, part, TRIAL)
        if kind != SLIDE:
            prescribe(m, d, w, s, t + part * h, TRIAL)
            evaluate(m, d, w, g, s, c, t + part * h, TRIAL)
        now = due(w, g, kind, index, TRIAL)
        if now > 0.0:
            low = part
            value = now
            if side == 1:
                last *= 0.5
            side = 1
        else:
            high = part
            last = now
            if side == -1:
                value *= 0.5
            side = -1
        if high - low < 1e-9 or (kind == SLIDE and abs(now) < 1e-13):
            break
    # a sliding pulley is stopped where it stands; all else ends on the side where it has happened
    return part if kind == SLIDE else high


def crossing(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float
) -> tuple[float, int, int]:
    """Return the first event of the step just taken: part (above 1: none), kind, index."""
    first = 2.0
    kind = -1
    index = -1
    # the forces at the end of the step are overwritten by the search: read them all first
    for i in range(N):
        w[PENDING + i] = 1.0
        if d[DRY + i] == 1 and g[MODE + i] != 2:
            w[PENDING + i] = due(w, g, STICK if g[MODE + i] == 0 else SLIDE, i, NEXT)
    for k in range(K):
        value = due(w, g, MEET, k, NEXT)
        w[PENDING + N + k] = value if value < -1e-12 else 1.0  # at rest on the wall: rounding
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
    """
    Let an event happen in the state ``w[NEXT:]``.

    A stuck pulley is let go by :func:`state_at`, and only where it is pushed harder than it holds:
    let go a rounding too early, it would stick again at once, and so on for ever.
    """
    if kind == SLIDE:
        w[NEXT + N + index] = 0.0
        g[MODE + index] = 0
    elif kind == MEET:
        g[TOUCH + index] = 1 - g[TOUCH + index]
    state_at(m, d, w, g, s, c, t, NEXT)
    if kind != STICK or g[MODE + index] != 0:  # not where the search fell a hair short
        g[COUNT + 2] += 1
