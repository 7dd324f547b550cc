"""From simulated rows to the recording that the same run of a real rig would have given."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Channel, channel_name, Recording
from tendon_ros.model.rows import Rows

FloatArray = NDArray[np.float64]


def channel_values(rows: Rows, setpoints: FloatArray | None = None) -> Mapping[str, FloatArray]:
    """
    Return every channel that a simulator publishes, by name, as one value for each row.

    What a sensor measures is its reading; inner pulleys and contacts without a sensor are given as
    they truly are, which is what makes a simulator worth having.

    :param rows: simulated rows.
    :param setpoints: positions commanded to the motors at the rows [rad], shape (rows, motors).
    :return: channel values, shape (rows,) each.
    """
    one = rows.instrument
    out: dict[str, FloatArray] = {}
    for j, motor in enumerate(one.motors):
        joint = f'pulley_{motor.pulley}'
        out[channel_name('actuator', joint, 'position')] = rows.angle[:, one.index(motor.pulley)]
        out[channel_name('actuator', joint, 'effort')] = rows.effort[:, j]
        if setpoints is not None:
            out[channel_name('setpoint', joint, 'position')] = setpoints[:, j]
    for name in one.inner:
        joint = f'pulley_{name}'
        out[channel_name('pulley', joint, 'position')] = rows.angle[:, one.index(name)]
        out[channel_name('pulley', joint, 'velocity')] = rows.velocity[:, one.index(name)]
    if one.contacts and not any(s.channel.startswith('load_cell/') for s in one.sensors):
        out['load_cell/force'] = rows.contact_force[:, 0]
    for q, sensor in enumerate(one.sensors):
        out[sensor.channel] = rows.reading[:, q]
    return out


def recording_of(
    rows: Rows,
    setpoints: FloatArray | None = None,
    *,
    name: str,
    epoch_ns: int = 0,
    metadata: Mapping[str, str] | None = None,
) -> Recording:
    """
    Return simulated rows as a recording.

    :param rows: simulated rows.
    :param setpoints: positions commanded at the rows [rad], shape (rows, motors).
    :param name: of the recording.
    :param epoch_ns: header stamp of time zero [ns].
    :param metadata: text to keep with it.
    :return: the recording; it says that it is simulated.
    """
    channels = {
        key: Channel(key, rows.time, values)
        for key, values in channel_values(rows, setpoints).items()
    }
    notes = {'origin': 'simulated by tendon_ros', 'instrument': rows.instrument.name}
    return Recording(name, channels, epoch_ns, {**notes, **(metadata or {})})
