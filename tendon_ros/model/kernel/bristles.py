"""
Bristles of pulleys whose motion is prescribed: they follow from it, and are not integrated.

Dahl's law, see :mod:`tendon_ros.effects.presliding_friction`. Along a way in one direction, what
bristles lack of being bent as far as they go fades with the angle, whatever the speed; nothing
else of the rig changes that, and they change nothing of it but what the pulley's motor reports.
"""

from __future__ import annotations

import math

from tendon_ros.model.kernel.loops import clipped
from tendon_ros.model.kernel.structure import (
    BREAKAWAY, BRISTLE, BRISTLED, DITHER, DRIVE, DRIVEN, Floats, Ints, MOTION, N, START,
)  # fmt: skip


def piece(value: float, way: float, shaken: float, span: float) -> float:
    """
    Return how far bristles are bent after a way in one direction, at an even speed.

    :param value: the part of the friction that acted before.
    :param way: by how much the pulley turned [rad].
    :param shaken: by how much a trembling turned it meanwhile, there and back [rad].
    :param span: the angle over which they bend [rad].
    :return: the part that acts then.
    """
    whole = abs(way) + shaken
    if whole <= 0.0:
        return value
    end = way / whole
    return end + (value - end) * math.exp(-whole / span)


def along(
    s: Floats, row: int, begin: float, end: float, value: float, span: float, dither: float
) -> float:
    """
    Return how far bristles are bent after a part of a motion.

    :param s: the signals; ``row``: which of them is the motion, see :func:`smooth`.
    :param begin: first and, ``end``, last time of the part [samples].
    :param value: the part of the friction that acted before.
    :param span: the angle over which they bend [rad].
    :param dither: the speed of a trembling that lets them go [rad/s].
    :return: the part that acts then.
    """
    samples = int(s[2])
    at = 4 + row * samples
    to = at + int(s[3]) * samples
    while begin < end:
        cell = min(int(begin), samples - 2)
        u = begin - cell
        last = min(end - cell, 1.0)
        p = s[to + cell] / s[1]
        q = s[to + cell + 1] / s[1]
        rise = s[at + cell + 1] - s[at + cell]
        b = 3.0 * rise - 2.0 * p - q
        e = p + q - 2.0 * rise
        # speed p + 2 b u + 3 e u^2: where it turns back, a new way begins
        under = b * b - 3.0 * e * p
        first = 2.0
        second = 2.0
        if under > 0.0:
            half = -b - math.sqrt(under) if b > 0.0 else -b + math.sqrt(under)
            if half != 0.0:
                first = p / half
            if e != 0.0:
                second = half / (3.0 * e)
        if second < first:
            first, second = second, first
        for turn in (first, second, last):
            if u < turn <= last:
                way = (turn - u) * p + (turn * turn - u * u) * b
                way += (turn * turn * turn - u * u * u) * e
                value = piece(value, way, dither * (turn - u) / s[1], span)
                u = turn
        begin = end if last < 1.0 else cell + 1.0
    return value


def bend(m: Floats, d: Ints, w: Floats, s: Floats, since: float, t: float, at: int) -> None:
    """Set the bristles of prescribed pulleys in ``w[at:]`` at t: the start's are of ``since``."""
    if d[DRIVEN] == 0 or d[BRISTLED] == 0:
        return
    most = s[2] - 1.0
    begin = clipped((since - s[0]) * s[1], 0.0, most)
    end = clipped((t - s[0]) * s[1], 0.0, most)
    for i in range(N):
        z = d[BRISTLE + i]
        if d[DRIVE + i] == 0 or z < 0:
            continue
        value = w[START + 2 * N + z]
        if begin < end:
            value = along(s, d[MOTION + i], begin, end, value, m[BREAKAWAY + i], m[DITHER + i])
        held = max(t - since - (end - begin) / s[1], 0.0)  # before the motion and after
        w[at + 2 * N + z] = piece(value, 0.0, m[DITHER + i] * held, m[BREAKAWAY + i])
