"""
Named trajectories: step, the paper's Fig. 12, ramp, sine, multisine, chirp, minimum jerk.

A profile is a public function here that returns a :class:`Trajectory`. Its first argument is all
motors of the instrument, the others are settings with a default, a unit and bounds; command line,
ROS parameters and messages follow from them. To add a profile is to add a function.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from tendon_ros.model.trajectory import Trajectory
from tendon_ros.model.trajectory_setting import Setting

FloatArray = NDArray[np.float64]

#: spacing of the points of a smooth profile, and the time that a step takes [s]
SPACING = 1e-3

Driven = Annotated[tuple[str, ...], Setting('', 'motors that move; none for the first one')]
Amplitude = Annotated[float, Setting('rad', 'how far', -math.pi, math.pi)]
Start = Annotated[float, Setting('s', 'when it begins', SPACING, 1e3)]
Duration = Annotated[float, Setting('s', 'of the whole', 0.01, 3600.0)]
Frequency = Annotated[float, Setting('Hz', 'cycles in a second', 1e-3, 200.0)]
Fade = Annotated[float, Setting('s', 'to swell at the beginning and fade at the end', 0.0, 100.0)]

_DEGREE = math.pi / 180.0


def step(
    motors: Sequence[str],
    driven: Driven = (),
    amplitude: Amplitude = _DEGREE,
    start: Start = 0.5,
    duration: Duration = 3.0,
) -> Trajectory:
    """Turn suddenly, within a millisecond."""
    end = max(duration, start + 2.0 * SPACING)
    time = np.array([0.0, start, start + SPACING, end])
    return _moved('step', motors, driven, time, amplitude * np.array([0.0, 0.0, 1.0, 1.0]))


def ramp(
    motors: Sequence[str],
    driven: Driven = (),
    amplitude: Amplitude = 5.0 * _DEGREE,
    speed: Annotated[float, Setting('rad/s', 'how fast', 1e-6, 100.0)] = 5.0 * _DEGREE,
    start: Start = 0.5,
    duration: Duration = 3.0,
) -> Trajectory:
    """Turn at constant speed and hold."""
    arrival = start + max(abs(amplitude) / speed, SPACING)
    time = np.array([0.0, start, arrival, max(duration, arrival + SPACING)])
    return _moved('ramp', motors, driven, time, amplitude * np.array([0.0, 0.0, 1.0, 1.0]))


def paper_fig12(
    motors: Sequence[str],
    driven: Driven = (),
    rounding: Annotated[float, Setting('s', 'of the corners, 0 for sharp', 0.0, 0.2)] = 0.06,
    duration: Duration = 18.0,
) -> Trajectory:
    """
    Follow the paper's Fig. 12: 0, 5, 7, 5, 4 degrees, each held for three seconds.

    The text gives the angles; each change takes a second, and the second rise begins at 5 s, until
    which the paper says that its model agrees with its rig. A Gaussian rounds the corners.
    """
    time = _grid(duration)
    angle = np.zeros_like(time)
    slope = 0.0
    corners = ((1, 5), (2, 0), (5, 2), (6, 0), (9, -2), (10, 0), (13, -1), (14, 0))
    for corner, then in corners:
        angle += (then - slope) * _rounded_ramp(time - corner, rounding)
        slope = then
    return _moved('paper_fig12', motors, driven, time, angle * _DEGREE)


def sine(
    motors: Sequence[str],
    driven: Driven = (),
    amplitude: Amplitude = 5.0 * _DEGREE,
    frequency: Frequency = 0.5,
    duration: Duration = 10.0,
    fade: Fade = 0.5,
) -> Trajectory:
    """Swing at one frequency."""
    time = _grid(duration)
    angle = amplitude * _window(time, fade) * np.sin(2.0 * np.pi * frequency * time)
    return _moved('sine', motors, driven, time, angle)


def chirp(
    motors: Sequence[str],
    driven: Driven = (),
    amplitude: Amplitude = 2.0 * _DEGREE,
    first: Frequency = 0.1,
    last: Frequency = 5.0,
    duration: Duration = 20.0,
    fade: Fade = 0.5,
) -> Trajectory:
    """Raise the frequency from first to last, by the same factor in equal times."""
    time = _grid(duration)
    if first == last:
        turns = first * time
    else:
        growth = math.log(last / first) / time[-1]
        turns = first * np.expm1(growth * time) / growth
    angle = amplitude * _window(time, fade) * np.sin(2.0 * np.pi * turns)
    return _moved('chirp', motors, driven, time, angle)


def multisine(
    motors: Sequence[str],
    driven: Annotated[tuple[str, ...], Setting('', 'motors that move; none for all')] = (),
    amplitude: Amplitude = 5.0 * _DEGREE,
    frequencies: Annotated[tuple[float, ...], Setting('Hz', 'of equal weight', 1e-3, 200.0)] = (
        0.13,
        0.31,
        0.53,
        0.89,
        1.37,
        2.11,
    ),
    seed: Annotated[int, Setting('', 'of the phases', 0, 2**31 - 1)] = 0,
    duration: Duration = 20.0,
    fade: Fade = 0.5,
) -> Trajectory:
    """Swing at several frequencies at once, each motor in phases of its own, to one peak."""
    time = _grid(duration)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (len(motors), len(frequencies)))
    position = {}
    for motor, phase in zip(motors, phases, strict=True):
        waves = np.sin(2.0 * np.pi * np.outer(time, frequencies) + phase).sum(axis=1)
        waves *= _window(time, fade)
        moves = motor in (driven or motors)
        peak = float(np.max(np.abs(waves)))
        position[motor] = amplitude / peak * waves if moves and peak else np.zeros_like(time)
    return Trajectory('multisine', time, position)


def minimum_jerk(
    motors: Sequence[str],
    driven: Driven = (),
    amplitude: Amplitude = 5.0 * _DEGREE,
    move: Annotated[float, Setting('s', 'time of the turn', 0.01, 1e3)] = 1.0,
    start: Start = 0.5,
    duration: Duration = 3.0,
) -> Trajectory:
    """Turn as smoothly as the time allows and hold."""
    time = _grid(max(duration, start + move))
    s = np.clip((time - start) / move, 0.0, 1.0)
    angle = amplitude * s**3 * (10.0 + s * (6.0 * s - 15.0))
    return _moved('minimum_jerk', motors, driven, time, angle)


def _grid(duration: float) -> FloatArray:
    points = max(1, round(duration / SPACING)) + 1
    return SPACING * np.arange(points, dtype=np.float64)


def _moved(
    name: str, motors: Sequence[str], driven: Sequence[str], time: FloatArray, angle: FloatArray
) -> Trajectory:
    """Return a trajectory in which some motors follow and the others stay at 0."""
    moving = driven or motors[:1]
    still = np.zeros_like(time)
    return Trajectory(name, time, {m: angle if m in moving else still for m in motors})


def _rounded_ramp(time: FloatArray, width: float) -> FloatArray:
    """Return ``max(time, 0)`` smoothed by a Gaussian of standard deviation ``width``."""
    if width == 0.0:
        return np.maximum(time, 0.0)
    u = time / width
    bell = np.exp(-0.5 * u * u) / math.sqrt(2.0 * math.pi)
    ramp: FloatArray = 0.5 * time * (1.0 + erf(u / math.sqrt(2.0))) + width * bell
    return ramp


def _window(time: FloatArray, fade: float) -> FloatArray:
    """Return a factor that swells from 0 to 1 within ``fade`` and falls to 0 before the end."""
    if fade == 0.0:
        return np.ones_like(time)
    nearest = np.minimum(time, time[-1] - time)
    factor: FloatArray = np.sin(0.5 * np.pi * np.clip(nearest / fade, 0.0, 1.0)) ** 2
    return factor
