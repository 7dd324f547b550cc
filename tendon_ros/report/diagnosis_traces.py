"""The traces that a diagnosis rests on: which to look at, and a picture of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np

from tendon_ros.diagnose.evidence import FloatArray, Trace
from tendon_ros.report.diagnosis_words import channel_words, scale
from tendon_ros.report.themes import Theme, themed

_SIZE = (4.6, 6.6)  # [in], as wide as a phone's screen
#: left, bottom, width, height; fixed, since to lay a figure out takes longer than to draw it
_PLACES = ((0.17, 0.655, 0.80, 0.250), (0.17, 0.425, 0.80, 0.175), (0.17, 0.073, 0.80, 0.245))
_CLOSER = 0.1  # part of the duration that the closer look shows


def rmse(trace: Trace) -> tuple[float, float]:
    """Return the RMSE before and after, in the trace's unit, where no fit has seen the data."""
    judged = trace.held_out if trace.held_out.any() else np.ones_like(trace.held_out)
    before, after = (
        float(np.sqrt(np.nanmean(np.square(trace.measured - model)[judged])))
        for model in (trace.before, trace.after)
    )
    return before, after


def telling(traces: Sequence[Trace], floors: Mapping[str, float], most: int) -> tuple[Trace, ...]:
    """
    Choose the traces that show most: of each channel the worst, then the worst of all.

    :param traces: all there are.
    :param floors: noise floor by channel.
    :param most: how many to choose.
    :return: at most ``most``, the worst gap against its noise first.
    """

    def gap(trace: Trace) -> float:
        return rmse(trace)[0] / floors.get(trace.channel, 1.0)

    order = sorted((t for t in traces if t.time.size > 1), key=gap, reverse=True)
    first = {t.channel: t for t in reversed(order)}.values()
    rest = [t for t in order if all(t is not f for f in first)]
    chosen = [*sorted(first, key=gap, reverse=True), *rest][:most]
    return tuple(sorted(chosen, key=gap, reverse=True))


@themed
def trace_figure(theme: Theme, trace: Trace, floor: float | None) -> Figure:
    """
    Draw a channel as measured and as predicted before and after, what remains, and a closer look.

    :param theme: the colours.
    :param trace: of one recording.
    :param floor: the channel's noise floor in the trace's unit, where it is known.
    :return: the figure.
    """
    figure = Figure(figsize=_SIZE)
    whole, rest, closer = (figure.add_axes(place) for place in _PLACES)
    rest.sharex(whole)
    time = trace.time - trace.time[0]
    factor, unit = scale(trace.unit, float(np.nanmax(np.abs(trace.measured))))
    for axes in (whole, closer):
        _lines(axes, theme, time, trace, factor)
        axes.set_ylabel(f'[{unit}]')
    whole.set_title(_channel(trace))
    whole.tick_params(labelbottom=False)
    handles, labels = whole.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc='upper left',
        ncols=3,
        frameon=False,
        handlelength=1.1,
        columnspacing=1.2,
        labelcolor=theme.ink,
        fontsize=10,
    )
    before, after = trace.measured - trace.before, trace.measured - trace.after
    small, small_unit = scale(trace.unit, float(np.nanmax(np.abs(before))))
    if floor is not None:
        for side in (-1.0, 1.0):
            y = side * small * floor
            rest.axhline(y, color=theme.ink, linewidth=1.0, linestyle='--', zorder=4)
    rest.plot(time, small * before, color=theme.before, linewidth=1.0)
    rest.plot(time, small * after, color=theme.after, linewidth=1.0)
    rest.set_title('Measured minus model' + ('; dashed: noise floor' if floor is not None else ''))
    rest.set_ylabel(f'[{small_unit}]')
    rest.set_xlabel('time [s]')
    for axes in (whole, rest):
        _held_out(axes, theme, time, trace)
    whole.set_xlim(0.0, time[-1])
    start, end = _worst_window(time, np.square(before))
    closer.set_xlim(start, end)
    shown = (time >= start) & (time <= end)
    parts = [factor * y[shown] for y in (trace.measured, trace.before, trace.after)]
    low, high = np.nanmin(parts), np.nanmax(parts)
    margin = 0.06 * (high - low) or 1.0
    closer.set_ylim(low - margin, high + margin)
    closer.set_title('Closer, where the gap is worst')
    closer.set_xlabel('time [s]')
    for axes in (whole, rest, closer):
        axes.yaxis.set_label_coords(-0.155, 0.5)
    return figure


def trace_words(trace: Trace) -> str:
    """Return what a trace is: its channel and its recording."""
    return f'{_channel(trace)}, recording {trace.recording}'


def _channel(trace: Trace) -> str:
    words = channel_words(trace.channel)
    return f'{words[:1].upper()}{words[1:]}'


def _lines(axes: Axes, theme: Theme, time: FloatArray, trace: Trace, factor: float) -> None:
    axes.plot(time, factor * trace.measured, color=theme.ink, linewidth=1.3, label='measured')
    axes.plot(time, factor * trace.before, color=theme.before, linewidth=1.6, label='file')
    # dashed, so that a model that is right does not hide what was measured
    axes.plot(
        time,
        factor * trace.after,
        color=theme.after,
        linewidth=2.0,
        linestyle=(0, (3, 2)),
        dash_capstyle='butt',
        label='with effects',
    )


def _held_out(axes: Axes, theme: Theme, time: FloatArray, trace: Trace) -> None:
    edges = np.flatnonzero(np.diff(np.concatenate(([0], trace.held_out.astype(int), [0]))))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        axes.axvspan(time[start], time[end - 1], color=theme.shade, linewidth=0, zorder=0)


def _worst_window(time: FloatArray, square: FloatArray) -> tuple[float, float]:
    width = min(max(_CLOSER * time[-1], 0.5), time[-1])
    summed = np.concatenate(([0.0], np.cumsum(np.nan_to_num(square))))
    ends = np.searchsorted(time, time + width, side='right')
    inside = time + width <= time[-1]
    sums = np.where(inside, summed[ends] - summed[:-1], -1.0)
    start = float(time[int(np.argmax(sums))]) if inside.any() else 0.0
    return start, start + width
