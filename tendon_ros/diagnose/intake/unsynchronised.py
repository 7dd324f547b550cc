"""
Channels of another recorder, whose clock is not that of the motors.

A late sensor is an effect, as long as it is late by no more than one may be. What is off by more,
either way, was written by a recorder that was started by hand, or counts from another zero. Its
stamps are moved to where the channel fits what the motion asks for.

A shape that seems moved may be another force: friction follows the speed and inertia the
acceleration, a quarter of a period apart. So a channel may be anything that is made of the model's
expectation, of angles, speeds, directions and accelerations of all motors; only if nothing of that
fits where the stamps are, and plainly does elsewhere, at one place and no other, the stamps are
wrong. It is asked of the same readings, or a push would be left behind by looking elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel, FloatArray, Recording
from tendon_ros.diagnose.intake.expected import Comparison, Expectation, STEP
from tendon_ros.effects.sensor_delay import LONGEST

#: [s] by which a channel may be off; and the part of the shared time
MOST, PART = 5.0, 0.2
COARSE = 5  # steps of the grid between lags that are tried at first
#: part of a channel's power that stays where it fits; and of what stays where its stamps are
FITS, BETTER = 0.1, 0.25
#: times what stays at the best lag, and more of the power, that stays everywhere else; [s] around
AGAIN, MORE, AROUND = 2.0, 0.05, 0.25
#: steps of the grid by which an effect may make a sensor late
LATE = round(LONGEST / STEP)


def on_one_clock(recording: Recording, runs: Sequence[Expectation]) -> tuple[Recording, list[str]]:
    """
    Move the stamps of channels that another recorder took.

    :param recording: with every motor's position.
    :param runs: of the model along it, best first.
    :return: the recording with stamps moved where they were wrong, and a sentence for each.
    """
    moved: list[Channel] = []
    sentences: list[str] = []
    for name in dict.fromkeys(name for run in runs for name in run.comparisons):
        tried = [_lag(run.comparisons[name], run) for run in runs if name in run.comparisons]
        _, lag = min(tried)  # a wall is there or not as it fits best
        if not lag:
            continue
        channel = recording[name]
        moved.append(Channel(name, channel.time - lag, channel.value))
        sentences.append(
            f'{recording.name}: {name} is {abs(lag):.3f} s {"late" if lag > 0.0 else "early"} '
            'against the motion, as if written by another recorder: its stamps are moved by that; '
            'record everything on one clock'
        )
    return recording.with_channels(moved) if moved else recording, sentences


def _lag(one: Comparison, run: Expectation) -> tuple[float, float]:
    """
    Return what stays of a channel where it fits best, as a part of its power, and its lag [s].

    The lag is negative where the channel is early, and 0 where it may be on time.
    """
    if not one.telling:
        return 1.0, 0.0
    count = len(one.measured)
    most = min(round(MOST / STEP), int(PART * count)) // COARSE * COARSE
    if most * STEP <= LONGEST:
        return 1.0, 0.0
    whole = _made_of(one, run)
    made = whole[most : count - most]
    tried = np.arange(-most, most + 1, COARSE)
    stays = _stays(_from(one.measured, most + tried, len(made)), made, COARSE)
    best = int(np.argmin(stays))
    least = float(stays[best])
    # the readings that fit there, about where their stamps are: a sensor may be late
    first = most + int(tried[best])
    late = range(-min(LATE, count - len(made) - first), min(LATE, first) + 1, COARSE)
    own = _from(one.measured, np.array([first]), len(made))
    here = min(float(_stays(own, whole[first - n :][: len(made)], COARSE)[0]) for n in late)
    apart = np.abs(tried - tried[best]) * STEP > AROUND
    again = float(stays[apart].min(initial=1.0)) < AGAIN * least + MORE
    # where it fits already, friction that holds an inner pulley back may look late
    moved = here > FITS > least and least < BETTER * here
    if again or not moved or best in (0, len(tried) - 1):
        return least, 0.0
    near = tried[best] + np.arange(-COARSE, COARSE + 1)
    close = _stays(_from(one.measured, most + near, len(made)), made, 1)
    lag = STEP * int(near[np.argmin(close)])
    return least, lag if abs(lag) > LONGEST else 0.0


def _made_of(one: Comparison, run: Expectation) -> FloatArray:
    """Return what a channel may be made of, shape (n, columns)."""
    columns = [np.ones(len(one.expected)), one.expected]
    for angle in run.motion.values():
        speed = np.gradient(angle, STEP)
        columns += [angle, speed, np.sign(speed), np.gradient(speed, STEP)]
    return np.stack(columns, axis=1)


def _from(measured: FloatArray, begins: NDArray[np.int64], count: int) -> FloatArray:
    """Return so many readings from each of several steps of the grid on, one row each."""
    return np.stack([measured[begin:][:count] for begin in begins.tolist()])


def _stays(rows: FloatArray, made: FloatArray, every: int) -> FloatArray:
    """Return the part of each row's power that stays of it, by every so many steps of the grid."""
    basis, _ = np.linalg.qr(made[::every] / np.maximum(np.abs(made).max(axis=0), 1e-300))
    rows = rows[:, ::every]
    rows = rows - rows.mean(axis=1, keepdims=True)
    whole = np.sum(rows**2, axis=1)
    told = np.sum((rows @ basis) ** 2, axis=1)
    return np.asarray(np.clip(1.0 - told / np.maximum(whole, 1e-300), 0.0, 1.0))
