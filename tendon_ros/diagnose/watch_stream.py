"""What was measured lately, channel by channel, checked as it comes."""

from __future__ import annotations

from collections import deque
import math
from threading import Lock

import numpy as np

from tendon_ros.bags.stamps import to_seconds
from tendon_ros.base.errors import listed, RecordingError
from tendon_ros.base.recording import Channel, Recording
from tendon_ros.estimate.observer import Measurement
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument

#: so long without a motor's position, and nobody knows how the instrument came to where it is [s]
HOLE = 0.1


class StampError(RecordingError):
    """A stamp that does not come after the last one of its channel."""


class Streams:
    """
    Keeps the last seconds of every channel that an instrument measures; of use to many threads.

    :param instrument: whose sensors they are.
    :param span: how much is kept [s].
    """

    def __init__(self, instrument: Instrument, span: float) -> None:
        self._instrument = instrument.name
        self._known = frozenset(s.channel for s in instrument.sensors)
        self._joints = frozenset(f'pulley_{p.name}' for p in instrument.pulleys)
        self._motors = motor_channels(instrument)
        self._span_ns = round(span * 1e9)
        self._lock = Lock()
        self._kept: dict[str, deque[tuple[int, float]]] = {}
        self._layouts: dict[tuple[str, ...], tuple[str, ...]] = {}
        #: joints that were heard of, but that the instrument does not have
        self.strangers: frozenset[str] = frozenset()

    def add(self, measurement: Measurement) -> None:
        """
        Take in what one topic says of one instant; what the instrument does not measure is left.

        :param measurement: its stamp lies after that of the last one with the same channels.
        :raises StampError: on a stamp that steps back: all is then left out.
        :raises RecordingError: on a value that is not finite, which is left out alone; where
            nothing belongs to the instrument: all is then left out.
        """
        named = self._own(tuple(measurement.values))
        names = [n for n in named if math.isfinite(measurement.values[n])]
        for name in names:
            last = self.newest(name)
            if last is not None and measurement.stamp_ns <= last:
                raise StampError(
                    f'{name}: stamp {measurement.stamp_ns} ns lies '
                    f'{(last - measurement.stamp_ns) * 1e-9:.6f} s before the last one; the '
                    'measurement is left out'
                )
        oldest = measurement.stamp_ns - self._span_ns
        with self._lock:
            for name in names:
                kept = self._kept.setdefault(name, deque())
                kept.append((measurement.stamp_ns, measurement.values[name]))
                while kept[0][0] < oldest:
                    kept.popleft()
        for name in named:
            if name not in names:
                raise RecordingError(f'{name} is {measurement.values[name]}; it is left out')

    def _own(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return those channels that the instrument measures; messages are alike, so once."""
        if names not in self._layouts:
            strange = {n.split('/')[1] for n in names if n.count('/') == 2} - self._joints
            own = tuple(n for n in names if n in self._known)
            if strange and not own:
                raise RecordingError(
                    f'joints {listed(strange)}: {self._instrument} has {listed(self._joints)}; '
                    'rename them, or give the file of this instrument'
                )
            self.strangers |= strange
            self._layouts[names] = own
        return self._layouts[names]

    def newest(self, channel: str) -> int | None:
        """
        Return the last stamp of a channel.

        :param channel: its name.
        :return: [ns], None where it was never measured.
        """
        kept = self._kept.get(channel)
        return kept[-1][0] if kept else None

    @property
    def silent_motors(self) -> tuple[str, ...]:
        """The channels that drive the model and were never measured."""
        return tuple(name for name in self._motors if not self._kept.get(name))

    @property
    def now_ns(self) -> int | None:
        """The last stamp at which all motors are known [ns]; None before."""
        newest = [self.newest(name) for name in self._motors]
        known = [stamp for stamp in newest if stamp is not None]
        return min(known) if len(known) == len(newest) else None

    @property
    def heard(self) -> tuple[str, ...]:
        """The channels that were ever measured."""
        return tuple(self._kept)

    def window(self, start_ns: int, end_ns: int) -> Recording:
        """
        Return what was measured in a window, after the last hole in the motors' positions.

        :param start_ns: its start [ns].
        :param end_ns: its end [ns].
        :return: a recording whose time counts from the window's start; channels that were silent
            are absent.
        """
        with self._lock:
            rows = {name: list(kept) for name, kept in self._kept.items()}
        channels = {}
        for name, row in rows.items():
            stamp = np.array([stamp for stamp, _ in row], dtype=np.int64)
            inside = (stamp >= start_ns) & (stamp < end_ns)
            if inside.sum() > 1:
                value = np.array([value for _, value in row])[inside]
                channels[name] = Channel(name, to_seconds(stamp[inside], start_ns), value)
        begin = max(
            (_after_holes(channels[n]) for n in self._motors if n in channels), default=0.0
        )
        if begin > 0.0:
            cut = {n: (c.time >= begin, c) for n, c in channels.items()}
            channels = {
                n: Channel(n, c.time[late], c.value[late])
                for n, (late, c) in cut.items()
                if late.sum() > 1
            }
        return Recording('window', channels, epoch_ns=start_ns)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._kept = {}
            self._layouts = {}
        self.strangers = frozenset()


def _after_holes(channel: Channel) -> float:
    """Return the time after the last hole; zero where there is none."""
    sampling = channel.sampling
    holes = np.flatnonzero(np.diff(channel.time) > max(HOLE, 5.0 * sampling))
    return float(channel.time[holes[-1] + 1]) if holes.size else 0.0
