"""Which torques must balance on a network, and what each measured torque is compared with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import InstrumentError
from tendon_ros.estimate.channels import OperatingForce
from tendon_ros.model.instrument import Instrument, Sensor
from tendon_ros.model.statics import Balance

FloatArray = NDArray[np.float64]

#: balance of a pulley that no torque sensor sees: how exactly it must hold [N m]
BALANCE = 1e-5


class Equations:
    """
    The paper's (1)-(6) without inertia, on every pulley whose torques are known.

    ``on_pulleys``: shape (rows, pulleys), which pulley's torques each row adds up; ``doubt``: how
    exactly each row must hold [N m], shape (rows,); ``by_force``: slopes by the operating force
    and by a friction in each row, shape (rows, 1 + rows).

    :param instrument: the network.
    :param operating: the operating force.
    :param torques: sensors of torques, each with how far what it measures is uncertain [N m].
    :param free: pulleys whose angle no channel tells.
    :raises InstrumentError: where there are fewer equations than unknowns.
    """

    def __init__(
        self,
        instrument: Instrument,
        operating: OperatingForce,
        torques: Sequence[tuple[Sensor, float]],
        free: Sequence[int],
    ) -> None:
        motors = {m.name: instrument.index(m.pulley) for m in instrument.motors}
        pulleys = range(len(instrument.pulleys))
        # what a motor gives that nobody measures is not known: nothing need balance there
        balanced = [i for i in pulleys if i not in motors.values()]
        links = [row.name for row in instrument.links]
        count = len(balanced) + len(torques)
        self._operating = operating
        self._routing = instrument.routing()
        self._first = len(balanced)  # row of a sensor
        self._on_loops = np.zeros((count, len(links)))
        self._reading_sign = np.ones(len(torques))
        self.on_pulleys = np.zeros((count, len(pulleys)))
        self.on_pulleys[np.arange(len(balanced)), balanced] = 1.0
        self.doubt = np.full(count, BALANCE)
        for n, (sensor, doubt) in enumerate(torques):
            row = self._first + n
            self.doubt[row] = doubt
            if sensor.kind == 'motor_torque':  # what the motor gives balances all the rest
                self.on_pulleys[row, motors[sensor.of]] = 1.0
            else:  # the sensor reads the torque that the loop or coupling puts on the pulley
                k = links.index(sensor.through)
                self._on_loops[row, k] = -self._routing[k, instrument.index(sensor.of)]
                self._reading_sign[n] = -1.0
        lever = self.on_pulleys @ operating.torque
        self.by_force = np.column_stack([lever, np.eye(count)])
        unknowns = len(free) + 1
        if count < unknowns:
            raise InstrumentError(
                f'{instrument.name}: {unknowns} unknowns (inner angles and the force) but only '
                f'{count} balances and torques; add a torque or angle channel'
            )

    def left(
        self,
        balance: Balance,
        pace: float,
        force: float,
        friction: Sequence[float],
        read: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """
        Return what does not balance, and its slopes by all angles.

        :param balance: torques at some angles and velocities.
        :param pace: how velocities change with angles [1/s].
        :param force: the operating force [N or N m].
        :param friction: in each row beside the model's [N m].
        :param read: torques that were measured [N m], shape (torques,).
        :return: [N m] and [N m/rad], shapes (rows,) and (rows, pulleys).
        """
        stiffness = balance.stiffness + pace * balance.damping
        torque = balance.torque + self._operating.torque * force
        # every row is linear in the torques on pulleys and the forces of loops
        by_angle = -self.on_pulleys @ stiffness
        by_angle += self._on_loops @ (balance.loop_stiffness[:, None] * self._routing)
        residual = self.on_pulleys @ torque + self._on_loops @ balance.loop_force + friction
        residual[self._first :] += self._reading_sign * read
        return residual, by_angle
