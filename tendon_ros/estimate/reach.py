"""What motors can: what reads far beyond their limits is no motion and no torque."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tendon_ros.base.errors import RecordingError
from tendon_ros.estimate.channels import sensors_of
from tendon_ros.model.instrument import Instrument


class Reach:
    """
    The motors whose angles and torques the instrument's file bounds, by channel.

    :param instrument: the network.
    """

    def __init__(self, instrument: Instrument) -> None:
        driven = {m.pulley: m for m in instrument.motors}
        motors = {m.name: m for m in instrument.motors}
        self._instrument = instrument.name
        # an angle without a zero may read anything
        self._turning = {
            name: driven[s.of]
            for name, s in sensors_of(instrument, ('angle',)).items()
            if s.of in driven and s.zeroed
        }
        self._driving = {
            name: motors[s.of] for name, s in sensors_of(instrument, ('motor_torque',)).items()
        }

    def check(self, names: Iterable[str], values: Mapping[str, float]) -> None:
        """
        Refuse angles that no motion of a motor leads to, and torques that none gives.

        :param names: the channels to look at.
        :param values: what was there, by channel.
        :raises RecordingError: where a motor is far beyond its limits.
        """
        for name in names:
            motor = self._driving.get(name)
            if motor is not None and motor.cannot_give(values[name]):
                raise RecordingError(
                    f'{name}: {values[name]:.4g} N m is far beyond the {motor.largest:.4g} N m '
                    f'that motor {motor.name} of {self._instrument} can give; see whether its '
                    'unit is N m, or correct the limit'
                )
            motor = self._turning.get(name)
            if motor is not None and motor.cannot_be(values[name]):
                low, high = motor.position_limit
                raise RecordingError(
                    f'{name}: {values[name]:.4g} rad is far beyond the position_limit {low:.4g} '
                    f'to {high:.4g} rad of motor {motor.name} in {self._instrument}; see whether '
                    'its unit is rad, or correct the limit'
                )
