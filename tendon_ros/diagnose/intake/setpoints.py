"""
Motor positions against their own set-points.

A controller cannot follow with a wrong sign or scale, so where the two disagree in one of these,
one of them was recorded wrongly. The set-point is only needed for the closed loop and is left out;
whether the position is at fault is for the other channels to say.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose.intake.motion import travel
from tendon_ros.diagnose.intake.step import asked_of, Sifted, without
from tendon_ros.diagnose.intake.units import factor_name
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.model.instrument import Instrument

STRONG = 0.02  # [rad] of a set-point that a motor must follow visibly
SURE = 0.9  # correlation


def followed(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out recordings with a dead motor encoder, and set-points that contradict the motion.

    :param recordings: with every motor's position.
    :param instrument: the network.
    :return: the others, and sentences.
    """
    kept: list[Recording] = []
    sentences: list[str] = []
    for recording in recordings:
        unusable = ''
        wrong: set[str] = set()
        for name in encoder_channels(instrument):
            wished = asked_of(name)
            if wished not in recording:
                continue
            position, setpoint = recording[name], recording[wished]
            unusable = unusable or _unusable(position, setpoint)
            fault = _contradiction(position, setpoint)
            if fault:
                wrong.add(wished)
                sentences.append(f'{recording.name}: {wished} left out: {fault}')
        if unusable:
            sentences.append(f'{recording.name}: {unusable}')
        else:
            kept.append(without(recording, wrong))
    return tuple(kept), sentences


def _unusable(position: Channel, setpoint: Channel) -> str:
    """Say why a position cannot be what the motor did; nothing where it can."""
    asked = _asked(position, setpoint)
    if asked > STRONG and np.ptp(position.value) == 0.0:
        return (
            f'{position.name} is stuck at {position.value[0]:.4g} rad while its set-point moves '
            f'{asked:.3g} rad: its encoder is dead or the motor off; mend that and record again'
        )
    r, factor = _relation(position, setpoint)
    unit = factor_name(1.0 / factor, 'angle') if abs(r) > SURE else ''
    if unit and factor < 1.0:
        return (
            f'{position.name} does {1.0 / factor:.4g} times what its set-point asks, as if '
            f'{unit}; convert it on import'
        )
    return ''


def _contradiction(position: Channel, setpoint: Channel) -> str:
    """Say why a set-point cannot be what the motor followed; nothing where it can."""
    r, factor = _relation(position, setpoint)
    if abs(r) < SURE:
        return ''
    unit = factor_name(factor, 'angle') if factor > 1.0 else ''
    if unit:
        return f'{factor:.4g} times what {position.name} does, as if {unit}; convert it on import'
    if r < 0.0 and 0.5 < factor < 2.0:
        return (
            f'it runs against {position.name} (correlation {r:.2f}), so one of the two has the '
            'wrong sign; turn it on import'
        )
    return ''


def _asked(position: Channel, setpoint: Channel) -> float:
    """Return how far a set-point goes while the position is measured [rad]."""
    return travel(setpoint.at(position.time)) if setpoint.value.size else 0.0


def _relation(position: Channel, setpoint: Channel) -> tuple[float, float]:
    """Return correlation, and set-point by position; 0 and 1 where they tell nothing."""
    if min(_asked(position, setpoint), travel(position.value)) == 0.0:
        return 0.0, 1.0
    if max(_asked(position, setpoint), travel(position.value)) < STRONG:
        return 0.0, 1.0
    a, b = position.value, setpoint.at(position.time)
    return float(np.corrcoef(a, b)[0, 1]), float(np.std(b) / np.std(a))
