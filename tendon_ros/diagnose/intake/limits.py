"""
Motor positions and torques against the limits of the instrument file.

Limits are of what may be commanded: where what was asked lies within them, a loop that shakes is
no other rig and worth a diagnosis.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from tendon_ros.base.recording import FloatArray, Recording
from tendon_ros.diagnose.intake.step import asked_of, Sifted, sifted
from tendon_ros.identify.driving import drives
from tendon_ros.model.instrument import Instrument, Motor

#: overshoot and an encoder's offset that are forgiven [share of the limits' width]
FORGIVEN = 0.15


def within_limits(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out recordings in which a motor is where it cannot be.

    :param recordings: with every motor's position.
    :param instrument: with the limits of what may be commanded.
    :return: the others, and sentences.
    """
    return sifted(recordings, lambda recording: _fault(recording, instrument))


def strong_words(recordings: Sequence[Recording], instrument: Instrument) -> tuple[str, ...]:
    """
    Say which motors give so much more than they can that the unit must be another.

    Nothing is left out for it: a limit may be a guess.

    :param recordings: of the instrument.
    :param instrument: with the limits of its motors and controllers.
    :return: a sentence for each motor.
    """
    motors = {m.name: m for m in instrument.motors}
    found = []
    for sensor in instrument.sensors:
        if sensor.kind != 'motor_torque':
            continue
        spans = [_span(r, sensor.channel) for r in recordings if sensor.channel in r]
        largest = max((float(np.abs(span).max()) for span in spans), default=0.0)
        motor = motors[sensor.of]
        if motor.cannot_give(largest):
            limit = motor.largest
            found.append(
                f'{sensor.channel} reaches {largest:.4g} N m, {largest / limit:.0f} times what '
                f'motor {motor.name} of {instrument.name} can ({limit:.4g} N m); correct its unit '
                'on import, or the limit'
            )
    return tuple(found)


def _fault(recording: Recording, instrument: Instrument) -> str:
    sensors = {d.motor: d.sensor.channel for d in drives(instrument) if not d.by_torque}
    for motor in instrument.motors:
        if motor.name not in sensors:
            continue
        name = sensors[motor.name]
        low, high = motor.position_limit
        if not math.isfinite(high - low):
            continue
        found = _span(recording, name)
        if _within(found, motor):
            continue
        far = motor.cannot_be(float(np.abs(found).max()))
        wished = asked_of(name)
        if not far and wished in recording and _within(_span(recording, wished), motor):
            continue
        guess = (
            '; in degrees it would fit: convert it to rad on import'
            if far and _within(np.deg2rad(found), motor)
            else '; give the file of this rig, or correct its position_limit'
        )
        return (
            f'{name} goes from {found[0]:.4g} to {found[1]:.4g} rad, beyond the position_limit '
            f'{low:.4g} to {high:.4g} rad of motor {motor.name} in {instrument.name}{guess}'
        )
    return ''


def _span(recording: Recording, name: str) -> FloatArray:
    """Return from where to where a channel goes, single samples left out."""
    return np.asarray(np.quantile(recording[name].value, [0.002, 0.998]), dtype=np.float64)


def _within(span: FloatArray, motor: Motor) -> bool:
    """Return whether a motor may have gone from here to there."""
    low, high = motor.position_limit
    margin = FORGIVEN * (high - low)
    return bool(low - margin <= span[0] and span[1] <= high + margin)
