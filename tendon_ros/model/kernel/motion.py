"""Motion through time: steps under error control, stopping at ticks, switches and events."""

from __future__ import annotations

import math

from tendon_ros.model.kernel.bristles import bend
from tendon_ros.model.kernel.events import begin, change, crossing, SLIDE, state_at
from tendon_ros.model.kernel.forces import evaluate
from tendon_ros.model.kernel.linear import hold, linearise, outer
from tendon_ros.model.kernel.loops import clipped
from tendon_ros.model.kernel.rosenbrock import step
from tendon_ros.model.kernel.sensing import control, record, report, sense, SMALLEST
from tendon_ros.model.kernel.structure import (
    ACTIVE, BREAKS, CLOCK, COUNT, DRAWN, DRUM, DRY, EPOCH, F, FIRST, Floats, Ints, LASH, M, MODE,
    N, NEXT, PERIOD, ROOM, ROW, SLACK, SLACK_START, START, STEP, SWITCH, TICK, U,
)  # fmt: skip

LONGEST, LONGEST_STUCK = 0.05, 0.005  # steps along signals [s]
SHORTEST = 1e-8  # [s] of steps that are taken again since they end in a stop that is none
MOST_STEPS = 200_000  # between two ticks
DONE, DIVERGED = 0, 1


def longest(d: Ints, g: Ints, s: Floats) -> float:
    """
    Return the longest step that may be taken [s].

    The error of a step sees what moves. Where signals push, what stands still may soon move:
    a step that strides over a rise and fall of the signal would never know.
    """
    if s[2] <= 1.0:
        return 1e300
    for i in range(N):
        if d[DRY + i] == 1 and g[MODE + i] == 0:
            return LONGEST_STUCK
    return LONGEST


def finish(
    m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, t: float, h: float
) -> None:
    """Complete what a step has reached: bristles that follow from a motion, and all forces."""
    bend(m, d, w, s, t, t + h, NEXT)
    evaluate(m, d, w, g, s, c, t + h, NEXT)


def gathers(w: Floats, g: Ints, index: int) -> bool:
    """
    Return whether a pulley gathers speed at the end of a step, and so does not stop there.

    Over something stiff the dense output of a step bends the wrong way where the step begins.
    Believed, a pulley that was let go would stop at once, be let go again, and creep on like that.
    """
    return g[MODE + index] * w[F + N + index] > 0.0


def take_up(m: Floats, w: Floats, c: Floats) -> None:
    """Let what lies behind a play follow where the pulley has reached an end of it."""
    for i in range(N):
        half = m[LASH + i]
        c[DRUM + i] = clipped(c[DRUM + i], w[START + i] - half, w[START + i] + half)


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
            hold(d, w, g)
            outer(m, d, w, g, s, t)
            for n in range(2 * N):
                w[FIRST + n] = w[F + n]
            for n in range(2 * N, 2 * N + d[ACTIVE]):
                w[FIRST + n] = w[F + n]
            for k in range(M):
                w[SLACK_START + k] = w[SLACK + k]
            whole = stop - t
            h = min(c[STEP], whole, longest(d, g, s))
            if h > 0.7 * whole and h < whole:
                h = 0.6 * whole  # two steps of similar size rather than a long and a tiny one
            error = step(m, d, w, g, s, c, t, h)
            while not error <= 1.0:
                g[COUNT + 1] += 1
                h *= clipped(0.9 / math.sqrt(math.sqrt(error)), 0.1, 0.7) if error < 1e300 else 0.1
                if h < SMALLEST or steps > MOST_STEPS:
                    return DIVERGED
                error = step(m, d, w, g, s, c, t, h)
            grown = h * clipped(0.9 / math.sqrt(math.sqrt(error + 1e-10)), 0.2, 5.0)
            c[STEP] = max(grown, c[STEP]) if h == whole else grown
            g[COUNT] += 1
            finish(m, d, w, g, s, c, t, h)
            part, kind, index = crossing(m, d, w, g, s, c, t, h)
            while part < 2.0:
                long = h
                h *= part
                step(m, d, w, g, s, c, t, h)
                finish(m, d, w, g, s, c, t, h)
                if kind == SLIDE:  # refine: the dense output is of lower order than the step
                    pace = w[F + N + index]
                    miss = w[NEXT + N + index]
                    if abs(miss) > 1e-12 and abs(miss) < 0.5 * h * abs(pace):
                        h -= miss / pace
                        step(m, d, w, g, s, c, t, h)
                        finish(m, d, w, g, s, c, t, h)
                if kind != SLIDE or long < SHORTEST or not gathers(w, g, index):
                    break
                h = 0.1 * long
                g[COUNT + 1] += 1
                step(m, d, w, g, s, c, t, h)
                finish(m, d, w, g, s, c, t, h)
                part, kind, index = crossing(m, d, w, g, s, c, t, h)
            if smoothly == 1:
                report(m, d, w, g, s, c, t, h, noise, rows, every)
            t = t + h if h < whole or part < 2.0 else stop
            if part < 2.0:
                change(m, d, w, g, s, c, t, kind, index)
            elif smoothly == 1:
                evaluate(m, d, w, g, s, c, t, NEXT)
            for n in range(2 * N):
                w[START + n] = w[NEXT + n]
            for n in range(2 * N, 2 * N + d[ACTIVE]):
                w[START + n] = w[NEXT + n]
            take_up(m, w, c)
            if steps > MOST_STEPS or not abs(w[START]) < 1e6:
                return DIVERGED
    c[CLOCK] = end
    return DONE


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
        sense(m, d, w, c, noise, START, 0)
        sense(m, d, w, c, noise, START, 1)
        record(m, d, w, c, c[CLOCK], rows, every, START)
        last = c[TICK] + ticks
        status = advance(m, d, w, g, s, c, last * m[PERIOD], noise, rows, every, 1)
        c[TICK] = last
    else:
        for n in range(ticks):
            sense(m, d, w, c, noise, START, 0)
            control(m, d, w, g, s, c, setpoint, U * n)
            sense(m, d, w, c, noise, START, 1)
            record(m, d, w, c, c[CLOCK], rows, every, START)
            status = advance(m, d, w, g, s, c, (c[TICK] + 1.0) * m[PERIOD], noise, rows, every, 0)
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
    c[ROOM] = 1.0
    record(m, d, w, c, end, row, 1, START)
    linearise(m, d, w)
    for n in range(2 * N + d[ACTIVE]):
        y[n] = w[START + n]
    return status


def weigh(m: Floats, d: Ints, w: Floats, g: Ints, s: Floats, c: Floats, y: Floats) -> None:
    """Evaluate and linearise at the state y, without moving on."""
    for n in range(2 * N + d[ACTIVE]):
        w[START + n] = y[n]
    evaluate(m, d, w, g, s, c, c[CLOCK], START)
    linearise(m, d, w)
