"""How far motors turned, and which ripples that can show."""

from __future__ import annotations

import math

import numpy as np

from tendon_ros.identify.fit import Problem

#: waves of a ripple that a motor has to pass
SEEN = 0.5
#: and how many where a turn has fewer than this, as hardly any motor (three slots and two poles
#: have six): what comes once is any torque that follows the angle
AGAIN, FEW = 2.0, 6.0


def shows(problem: Problem, place: str, cycles: float) -> bool:
    """
    Return whether a ripple can be told from any torque that follows the angle.

    :param problem: the data.
    :param place: of a motor.
    :param cycles: waves of the ripple on a turn.
    :return: whether the motor passed enough of them in any recording.
    """
    motors = problem.rollouts.instrument.motors
    [pulley] = [m.pulley for m in motors if f'motor_{m.name}' == place]
    far = travel(problem, pulley)
    # where nothing tells, a turn
    turns = 1.0 if far is None else far / (2.0 * math.pi)
    return cycles * turns >= (AGAIN if cycles < FEW else SEEN)


def travel(problem: Problem, pulley: str) -> float | None:
    """
    Return how far a driven pulley turned in any recording.

    :param problem: the data.
    :param pulley: its name.
    :return: [rad]; None where nothing tells.
    """
    travels = [
        float(np.ptp(segment.motion.value[segment.prescribed.index(pulley)]))
        for segment in problem.rollouts.segments
        if pulley in segment.prescribed
    ]
    return max(travels, default=None)
