"""Sensors that may have lost their sign: what they read is never below zero."""

from __future__ import annotations

import numpy as np

from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.fit import Problem

BELOW = 0.05  # part of the range of a reading that noise may make negative


def may_be_signless(problem: Problem, candidate: Candidate) -> bool:
    """
    Return whether a candidate is a lost sign, and of a sensor that may have lost it.

    :param problem: the data.
    :param candidate: any effect at any place.
    :return: whether no reading of the sensor is negative by more than noise.
    """
    if not candidate.switches:
        return False
    values = [
        measured.value[np.isfinite(measured.value)]
        for segment in problem.rollouts.segments
        for measured in segment.measured
        if measured.sensor.name == candidate.place
    ]
    read = np.concatenate(values) if values else np.zeros(0)
    return read.size > 0 and float(read.min()) > -BELOW * float(np.ptp(read))
