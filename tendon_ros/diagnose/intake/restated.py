"""Sensors as recordings have them, where that is not what their instrument file says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tendon_ros.model.instrument import Instrument, Sensor


def restated(
    instrument: Instrument, other: Callable[[Sensor], tuple[Sensor, str] | None]
) -> tuple[Instrument, tuple[str, ...]]:
    """
    Return an instrument with some of its sensors stated anew.

    :param instrument: its file.
    :param other: of a sensor what it is in truth, and a sentence on that; None where the file has
        it right.
    :return: the instrument, and the sentences.
    """
    found = [(sensor, other(sensor)) for sensor in instrument.sensors]
    sensors = tuple(said[0] if said else sensor for sensor, said in found)
    return replace(instrument, sensors=sensors), tuple(said[1] for _, said in found if said)
