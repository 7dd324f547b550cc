"""Torques that drive the model and are logged more seldom than a controller sets them."""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import drives
from tendon_ros.identify.torque import holds, seldom
from tendon_ros.model.instrument import Instrument


def lines(recordings: Sequence[Recording], instrument: Instrument) -> dict[str, float]:
    """
    Return the torques that would be taken for a line from sample to sample, seldom as they are.

    :param recordings: of one rig.
    :param instrument: its file.
    :return: the longest time between samples [s] by the sensor's name.
    """
    found: dict[str, float] = {}
    for sensor in (d.sensor for d in drives(instrument) if d.by_torque):
        for recording in recordings:
            if sensor.channel not in recording:
                continue
            channel = recording[sensor.channel]
            if seldom(channel) and not holds(channel, instrument.control_period):
                found[sensor.name] = max(found.get(sensor.name, 0.0), channel.sampling)
    return found
