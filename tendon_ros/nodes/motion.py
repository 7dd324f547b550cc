"""A planned motion of several joints, from rest to rest: for ``move_jp`` and to a first point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tendon_ros.base.recording import FloatArray

#: largest speed of a minimum-jerk motion over its mean speed
PEAK = 1.875


@dataclass(frozen=True)
class Motion:
    """A minimum-jerk motion of all joints at once, from ``start`` [rad] to ``goal`` [rad]."""

    start: FloatArray
    goal: FloatArray
    begin: float  # [s]
    duration: float  # [s]

    @property
    def end(self) -> float:
        """When the goal is reached [s]."""
        return self.begin + self.duration

    def at(self, time: FloatArray) -> FloatArray:
        """
        Return the positions on the way.

        :param time: [s], shape (n,).
        :return: [rad], shape (n, joints); exactly the goal from the end on.
        """
        if not self.duration:
            return np.tile(self.goal, (len(time), 1))
        x = np.clip((time - self.begin) / self.duration, 0.0, 1.0)[:, None]
        path = self.start + (self.goal - self.start) * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        return np.where(x >= 1.0, self.goal, path)


def plan(
    start: Mapping[str, float],
    goal: Mapping[str, float],
    begin: float,
    speeds: Mapping[str, float],
    shortest: float = 0.0,
) -> Motion:
    """
    Return the motion that takes every joint to its goal in the same time.

    :param start: positions now [rad], by joint.
    :param goal: positions to reach [rad]; joints that are left out stay.
    :param begin: when it begins [s].
    :param speeds: the speed that a joint may reach on the way [rad/s], by joint.
    :param shortest: the time that it takes at least [s].
    :return: the motion, as quick as that and the speeds allow.
    """
    ends = {**start, **goal}
    slowest = max((abs(ends[name] - start[name]) / speeds[name] for name in start), default=0.0)
    return Motion(
        np.array(list(start.values())),
        np.array([ends[name] for name in start]),
        begin,
        max(PEAK * slowest, shortest),
    )
