"""
Where a model begins: at rest, and where the motors truly are.

A pose is found once, for the motion as it was read and the file as it is. An encoder that reads
past the truth moves the motors of the model elsewhere, and all that hangs on them has to go along;
a weight stretches its cable before anything moves. Left behind, light pulleys would ring for a
second, and friction would hold them where they never were.

What lies within a play is held by nothing but friction: it begins where its own sensor reads it,
and would swing for seconds about where a weight comes to rest in the end.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.signals import Signals
from tendon_ros.model.statics import Statics

FloatArray = NDArray[np.float64]

RESTING = 1.0  # [s] before the recording begins, in which the model comes to rest
#: of the stiffest link: what a play or a slack cable counts as, which hold nothing by themselves
FAINT = 1e-6


class Beginning:
    """
    The beginning of a recording.

    :param instrument: the network.
    :param segment: with the pose that goes with its motion as it was read.
    """

    def __init__(self, instrument: Instrument, segment: Segment) -> None:
        self._instrument = instrument
        self._segment = segment

    @property
    def resting(self) -> float:
        """For how long the model may come to rest before [s]."""
        return RESTING if self._segment.begins_at_rest(self._instrument) else 0.0

    def pose(self, motion: Signals) -> Mapping[str, float]:
        """
        Return the pose that goes with a motion.

        :param motion: what truly drove.
        :return: angles [rad] of the pulleys whose motion is not given.
        """
        pose = self._segment.pose
        rows = len(self._segment.prescribed)
        shift = motion.value[:rows, 0] - self._segment.motion.value[:rows, 0]
        if not pose or not shift.any():
            return pose
        along = self._following @ shift
        return {name: pose[name] + more for name, more in zip(pose, along.tolist(), strict=True)}

    def loose(self, numbers: Numbers, motion: Signals) -> dict[str, float]:
        """
        Return where pulleys begin that lie within the play of all that they hang on.

        :param numbers: after the effects in force.
        :param motion: what truly drove.
        :return: angles [rad] by pulley, of those whose own sensor was read.
        """
        if not numbers['play'].any():
            return {}
        one = self._instrument
        driven = motion.value[: len(self._segment.prescribed), 0].tolist()
        begun = {**self.pose(motion), **dict(zip(self._segment.prescribed, driven, strict=True))}
        found = {}
        for name, angle in self._read(numbers).items():
            links = numbers.loops_on(one.index(name))
            angles = np.array([{**begun, name: angle}.get(p.name, 0.0) for p in one.pulleys])
            stretched = np.abs(numbers['radius'][links] @ angles)
            if links and np.all(stretched < 0.5 * numbers['play'][links]):
                found[name] = angle
        return found

    def _read(self, numbers: Numbers) -> dict[str, float]:
        """Return what the first readings of inner pulleys say of their angles [rad]."""
        first = {m.sensor.channel: m.value[np.isfinite(m.value)] for m in self._segment.measured}
        return {
            s.of: float((first[s.channel][0] - offset) / gain)
            for s, offset, gain in zip(
                self._instrument.sensors,
                numbers['sensor_offset'],
                numbers['sensor_gain'],
                strict=True,
            )
            if s.kind == 'angle'
            and s.of in self._segment.pose
            and s.zeroed
            and s.channel in first
            and first[s.channel].size
        }

    @cached_property
    def _following(self) -> FloatArray:
        """
        How far pulleys go with those whose motion is given, where links are stretched least.

        Shape (others, given).
        """
        one = self._instrument
        still = np.zeros(len(one.pulleys))
        stiffness = Statics(one, effects=()).at(still, still).loop_stiffness
        least = FAINT * (stiffness.max(initial=0.0) or 1.0)
        weight = np.sqrt(np.maximum(stiffness, least))
        routing = weight[:, None] * one.routing()
        given = routing[:, [one.index(name) for name in self._segment.prescribed]]
        others = routing[:, [one.index(name) for name in self._segment.pose]]
        found: FloatArray = -np.linalg.lstsq(others, given, rcond=None)[0]
        return found
