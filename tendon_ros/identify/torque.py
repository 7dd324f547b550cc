"""Torques that drive the model: commands that hold until the next, or lines between readings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.identify.driving import Drive

FloatArray = NDArray[np.float64]

USUAL_BIN = 0.008  # [s], a tenth of the time in which a cable-driven instrument answers
STEPS = 0.5  # part of its samples that are as the one before, of a torque that moves by steps
SAME = 0.9  # part of the time between its samples that the period of its controller is at least


def by_seldom_torque(recording: Recording, driving: Sequence[Drive]) -> bool:
    """
    Return whether nothing but torques drives the model, and they come less often than bins.

    :param recording: what was measured.
    :param driving: what drives the model.
    :return: whether bins are better finer than samples, with a reading in the middle of some.
    """
    return all(d.by_torque and seldom(recording[d.sensor.channel]) for d in driving)


def seldom(channel: Channel) -> bool:
    """
    Return whether readings come less often than bins.

    :param channel: what was read.
    :return: whether.
    """
    return channel.sampling > USUAL_BIN


def holds(channel: Channel, tick: float) -> bool:
    """
    Return whether a torque is a command, such as a voltage, that holds until the next.

    Taken for a line from sample to sample it would begin to rise half a sample before it does.

    :param channel: the torque.
    :param tick: period of the controllers [s].
    :return: whether it moves by steps, or comes as seldom as controllers set it.
    """
    set_then = seldom(channel) and tick > SAME * channel.sampling
    return set_then or bool(np.mean(np.diff(channel.value) == 0.0) > STEPS)


def torque_of(channel: Channel, start: float, period: float, bins: int, tick: float) -> FloatArray:
    """
    Return a torque on bins: it may jump, and is not smoothed.

    :param channel: what was read.
    :param start: where the first bin begins [s].
    :param period: length of a bin [s].
    :param bins: how many.
    :param tick: period of the controllers [s].
    :return: means of what holds, else values at the middles, shape (bins,).
    """
    edges = start + period * np.arange(bins + 1, dtype=np.float64)
    if holds(channel, tick):
        # what has been given until then, without what came before the first reading
        given = np.concatenate([[0.0], np.cumsum(channel.value[:-1] * np.diff(channel.time))])
        until = np.interp(edges, channel.time, given)
        first, last = channel.value[0], channel.value[-1]
        until += first * np.minimum(0.0, edges - channel.time[0])
        until += last * np.maximum(0.0, edges - channel.time[-1])
        return np.asarray(np.diff(until) / period, dtype=np.float64)
    return np.asarray(channel.at(edges[:-1] + 0.5 * period), dtype=np.float64)
