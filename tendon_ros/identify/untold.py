"""
Torques that no motion tells: where dry friction holds a motor, or a limit cuts its torque off.

There the measured torque stands for the prediction, as far as friction or limit reach.
"""

from __future__ import annotations

from collections.abc import Callable
import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label

from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.limiting import given_by
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.rows import Rows

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: part of a motor's torques that no unknown limit cuts off; and where its torque constant is a
#: guess, with which a limit sinks until it excuses as much as it may
USUAL, USUAL_OF_A_GUESS = 0.2, 0.5


def as_held(rows: Rows, numbers: Numbers, segment: Segment, found: FloatArray) -> FloatArray:
    """
    Return the predictions with what dry friction holds as the recording has it.

    While a motor rests, dry friction takes any torque up to its limit, and no motion tells which:
    there the measured torque stands for the prediction, as far as friction reaches and to within
    a deviation of noise, so that holding still is no better than having nothing to hold. A torque
    that has lost its sign does so on either side of nothing.

    :param rows: what the model does along the segment.
    :param numbers: after its effects.
    :param segment: what was measured.
    :param found: what the model predicts, shape (channels, bins); it is changed.
    :return: the same array.
    """
    sensors = [s.name for s in rows.instrument.sensors]
    for n, j, still in segment.at_rest(rows.instrument):
        row, measured = found[n], segment.measured[n]
        if not rows.dry_limit[:, j].any():
            continue
        gain = numbers['motor_gain'][j]
        limit = _either_way(rows.dry_limit[:, j], still)
        used = rows.dry_friction[:, j]
        least, most = row + (used - limit) / gain, row + (used + limit) / gain
        if numbers['sensor_rectified'][sensors.index(measured.sensor.name)]:
            least, most = _without_sign(least, most, 2.0 * row * (rows.effort[:, j] < 0.0))
        held = np.clip(measured.value, least, most) - row
        held = np.sign(held) * np.maximum(0.0, np.abs(held) - measured.noise)
        row += np.where(still & np.isfinite(held), held, 0.0)
    return found


def _without_sign(
    least: FloatArray, most: FloatArray, turned: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the bounds of what is between two others, less ``turned``, without its sign."""
    one, other = np.abs(least - turned), np.abs(most - turned)
    across = (least < turned) & (most > turned)
    return np.where(across, 0.0, np.minimum(one, other)), np.maximum(one, other)


def _either_way(limit: FloatArray, still: BoolArray) -> FloatArray:
    """Return the largest friction of each rest: before and after it may differ, by direction."""
    found = limit.copy()
    runs, _ = label(still)
    for found_run in find_objects(runs):
        assert found_run is not None
        [run] = found_run
        found[run] = limit[max(0, run.start - 1) : run.stop + 1].max()
    return found


def as_reported(
    instrument: Instrument,
    numbers: Numbers,
    segment: Segment,
    found: FloatArray,
    usual: Callable[[str, float], float],
) -> FloatArray:
    """
    Return the predictions with the torque limits of the motors seen as the recording sees them.

    A motor whose torque is cut off reports a torque that no motion tells; there the measured
    torque stands for the prediction, less what the motion asks beyond the limit. What is cut off
    is the torque without its noise: a limit that took the noise away would always explain some.

    :param instrument: the network.
    :param numbers: after its effects.
    :param segment: what was measured.
    :param found: what the model predicts, shape (channels, bins); it is changed.
    :param usual: torque that is usually asked of a motor, by name and gain, or less [N m].
    :return: the same array.
    """
    names = list(instrument.motor_names)
    for row, measured in enumerate(segment.measured):
        if measured.sensor.kind != 'motor_torque':
            continue
        j = names.index(measured.sensor.of)
        if numbers['motor_limit'][j] >= 1e3:
            continue
        # a limit that nearly all torques passed is none: it would excuse whatever the model asks
        gain, bias = numbers['motor_gain'][j], numbers['motor_bias'][j]
        least = usual(measured.sensor.of, gain)
        asked = gain * found[row] + bias
        reported = measured.level
        given, _ = given_by(numbers, j, reported, least)
        found[row] = reported + (asked - given) / gain
    return found


def usual_part(instrument: Instrument, motor: str) -> float:
    """
    Return the part of a motor's torques that no limit, which the file does not know, cuts off.

    :param instrument: the network.
    :param motor: its name.
    :return: 0 to 1.
    """
    return USUAL_OF_A_GUESS if guesses_torque(instrument, motor) else USUAL


def guesses_torque(instrument: Instrument, motor: str) -> bool:
    """
    Return whether the file only guesses a motor's torque constant.

    :param instrument: the network.
    :param motor: its name.
    :return: whether.
    """
    return math.isinf(instrument.tolerances.get(f'motor_{motor}.torque_gain', 0.0))
