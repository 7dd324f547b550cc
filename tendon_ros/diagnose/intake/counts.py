"""
Counts of encoders as a recording has them: coarser, where a log was rounded, than the file says.

Counts are noise, and noise that is taken for a tenth of what it is makes a gap of nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.quantity import written
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.restated import restated
from tendon_ros.diagnose.intake.units import factor_name
from tendon_ros.model.instrument import Instrument, Sensor

FloatArray = NDArray[np.float64]

#: times what the file says that steps are coarser at least, to be said
COARSER = 1.5
#: readings, a few steps from their neighbours, that tell a step
ENOUGH, FEW = 25, 10.0
#: part of a step that these are off a whole number of them, by the digits of a log
OFF = 0.05


def as_counted(
    recordings: Sequence[Recording], instrument: Instrument
) -> tuple[Instrument, tuple[str, ...]]:
    """
    Return an instrument whose encoders count as coarsely as they do in recordings.

    :param recordings: of it.
    :param instrument: its file.
    :return: the instrument, and a sentence on each encoder that counts more coarsely.
    """

    def coarser(sensor: Sensor) -> tuple[Sensor, str] | None:
        step = _step_of(sensor, recordings)
        if not step > COARSER * sensor.resolution:
            return None
        unit = factor_name(step / sensor.resolution, sensor.kind)
        return replace(sensor, resolution=step), (
            f'{sensor.name}: its readings come in steps of {written(step, "rad")}, more '
            f'coarsely than the {written(sensor.resolution, "rad")} of the instrument file'
            f'{f", as if {unit}" if unit else ""}; what the recordings say is taken (log more '
            'digits, or correct the encoder or the unit)'
        )

    return restated(instrument, coarser)


def _step_of(sensor: Sensor, recordings: Iterable[Recording]) -> float:
    """Return the step of which all readings of an encoder are multiples [rad]; 0 for none."""
    if sensor.kind != 'angle' or sensor.resolution <= 0.0:
        return 0.0
    steps = [
        step_of(r[sensor.channel].value, 0.1 * sensor.resolution)
        for r in recordings
        if sensor.channel in r
    ]
    # one that hardly moved tells nothing, and one that is finer tells that the encoder is
    return min([step for step in steps if step is not None], default=0.0)


def step_of(readings: FloatArray, least: float) -> float | None:
    """
    Return the step of which readings are multiples.

    :param readings: any numbers.
    :param least: what is smaller is a matter of rounding.
    :return: the step, 0 where there is none; None where too few readings differ.
    """
    values = np.unique(readings[np.isfinite(readings)])
    apart = np.diff(values)
    apart = apart[apart > least]
    step = float(f'{apart.min(initial=np.inf):.6g}')
    whole = apart[apart < FEW * step] / step
    if len(whole) < ENOUGH:
        return None
    return step if np.all(np.abs(whole - np.round(whole)) < OFF) else 0.0
