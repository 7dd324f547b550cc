"""Which channels of a measurement mean what for an instrument, and what an estimate is called."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import InstrumentError
from tendon_ros.base.recording import channel_name
from tendon_ros.model.instrument import Contact, Instrument, Sensor

FloatArray = NDArray[np.float64]

#: a sensor without stated noise or resolution is trusted to this part of its working range
UNSTATED_ANGLE = 1e-4  # [rad]
UNSTATED_TORQUE = 1e-2  # [N m]


@dataclass(frozen=True)
class OperatingForce:
    """
    The contact whose force is estimated.

    ``torque`` [N m], shape (n,): torque that one unit of it puts on each pulley; ``quantity`` is
    ``force`` [N] or, where the instrument's load cell measures a torque, ``torque`` [N m].
    """

    contact: Contact
    torque: FloatArray
    quantity: str

    @property
    def channel(self) -> str:
        """Name of the estimate."""
        return f'estimate/{self.quantity}'

    @property
    def newton(self) -> float:
        """What the tip's force of one newton is in the unit of the quantity."""
        return 1.0 if self.quantity == 'force' else self.contact.arm


def operating_force(instrument: Instrument) -> OperatingForce:
    """
    Return what "the operating force" of an instrument is.

    :param instrument: with a contact: that of the load cell, else the first.
    :return: the contact and how its force turns the pulleys.
    :raises InstrumentError: where there is no contact.
    """
    cells = [s for s in instrument.sensors if s.kind in ('contact_force', 'contact_torque')]
    if not instrument.contacts:
        raise InstrumentError(
            f'{instrument.name}: contacts: there is none, so there is no operating force to '
            'estimate; describe where the instrument touches its load'
        )
    by_name = {c.name: c for c in instrument.contacts}
    contact = by_name[cells[0].of] if cells else instrument.contacts[0]
    quantity = 'torque' if cells and cells[0].kind == 'contact_torque' else 'force'
    lever = np.zeros(len(instrument.pulleys))
    for pulley, ratio in contact.route.items():
        lever[instrument.index(pulley)] = -ratio
    if quantity == 'force':
        lever *= contact.arm
    return OperatingForce(contact, lever, quantity)


def sensors_of(instrument: Instrument, kinds: tuple[str, ...]) -> Mapping[str, Sensor]:
    """
    Return an instrument's sensors of some kinds, by channel.

    :param instrument: the instrument.
    :param kinds: kinds of sensor.
    :return: sensors by channel.
    """
    return {s.channel: s for s in instrument.sensors if s.kind in kinds}


def usual_channels(known: Mapping[str, Sensor]) -> Sequence[str]:
    """
    Return the channels that a balance of torques takes where none are chosen.

    :param known: sensors of angles and torques, by channel.
    :return: the motors' own, or where they tell no torque those of the shafts.
    """
    motors = [name for name in known if name.startswith('actuator/')]
    if any(known[name].kind == 'motor_torque' for name in motors):
        return motors
    shafts = [name for name, s in known.items() if s.kind == 'loop_torque']
    turned = {known[name].of for name in shafts}
    return shafts + [n for n, s in known.items() if s.kind == 'angle' and s.of in turned]


def deviation(sensor: Sensor) -> float:
    """
    Return the standard deviation of one reading of a sensor.

    :param sensor: the sensor.
    :return: noise and rounding together, in the unit of the reading.
    """
    if sensor.error > 0.0:
        return sensor.error
    return UNSTATED_ANGLE if sensor.kind == 'angle' else UNSTATED_TORQUE


def doubt(sensor: Sensor) -> float:
    """
    Return how far a sensor and the model of the instrument may disagree.

    :param sensor: the sensor.
    :return: its deviation and what a diagnosis left unexplained, in the unit of the reading.
    """
    return float(np.hypot(deviation(sensor), sensor.misfit))


def angle_channel(instrument: Instrument, pulley: str) -> str:
    """
    Return the name under which a pulley's angle is measured.

    :param instrument: the instrument.
    :param pulley: its name.
    :return: the channel: actuator for driven pulleys, pulley for the others.
    """
    group = 'actuator' if pulley in instrument.driven else 'pulley'
    return channel_name(group, f'pulley_{pulley}', 'position')


def estimated_angles(instrument: Instrument, angle: FloatArray) -> dict[str, float]:
    """
    Return the angles of all inner pulleys under the names of the estimate.

    :param instrument: the instrument.
    :param angle: of all pulleys [rad], shape (n,).
    :return: values by channel.
    """
    return {
        channel_name('estimate', f'pulley_{name}', 'position'): float(
            angle[instrument.index(name)]
        )
        for name in instrument.inner
    }
