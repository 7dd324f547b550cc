"""Torques that drive the model and are logged more seldom than a controller sets them."""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.base.errors import listed
from tendon_ros.base.recording import Recording
from tendon_ros.identify.driving import drives
from tendon_ros.identify.segment import holds, seldom
from tendon_ros.model.instrument import Instrument


def line_words(recordings: Sequence[Recording], instrument: Instrument) -> list[str]:
    """
    Say which torques are taken for a line from sample to sample though they may be held.

    :param recordings: of one rig.
    :param instrument: its file.
    :return: a sentence; none where none is.
    """
    tick = instrument.control_period
    driving = [d.sensor for d in drives(instrument) if d.by_torque]
    lines = [
        (s.name, r[s.channel].sampling)
        for s in driving
        for r in recordings
        if s.channel in r and seldom(r[s.channel]) and not holds(r[s.channel], tick)
    ]
    if not lines:
        return []
    rate = 1.0 / max(sampling for _, sampling in lines)
    return [
        f'{listed(dict.fromkeys(name for name, _ in lines))}: {rate:.3g} readings a second of a '
        f'controller that ticks {1.0 / tick:.4g} times: taken for a line from one to the next; if '
        'a reading is what was set until the next, such as a voltage, say so in the instrument '
        f'file: control: {{rate: {rate:.3g} Hz}}'
    ]
