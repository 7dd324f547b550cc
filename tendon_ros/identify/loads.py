"""Measured loads: what a cell reads, as torques on the pulleys that it presses."""

from __future__ import annotations

from collections.abc import Iterator

from tendon_ros.model.instrument import Instrument, Sensor


def pressing(instrument: Instrument, pulley: str) -> tuple[int, float]:
    """
    Return whose reading acts on a pulley as a known load.

    :param instrument: the network.
    :param pulley: one that no motor turns.
    :return: the number of the sensor, and the torque on the pulley by its reading.
    """
    return next(
        (instrument.sensors.index(sensor), levers[pulley])
        for sensor, levers in loads(instrument)
        if pulley in levers
    )


def loads(instrument: Instrument) -> Iterator[tuple[Sensor, dict[str, float]]]:
    """
    Yield the sensors of loads, each with the torque on pulleys by its reading.

    :param instrument: the network.
    :return: sensors, with levers [m, or 1 where a torque is measured] by pulley.
    """
    contacts = {c.name: c for c in instrument.contacts}
    for sensor in instrument.sensors:
        if sensor.kind in ('contact_force', 'contact_torque'):
            contact = contacts[sensor.of]
            arm = contact.arm if sensor.kind == 'contact_force' else 1.0
            yield sensor, {pulley: -arm * ratio for pulley, ratio in contact.route.items()}
