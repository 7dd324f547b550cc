"""
The user's view of the gap: the same command, run in closed loop by model and machine.

Here the controller of the file acts as well, so the gap contains what it does to errors; the
diagnosis itself does not rest on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed, TendonError
from tendon_ros.base.recording import channel_name, Recording
from tendon_ros.diagnose.evidence import Trace
from tendon_ros.diagnose.intervals import mean_square_interval
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.identify.segment import Segment
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.recorded import channel_values
from tendon_ros.model.simulation import Simulation

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ClosedLoop:
    """
    The gap in closed loop, and what it was computed from; empty without recorded commands.

    ``left_out``: why there is none of what was recorded.
    """

    gaps: tuple[ChannelGap, ...] = ()
    traces: tuple[Trace, ...] = ()
    left_out: tuple[str, ...] = ()


def closed_loop_gap(
    recordings: Sequence[Recording],
    before: Instrument,
    after: Sequence[Instrument],
    segments: Sequence[Segment],
) -> ClosedLoop:
    """
    Run the recorded commands with the file's instrument and with the patched one.

    :param recordings: those with set-points for all motors count.
    :param before: the instrument file.
    :param after: the patched one, for each recording with what happened in it.
    :param segments: which contacts were there, and the noise.
    :return: gaps by channel, most first, and the traces.
    """
    if loose := before.uncontrolled:
        commanded = any(name.startswith('setpoint/') for r in recordings for name in r.channels)
        said = f'no closed loop: the instrument file has no controller of motor {listed(loose)}'
        return ClosedLoop(left_out=(said,) if commanded else ())
    traces: list[Trace] = []
    floors: dict[str, list[FloatArray]] = {}
    without: dict[str, list[str]] = {}  # recordings by the reason why there is no closed loop
    names = [channel_name('setpoint', f'pulley_{p}', 'position') for p in before.driven]
    for recording, segment, patched in zip(recordings, segments, after, strict=True):
        runs = _both(recording, segment, (before, patched), names)
        if isinstance(runs, str):
            without.setdefault(runs, []).append(recording.name)
            continue
        first, second = runs
        for sensor in before.sensors:
            if sensor.channel not in recording or sensor.channel not in first:
                continue
            channel = recording[sensor.channel]
            inside = channel.time >= segment.start
            time = channel.time[inside] - segment.start
            grid = before.control_period * np.arange(len(first[sensor.channel]))
            own = [np.interp(time, grid, run[sensor.channel]) for run in (first, second)]
            if not sensor.zeroed:
                own = [row + np.mean(channel.value[inside] - row) for row in own]
            traces.append(
                Trace(
                    recording=recording.name,
                    channel=sensor.channel,
                    unit=channel.unit,
                    time=time,
                    measured=channel.value[inside],
                    before=own[0],
                    after=own[1],
                    held_out=np.zeros(len(time), dtype=np.bool_),
                )
            )
        for m in segment.measured:
            floors.setdefault(m.sensor.channel, []).append(m.noise**2)
    left_out = [f'{", ".join(r)}: no closed loop: {why}' for why, r in without.items() if why]
    return ClosedLoop(_gaps(traces, floors), tuple(traces), tuple(left_out))


def _both(
    recording: Recording,
    segment: Segment,
    instruments: tuple[Instrument, Instrument],
    names: Sequence[str],
) -> tuple[dict[str, FloatArray], dict[str, FloatArray]] | str:
    """
    Return every channel by the file and by the patched one, or why there is no closed loop.

    Empty where nothing was commanded.
    """
    missing = [name for name in names if name not in recording]
    if len(missing) == len(names):
        return ''
    if missing:
        return f'no {listed(missing)} was recorded'
    if segment.pushed:
        return 'the measured load pushed the model, and what pushes back is no part of it'
    runs = []
    for instrument, called in zip(
        instruments, ('the instrument file', 'the repaired file'), strict=True
    ):
        try:
            runs.append(_run(recording, segment, instrument, names))
        except TendonError as error:
            return f'{called} does not follow the command with its controllers: {error}'
    first, second = runs
    return first, second


def _run(
    recording: Recording, segment: Segment, instrument: Instrument, names: Sequence[str]
) -> dict[str, FloatArray]:
    """Return every channel along the recorded command, one value a controller period."""
    there = tuple(replace(c, enabled=c.name in segment.contacts) for c in instrument.contacts)
    one = replace(instrument, contacts=there)
    period = one.control_period
    ticks = int(segment.time[-1] / period)
    grid = segment.start + period * np.arange(ticks)
    columns = []
    for name in names:
        channel = recording[name]
        # a controller sees the latest command, not one that is still to come
        latest = np.searchsorted(channel.time, grid + 1e-9, side='right') - 1
        columns.append(channel.value[np.clip(latest, 0, len(channel.value) - 1)])
    setpoints = np.array(columns).T
    pose = dict(segment.pose)
    pose |= dict(zip(one.driven, (float(v) for v in segment.motion.value[:, 0]), strict=True))
    simulation = Simulation(one, pose=pose)
    return dict(channel_values(simulation.run(setpoints)))


def _gaps(traces: Sequence[Trace], floors: dict[str, list[FloatArray]]) -> tuple[ChannelGap, ...]:
    rows = []
    for channel in dict.fromkeys(t.channel for t in traces):
        own = [t for t in traces if t.channel == channel]
        first = np.concatenate([(t.measured - t.before) ** 2 for t in own])
        second = np.concatenate([(t.measured - t.after) ** 2 for t in own])
        blocks = [
            float(np.mean(part))
            for t in own
            for part in np.array_split((t.measured - t.after) ** 2, 10)
        ]
        floor = floors.get(channel)
        rows.append(
            ChannelGap(
                channel=channel,
                unit=own[0].unit,
                before=float(np.sqrt(first.mean())),
                after=float(np.sqrt(second.mean())),
                noise_floor=float(np.sqrt(np.mean(np.concatenate(floor)))) if floor else 0.0,
                ci95=mean_square_interval(blocks),
            )
        )
    return tuple(sorted(rows, key=lambda g: -g.before / max(g.noise_floor, 1e-12)))
