"""
What readings truly are: gains, zeros and torque constants that the instrument file knows of.

A diagnosis may find that a motor gives 1.3 times the torque that it reports, or that a torque
sensor has another zero. Observers compare what is there, not what is read.
"""

from __future__ import annotations

from collections.abc import Mapping

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.layout import arrays_of


class Readings:
    """
    Turns readings into what was there: ``truth = slope * reading + start``, by channel.

    Delays stay, since nobody knows what will be read, and so does a lost sign.

    :param instrument: the network, with its effects.
    """

    def __init__(self, instrument: Instrument) -> None:
        numbers = arrays_of(instrument).numbers
        motors = list(instrument.motor_names)
        self._line: dict[str, tuple[float, float]] = {}
        for q, sensor in enumerate(instrument.sensors):
            slope = 1.0 / float(numbers['sensor_gain'][q])
            start = -slope * float(numbers['sensor_offset'][q])
            if sensor.kind == 'motor_torque':
                j = motors.index(sensor.of)
                gain = float(numbers['motor_gain'][j])
                slope, start = gain * slope, gain * start + float(numbers['motor_bias'][j])
            self._line[sensor.channel] = slope, start

    def truth(self, values: Mapping[str, float]) -> dict[str, float]:
        """
        Return what was there.

        :param values: readings by channel, SI units.
        :return: the same channels; those that no sensor of the instrument has stay as they are.
        """
        found = {}
        for name, value in values.items():
            slope, start = self._line.get(name, (1.0, 0.0))
            found[name] = slope * value + start
        return found

    def slope(self, channel: str) -> float:
        """
        Return how much more there is of what a reading changes by.

        :param channel: of a sensor.
        :return: the size of the factor: what a deviation of the reading is multiplied with.
        """
        return abs(self._line[channel][0])
