"""What an observer is: measurements in, estimates with their uncertainty out, one at a time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

from tendon_ros.base.errors import RecordingError, TendonError
from tendon_ros.estimate.channels import doubt
from tendon_ros.estimate.reach import Reach
from tendon_ros.estimate.readings import Readings
from tendon_ros.model.instrument import Instrument, Sensor

#: measurements in a row that the model cannot go on to; after more what it carries is wrong
LOST = 20


@dataclass(frozen=True)
class Measurement:
    """
    What was measured at one instant.

    ``stamp_ns``: header stamp [ns]; ``values``: by channel name, SI units; what is absent was not
    measured.
    """

    stamp_ns: int
    values: Mapping[str, float]


@dataclass(frozen=True)
class Estimate:
    """
    What is estimated at one instant.

    ``stamp_ns``: that of the measurement it comes from; ``values``: by channel name
    (``estimate/force``, ``estimate/force_std``, ``estimate/pulley_1/position``, ...), SI units.
    """

    stamp_ns: int
    values: Mapping[str, float]


class Observer(ABC):
    """
    Turns measurements into estimates, in the order of their stamps.

    Subclasses name the channels that they need, and never see a measurement that lacks one, is not
    finite, is what no motor can do, or does not come after the one before: :meth:`update` refuses
    those first. What they see is what was there, by all that the instrument's file says of its
    sensors and motors. Where they raise they leave what they carry as it was.

    :param instrument: the network.
    """

    #: channels that must be in every measurement
    needs: tuple[str, ...]

    def __init__(self, instrument: Instrument) -> None:
        self._last_ns: int | None = None
        self._readings = Readings(instrument)
        self._reach = Reach(instrument)
        self._failed = 0

    def update(self, measurement: Measurement) -> Estimate:
        """
        Take in one measurement.

        :param measurement: at a stamp after all those before.
        :return: the estimate at that stamp.
        :raises RecordingError: on a missing or non-finite value, an angle where no motor can be,
            or a stamp that steps back; the observer's state is then unchanged and the next good
            measurement is welcome.
        :raises TendonError: where the model cannot go on to what was measured; the state is then
            unchanged, too, but for the last of many in a row, after which all begins anew.
        """
        for name in self.needs:
            value = measurement.values.get(name)
            if value is None:
                raise RecordingError(f'{name}: not in the measurement; this method needs it')
            if not abs(value) < float('inf'):
                raise RecordingError(
                    f'{name}: {value} is not a finite number; the sample is left out'
                )
        if self._last_ns is not None and measurement.stamp_ns <= self._last_ns:
            raise RecordingError(
                f'stamp {measurement.stamp_ns} ns does not come after {self._last_ns} ns; the '
                'sample is left out'
            )
        gap = 0.0
        if self._last_ns is not None:
            gap = (measurement.stamp_ns - self._last_ns) * 1e-9
        true = Measurement(measurement.stamp_ns, self._readings.truth(measurement.values))
        self._reach.check(self.needs, true.values)
        try:
            estimate = self._update(true, gap)
        except TendonError:
            self._failed += 1
            if self._failed > LOST:
                self._failed = 0
                self._reset()
            raise
        self._failed = 0
        self._last_ns = measurement.stamp_ns
        return estimate

    def reset(self) -> None:
        """Forget everything: the next measurement is the first."""
        self._last_ns = None
        self._failed = 0
        self._reset()

    def _doubt(self, sensor: Sensor) -> float:
        """Return how far what a sensor measures and the model may disagree."""
        return doubt(sensor) * self._readings.slope(sensor.channel)

    @abstractmethod
    def _update(self, measurement: Measurement, gap: float) -> Estimate:
        """Return the estimate; ``gap`` [s] since the last measurement, 0 at the first."""

    @abstractmethod
    def _reset(self) -> None:
        """Forget everything."""
