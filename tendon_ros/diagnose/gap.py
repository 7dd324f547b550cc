"""The gap of each channel in its own unit, before and after, on what no fit has seen."""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import unit_of
from tendon_ros.diagnose.enough import BLOCK
from tendon_ros.diagnose.intervals import mean_square_interval
from tendon_ros.diagnose.result import ChannelGap, Shrink
from tendon_ros.diagnose.signs import BOUNDLESS
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

FloatArray = NDArray[np.float64]

#: noise deviations by which a model is off that diverges: a number, so that all can read it
DIVERGED = math.sqrt(BOUNDLESS)


@dataclass(frozen=True)
class Off:
    """
    How far one channel is off: root mean squares in its unit and in noise deviations.

    ``blocks``: mean squares of blocks that are nearly independent, in its unit squared.
    """

    rms: float
    in_noise: float
    blocks: tuple[float, ...]


def gaps(held: Problem, start: Model, final: Model) -> tuple[ChannelGap, ...]:
    """
    Return the gap of each channel, the largest against its noise first.

    :param held: the bins that no fit has seen.
    :param start: what the instrument file says.
    :param final: what was found.
    :return: the gaps of both.
    """
    before, after = offs(held, start), offs(held, final)
    noise = noise_of(held)
    rows = [
        ChannelGap(
            channel=channel,
            unit=unit_of(channel),
            before=before[channel].rms,
            after=after[channel].rms,
            noise_floor=noise[channel],
            ci95=mean_square_interval(after[channel].blocks),
        )
        for channel in before
    ]
    return tuple(sorted(rows, key=lambda g: -g.before / max(g.noise_floor, 1e-30)))


def shrink_of(held: Problem, start: Model, without: Model, final: Model) -> Shrink:
    """
    Return what a cause is worth in the channel where it shows most.

    :param held: the bins that no fit has seen.
    :param start: no cause.
    :param without: all but this one, refitted.
    :param final: all of them.
    :return: root mean squares in the channel's unit.
    """
    before, left, after = (offs(held, model) for model in (start, without, final))
    if not before:
        return Shrink(channel='', unit='', before=0.0, without_this=0.0, after=0.0)
    channel = max(before, key=lambda c: left[c].in_noise ** 2 - after[c].in_noise ** 2)
    return Shrink(
        channel=channel,
        unit=unit_of(channel),
        before=before[channel].rms,
        without_this=left[channel].rms,
        after=after[channel].rms,
    )


def beyond_noise(off: float, noise: float) -> float:
    """
    Return what of a channel's misfit is not its noise.

    :param off: root mean square of what a model leaves, in any unit.
    :param noise: one deviation, in the same.
    :return: one deviation.
    """
    return math.sqrt(max(0.0, off**2 - noise**2))


def offs(problem: Problem, model: Model) -> dict[str, Off]:
    """
    Return how far a model is off, by :data:`DIVERGED` where it diverges.

    :param problem: the bins that count.
    :param model: the model.
    :return: by channel.
    """
    predicted = problem.rollouts.predicted(problem.uses(model))
    parts: dict[str, list[tuple[FloatArray, FloatArray, FloatArray]]] = {}
    for n, segment in enumerate(problem.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            mask = problem.masks[n][c]
            if not mask.any():
                continue
            off = (measured.value - predicted[n][c])[mask]
            off = np.where(np.isfinite(off), off, DIVERGED * measured.noise[mask])
            block = np.floor(segment.time[mask] / BLOCK) + 1e4 * n
            parts.setdefault(measured.sensor.channel, []).append(
                (off**2, (off / measured.noise[mask]) ** 2, block)
            )
    found = {}
    for channel, rows in parts.items():
        squares, noisy, block = (np.concatenate(row) for row in zip(*rows, strict=True))
        means = tuple(float(squares[block == b].mean()) for b in np.unique(block))
        found[channel] = Off(float(np.sqrt(squares.mean())), float(np.sqrt(noisy.mean())), means)
    return found


def noise_of(problem: Problem) -> dict[str, float]:
    """
    Return the noise of each channel, one deviation, in its unit.

    :param problem: the bins that count.
    :return: by channel.
    """
    parts: dict[str, list[FloatArray]] = {}
    for n, segment in enumerate(problem.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            parts.setdefault(measured.sensor.channel, []).append(
                measured.noise[problem.masks[n][c]] ** 2
            )
    return {
        channel: float(np.sqrt(np.mean(np.concatenate(rows)))) if sum(map(len, rows)) else 0.0
        for channel, rows in parts.items()
    }
