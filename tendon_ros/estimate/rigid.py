"""What a rig without stretch would do: where searches begin, and how well its torques tell."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tendon_ros.estimate.channels import OperatingForce
from tendon_ros.model.instrument import Instrument, Sensor

FloatArray = NDArray[np.float64]

#: part of what feels the force by which it turns with a sensor's pulley, below which it does not
FEELS = 1e-6


class Rigid:
    """
    Angles that leave every cable as it is.

    :param instrument: the network.
    :param free: pulleys whose angles follow from those of the others.
    """

    def __init__(self, instrument: Instrument, free: Sequence[int]) -> None:
        routing = instrument.routing()
        self._fixed = [i for i in range(routing.shape[1]) if i not in free]
        inverse = np.linalg.pinv(routing[:, list(free)])
        self._follow = -inverse @ routing[:, self._fixed]

    def free(self, angle: FloatArray) -> FloatArray:
        """
        Return the free angles.

        :param angle: [rad], shape (pulleys,); what it has for the free ones does not matter.
        :return: [rad], shape (free,).
        """
        return np.asarray(self._follow @ angle[self._fixed])


def told_if_rigid(
    instrument: Instrument, torques: Sequence[tuple[Sensor, float]], operating: OperatingForce
) -> float:
    """
    Return how well torques would tell the operating force of a rigid rig.

    Where cables go slack, or all of a torque is friction, a model tells the force better than
    that, but for a moment only.

    :param instrument: the network.
    :param torques: sensors of torques, each with how far what it measures is uncertain [N m].
    :param operating: the force.
    :return: one deviation [N or N m]; 0 where none of them feels it.
    """
    motors = {m.name: m.pulley for m in instrument.motors}
    told = []
    for sensor, doubt in torques:
        of = motors[sensor.of] if sensor.kind == 'motor_torque' else sensor.of
        pulley = instrument.index(of)
        turned = np.zeros(len(instrument.pulleys))
        turned[pulley] = 1.0
        others = [i for i in range(len(turned)) if i != pulley]
        turned[others] = Rigid(instrument, others).free(turned)
        moved = abs(float(operating.torque @ turned))
        if moved > FEELS * float(np.abs(operating.torque).max()):
            told.append(doubt / moved)
    return min(told, default=0.0)
