"""
Noise of encoders as a recording has it, where the instrument file knows of counts only.

In motion readings may scatter far beyond a count. Taken for counts, they are accelerations that
no torque has made, and a guessed inertia goes to nothing to have none of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from tendon_ros.base.quantity import written
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.restated import restated
from tendon_ros.identify.driving import encoder_channels
from tendon_ros.identify.scatter import Scatter, scatter
from tendon_ros.model.instrument import Instrument, Sensor

#: times what the file says that readings scatter at least, to be said
NOISIER = 4.0


def as_read(
    recordings: Sequence[Recording], instrument: Instrument
) -> tuple[Instrument, tuple[str, ...]]:
    """
    Return an instrument whose motors' encoders are as noisy as they are in recordings.

    :param recordings: of it.
    :param instrument: its file.
    :return: the instrument, and a sentence on each encoder that is far noisier than the file says.
    """
    driving = set(encoder_channels(instrument))

    def noisier(sensor: Sensor) -> tuple[Sensor, str] | None:
        told = _quietest(sensor, recordings) if sensor.channel in driving else None
        if told is None or not told.usual > NOISIER * sensor.error > 0.0:
            return None
        said = (
            f'{sensor.name}: in motion its readings scatter by {1e3 * told.usual:.2g} mrad, '
            f'{told.usual / sensor.error:.0f} times what the instrument file says; '
        )
        if told.usual**2 > 2.0 * told.still**2:
            return sensor, (
                f'{said}the faster the more: their stamps are taken to be off by '
                f'{written(float(f"{told.late:.2g}"), "s")} (log the time at which each was read)'
            )
        return replace(sensor, noise=told.still), (
            f'{said}that is taken for its noise (log all digits that it has, or state its noise '
            'in the file)'
        )

    return restated(instrument, noisier)


def _quietest(sensor: Sensor, recordings: Iterable[Recording]) -> Scatter | None:
    """Return how a sensor's readings scatter where they do least; None if none tells."""
    count = max(sensor.resolution, sensor.noise)
    told = [scatter(r[sensor.channel], count) for r in recordings if sensor.channel in r]
    known = [one for one in told if one is not None]
    return min(known, key=lambda one: one.usual, default=None)
