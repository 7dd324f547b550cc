"""
What drives the model: each motor's measured motion or, where it has no encoder, its torque.

With the motion known, the controller is out of the equations and every residual belongs to one of
them. Torque is the second choice: the model integrates it, and what it gets wrong adds up.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, replace

from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.model.instrument import Instrument, Sensor


@dataclass(frozen=True)
class Drive:
    """A driven pulley, its motor, and the sensor that tells what the motor does."""

    pulley: str
    motor: str
    sensor: Sensor

    @property
    def by_torque(self) -> bool:
        """Whether the motor's torque is known, not its motion."""
        return self.sensor.kind == 'motor_torque'


def drives(instrument: Instrument) -> tuple[Drive, ...]:
    """
    Return what drives the model, in the motors' order.

    :param instrument: the network.
    :return: one for each motor.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    found = []
    for motor in instrument.motors:
        sensors = [
            *(s for s in instrument.sensors if s.kind == 'angle' and s.of == motor.pulley),
            *(s for s in instrument.sensors if s.kind == 'motor_torque' and s.of == motor.name),
        ]
        if not sensors:
            raise RecordingError(
                f'{instrument.name}: motor {motor.name} has neither encoder nor torque_sensor; '
                'without one of them nothing drives the model'
            )
        found.append(Drive(motor.pulley, motor.name, sensors[0]))
    return tuple(found)


def motions_first(driving: Iterable[Drive]) -> list[Drive]:
    """
    Return what drives the model in the order of the rows of its signals.

    :param driving: in any order.
    :return: those by their motion, then those by their torque.
    """
    return sorted(driving, key=lambda d: d.by_torque)


def motor_channels(instrument: Instrument) -> tuple[str, ...]:
    """
    Return the channels that drive the model, in the motors' order.

    :param instrument: the network.
    :return: channel names.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    return tuple(drive.sensor.channel for drive in drives(instrument))


def encoder_channels(instrument: Instrument) -> tuple[str, ...]:
    """
    Return the channels of the motors' encoders, of those motors that have one.

    :param instrument: the network.
    :return: channel names, in the motors' order.
    """
    return tuple(d.sensor.channel for d in drives(instrument) if not d.by_torque)


def as_recorded(instrument: Instrument, channels: Container[str]) -> Instrument:
    """
    Return an instrument without the motor encoders that nobody recorded.

    :param instrument: the network.
    :param channels: what was recorded.
    :return: the same, but that motors of which only the torque was recorded are driven by it.
    """
    unseen = {
        (d.motor, d.sensor.name)
        for d in drives(instrument)
        if not d.by_torque and d.sensor.channel not in channels
    }
    told = {s.of for s in instrument.sensors if s.kind == 'motor_torque' and s.channel in channels}
    gone = {sensor for motor, sensor in unseen if motor in told}
    return replace(instrument, sensors=tuple(s for s in instrument.sensors if s.name not in gone))


def with_encoders(recorded: Instrument, given: Instrument) -> Instrument:
    """
    Return an instrument with the motor encoders that nobody recorded: by them it is controlled.

    :param recorded: from :func:`as_recorded`, whatever became of it.
    :param given: what it was before.
    :return: the same with all sensors.
    """
    known = {s.name: s for s in recorded.sensors}
    return replace(recorded, sensors=tuple(known.get(s.name, s) for s in given.sensors))


def said_of_torque(instrument: Instrument) -> list[str]:
    """
    Say which motors had no position to drive the model with.

    :param instrument: as it was recorded.
    :return: a sentence, if there are any.
    """
    motors = [d.motor for d in drives(instrument) if d.by_torque]
    if not motors:
        return []
    return [
        f'the position of {listed(motors)} was not recorded: the model is driven with the torque '
        'instead, and what it gets wrong adds up; record the position where there is an encoder, '
        'or import the integral of a speed that has its sign as the position'
    ]
