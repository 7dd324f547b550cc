"""What truly drove a rig: measured motions and torques, without what effects make of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.loads import pressing
from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.limiting import given_by
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]


def true_motion(
    instrument: Instrument, numbers: Numbers, segment: Segment, late: float = 0.0
) -> Signals:
    """
    Return what drove the rig, mended: motions seen, torques reported and loads measured.

    :param instrument: the network.
    :param numbers: after its effects.
    :param segment: what was measured.
    :param late: how much later to let all of it happen [s], a part of a bin.
    :return: the signals to drive with, earlier by half a bin: the kernel's ticks are the middles.
    """
    motion = segment.motion
    value, slope, bend = motion.value.copy(), motion.slope.copy(), motion.bends.copy()
    for row, pulley in enumerate(segment.prescribed):
        for q, sensor in enumerate(instrument.sensors):
            if sensor.kind == 'angle' and sensor.of == pulley:
                _mend(value[row], (slope[row], bend[row]), numbers, q, motion.step)
                break
    for row, pulley in enumerate(segment.pushed, start=len(segment.prescribed)):
        motors = [j for j, m in enumerate(instrument.motors) if m.pulley == pulley]
        for j in motors:
            value[row], part = given_by(numbers, j, value[row])
            slope[row] *= part
        if not motors:
            q, lever = pressing(instrument, pulley)
            _mend(value[row], (slope[row], bend[row]), numbers, q, motion.step, lever)
    if late != 0.0:
        for row in (*value, *slope, *bend):
            row[:] = _earlier(row, -late / motion.step)
    return Signals(value, slope, 0.0, motion.step, bend)


def _mend(
    value: FloatArray,
    slopes: Sequence[FloatArray],
    numbers: Numbers,
    sensor: int,
    step: float,
    lever: float = 1.0,
) -> None:
    """Turn what a sensor read, times a lever, into what was there; all arrays are changed."""
    gain, offset = numbers['sensor_gain'][sensor], numbers['sensor_offset'][sensor]
    late = numbers['sensor_delay'][sensor]
    if late != 0.0:
        for row in (value, *slopes):
            row[:] = _earlier(row, late / step)
    value[:] = (value - lever * offset) / gain
    for row in slopes:
        row /= gain


def _earlier(value: FloatArray, steps: float) -> FloatArray:
    """
    Return what is sampled evenly, by a part of a step or by several earlier.

    A shift of phases leaves the noise of the motion as large as it is. Interpolation would take
    some of it away, and half a bin of delay would explain that in any recording.
    """
    n = len(value)
    ends = value[0] + (value[-1] - value[0]) * np.linspace(0.0, 1.0, n)
    rest = value - ends
    # odd about both ends: what repeats itself has no jumps
    waves = np.fft.rfft(np.concatenate([rest, -rest[-2:0:-1]]))
    waves *= np.exp(2j * np.pi * np.fft.rfftfreq(2 * n - 2) * steps)
    slope = (value[-1] - value[0]) / (n - 1)
    found: FloatArray = np.fft.irfft(waves, 2 * n - 2)[:n] + ends + steps * slope
    return found
