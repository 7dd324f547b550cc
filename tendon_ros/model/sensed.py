"""What each sensor of an instrument reads, in the numbers of the kernel."""

from __future__ import annotations

from tendon_ros.base.effect import SENSED
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.structure import Structure


def sensed(instrument: Instrument, structure: Structure) -> list[tuple[int, int]]:
    """
    Return what the sensors read.

    :param instrument: the network with its sensors.
    :param structure: of its kernel.
    :return: by sensor, in the instrument's order: the number of its kind, and the kernel's index
        of the pulley, motor or contact, or of the entry of ``LOOP_PULLEY``.
    """
    motors = [motor.name for motor in instrument.motors]
    contacts = [contact.name for contact in instrument.contacts]
    links = [link.name for link in instrument.links]
    found = []
    for sensor in instrument.sensors:
        if sensor.kind in ('angle', 'velocity'):
            index = structure.order.index(instrument.index(sensor.of))
        elif sensor.kind == 'motor_torque':
            index = motors.index(sensor.of)
        elif sensor.kind == 'loop_torque':
            k = links.index(sensor.through)
            pulley = structure.order.index(instrument.index(sensor.of))
            index = structure['WIDTH'] * k + structure.loop_pulley[k].index(pulley)
        else:
            index = contacts.index(sensor.of)
        found.append((SENSED.index(sensor.kind), index))
    return found
