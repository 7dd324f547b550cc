"""
Recordings: what was measured, as plain arrays.

A :class:`Recording` is the one form in which measured or simulated signals travel through the
package. It knows nothing of bags or of ROS; ``tendon_ros.bags`` converts. Channels keep their own
stamps, because real channels are not synchronised; a channel that was not measured is absent.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed, RecordingError

FloatArray = NDArray[np.float64]

#: unit of each field that a channel name can end in
FIELD_UNITS: Mapping[str, str] = MappingProxyType(
    {
        'position': 'rad',
        'velocity': 'rad/s',
        'effort': 'N m',
        'force': 'N',
        'torque': 'N m',
        'force_std': 'N',
        'torque_std': 'N m',
    }
)


def channel_name(group: str, joint: str, quantity: str) -> str:
    """
    Return the name of a channel, for instance ``actuator/pulley_M/effort``.

    :param group: ``actuator``, ``setpoint``, ``pulley``, ``load_cell`` or ``estimate``.
    :param joint: the joint's name, empty for a wrench.
    :param quantity: a key of :data:`FIELD_UNITS`.
    :return: the parts joined by slashes.
    """
    return '/'.join(part for part in (group, joint, quantity) if part)


def unit_of(channel: str) -> str:
    """
    Return the SI unit of a channel.

    :param channel: its name, which ends in a key of :data:`FIELD_UNITS`.
    :return: for instance ``rad/s``.
    """
    return FIELD_UNITS[channel.rsplit('/', 1)[-1]]


@dataclass(frozen=True)
class Channel:
    """
    One measured signal.

    ``time`` [s], shape (n,), strictly increasing, counted from the recording's epoch;
    ``value`` in ``unit``, shape (n,). Both are made read-only. NaN is refused: a sample that was
    not measured is left out.

    :raises RecordingError: on unequal lengths, NaN, or stamps that do not increase.
    """

    name: str
    time: FloatArray
    value: FloatArray
    unit: str = ''

    def __post_init__(self) -> None:
        time = np.array(self.time, dtype=np.float64)
        value = np.array(self.value, dtype=np.float64)
        if time.ndim != 1 or time.shape != value.shape:
            raise RecordingError(
                f'{self.name}: {time.shape} stamps for {value.shape} values; '
                'give one stamp for each value'
            )
        bad = np.flatnonzero(~(np.isfinite(time) & np.isfinite(value)))
        if bad.size:
            raise RecordingError(
                f'{self.name}: sample {bad[0]} is not a finite number; leave out what was not '
                'measured'
            )
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if back.size:
            raise RecordingError(
                f'{self.name}: the stamp of sample {back[0] + 1} ({time[back[0] + 1]:.6f} s) does '
                f'not come after the one before ({time[back[0]]:.6f} s); sort or drop it'
            )
        time.flags.writeable = False
        value.flags.writeable = False
        object.__setattr__(self, 'time', time)
        object.__setattr__(self, 'value', value)
        if not self.unit:
            quantity = self.name.rsplit('/', 1)[-1]
            object.__setattr__(self, 'unit', FIELD_UNITS.get(quantity, ''))

    def __reduce__(self) -> tuple[object, ...]:
        # else arrays could be written to where they arrive
        return Channel, (self.name, self.time, self.value, self.unit)

    @property
    def sampling(self) -> float:
        """The usual spacing of stamps [s], of two samples and more."""
        return float(np.median(np.diff(self.time)))

    def at(self, time: FloatArray) -> FloatArray:
        """
        Return the values at other times, linearly interpolated, ends held.

        :param time: [s], shape (k,).
        :return: shape (k,), in the channel's unit.
        """
        return np.interp(time, self.time, self.value)

    def between(self, low: float, high: float) -> Channel:
        """
        Return what was read from one time to another; of a set-point also what held at first.

        :param low: [s].
        :param high: [s], with it.
        :return: the channel with these samples, perhaps none.
        """
        first = int(np.searchsorted(self.time, low))
        last = int(np.searchsorted(self.time, high, side='right'))
        time, value = self.time[first:last], self.value[first:last]
        held = self.name.startswith('setpoint/') and first > 0
        if held and not (time.size and time[0] == low):
            time, value = np.append(low, time), np.append(self.value[first - 1], value)
        return replace(self, time=time, value=value)


@dataclass(frozen=True)
class Recording:
    """
    Channels that were recorded together.

    ``epoch_ns`` is the header stamp [ns] of time zero. ``metadata`` holds text (parameters, seed,
    versions, sign convention). ``warnings`` are sentences on what reading had to leave out.
    """

    name: str
    channels: Mapping[str, Channel]
    epoch_ns: int = 0
    metadata: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, 'channels', MappingProxyType(dict(self.channels)))
        object.__setattr__(self, 'metadata', MappingProxyType(dict(self.metadata)))

    def __reduce__(self) -> tuple[object, ...]:
        # a view of a dictionary does not travel to other processes
        own = self.name, dict(self.channels), self.epoch_ns, dict(self.metadata), self.warnings
        return Recording, own

    def __getitem__(self, name: str) -> Channel:
        try:
            return self.channels[name]
        except KeyError:
            raise RecordingError(
                f'{self.name}: no channel {name!r}; it has {listed(self.channels)}'
            ) from None

    def __contains__(self, name: str) -> bool:
        return name in self.channels

    @property
    def start(self) -> float:
        """The first stamp of any channel [s]."""
        return min((float(c.time[0]) for c in self.channels.values() if c.time.size), default=0.0)

    @property
    def end(self) -> float:
        """The last stamp of any channel [s]."""
        return max((float(c.time[-1]) for c in self.channels.values() if c.time.size), default=0.0)

    def with_channels(self, channels: Iterable[Channel]) -> Recording:
        """
        Return a copy in which the channels given are added or replaced.

        :param channels: the channels to add.
        :return: a new recording; this one is unchanged.
        """
        return replace(self, channels={**self.channels, **{c.name: c for c in channels}})
