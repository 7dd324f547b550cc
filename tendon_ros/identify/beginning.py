"""
Where a model begins: at rest, and where the motors truly are.

A pose is found once, for the motion as it was read and the file as it is. An encoder that reads
past the truth moves the motors of the model elsewhere, and all that hangs on them has to go along;
a weight stretches its cable before anything moves. Left behind, light pulleys would ring for a
second, and friction would hold them where they never were.

What lies within a play is held by nothing but friction: it begins where its own sensor reads it,
and would swing for seconds about where a weight comes to rest in the end. So does what moves where
a recording begins while motors move, or swings farther than they take it along: as fast as its
sensor reads it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.segment import Measured, Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.signals import Signals
from tendon_ros.model.statics import Statics

FloatArray = NDArray[np.float64]

RESTING = 1.0  # [s] before the recording begins, in which the model comes to rest
#: of the stiffest link: what a play or a slack cable counts as, which hold nothing by themselves
FAINT = 1e-6
#: [s] that tell how fast something swings, and errors of its sensor that it moves by in these
SWING, FAR = 0.06, 10.0
BENT = 3  # degree of what a swing looks like for so long
ALONG = 2.0  # times as far as motors take it along that something goes at most, if it was at rest
SUDDEN = 0.7  # part of the speed that a motor has soon after, with which no motion begins


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

    def loose(self, numbers: Numbers, motion: Signals) -> dict[str, tuple[float, float]]:
        """
        Return where pulleys begin that do not rest where they would come to rest.

        :param numbers: after the effects in force.
        :param motion: what truly drove.
        :return: angles [rad] and speeds [rad/s] by pulley, of those whose own sensor was read and
            which swing, or lie within the play of all that they hang on.
        """
        plays = bool(numbers['play'].any())
        driven = motion.value[: len(self._segment.prescribed), 0].tolist()
        begun = {**self.pose(motion), **dict(zip(self._segment.prescribed, driven, strict=True))}
        found = {}
        for name, sensor, offset, gain in self._read(numbers):
            first = float(sensor.value[np.isfinite(sensor.value)][0])
            angle, speed = self._swinging(name, sensor) or (first, 0.0)
            at = (angle - offset) / gain
            if speed or (plays and self._is_held_by_nothing(numbers, name, {**begun, name: at})):
                found[name] = (at, speed / gain)
        return found

    def _is_held_by_nothing(
        self, numbers: Numbers, name: str, angles: Mapping[str, float]
    ) -> bool:
        """Return whether a pulley lies within the play of all that it hangs on."""
        one = self._instrument
        links = numbers.loops_on(one.index(name))
        pose = np.array([angles.get(p.name, 0.0) for p in one.pulleys])
        stretched = np.abs(numbers['radius'][links] @ pose)
        return bool(links) and bool(np.all(stretched < 0.5 * numbers['play'][links]))

    def _read(self, numbers: Numbers) -> Iterator[tuple[str, Measured, float, float]]:
        """Yield inner pulleys that have a sensor, what it read, and its offset [rad] and gain."""
        measured = {
            m.sensor.channel: m for m in self._segment.measured if np.isfinite(m.value).any()
        }
        for s, offset, gain in zip(
            self._instrument.sensors, numbers['sensor_offset'], numbers['sensor_gain'], strict=True
        ):
            inner = s.kind == 'angle' and s.of in self._segment.pose and s.zeroed
            if inner and s.channel in measured:
                yield s.of, measured[s.channel], float(offset), float(gain)

    def _swinging(self, name: str, measured: Measured) -> tuple[float, float] | None:
        """Return what a sensor reads at first, and its rate; None where it came from rest."""
        known = self._first & np.isfinite(measured.value)
        tells = self._segment.prescribed and measured.floor > 0.0
        if not tells or np.count_nonzero(known) <= BENT:
            return None
        farthest = FAR * measured.floor
        if not self._under_way:
            farthest += ALONG * self._taken[name]
        if not np.ptp(measured.value[known]) > farthest:
            return None
        time = self._segment.time
        *_, rate, angle = np.polyfit(time[known] - time[0], measured.value[known], BENT)
        return float(angle), float(rate)

    @property
    def _first(self) -> NDArray[np.bool_]:
        """Which bins tell how it began, shape (bins,)."""
        first: NDArray[np.bool_] = self._segment.time < self._segment.time[0] + SWING
        return first

    @cached_property
    def _taken(self) -> Mapping[str, float]:
        """How far motors take others along while it begins [rad], by pulley."""
        rows = self._segment.motion.value[: len(self._segment.prescribed)]
        far = np.abs(self._following) @ np.ptp(rows[:, self._first], axis=1)
        return dict(zip(self._segment.pose, far.tolist(), strict=True))

    @cached_property
    def _under_way(self) -> bool:
        """Whether a motor is as fast where the recording begins as soon after."""
        first = np.flatnonzero(self._first)
        for row, still in zip(self._segment.motion.value, self._segment.still, strict=False):
            way = np.abs(row[first[[len(first) // 3, -1]]] - row[0])
            if not still[first].any() and len(first) > BENT and 3.0 * way[0] > SUDDEN * way[1]:
                return True
        return False

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
