"""Pictures of an estimate: against the load cell, with its stated uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure
import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.report.style import (
    BLUE,
    GREEN,
    label_ends,
    ORANGE,
    panels,
    picture,
    PURPLE,
    RED,
)

#: more points than a picture can show only make it slow
MOST_POINTS = 4000

_SOME = (ORANGE, RED, GREEN, PURPLE, BLUE)


def _quantity(recording: Recording) -> tuple[str, str]:
    for quantity, unit in (('force', 'N'), ('torque', 'N m')):
        if f'estimate/{quantity}' in recording:
            return quantity, unit
    return 'force', 'N'


@picture
def estimate_figure(recording: Recording) -> Figure:
    """
    Draw an estimate against the load cell, its error, and the inner pulleys that came with it.

    :param recording: with channels ``estimate/...``; load cell and true angles where measured.
    :return: the figure.
    """
    quantity, unit = _quantity(recording)
    estimate = recording[f'estimate/{quantity}']
    sigma = recording[f'estimate/{quantity}_std']
    step = max(1, len(estimate.time) // MOST_POINTS)
    # of what is recorded live, each channel may lack other messages
    stamps, value = estimate.time[::step], estimate.value[::step]
    time = stamps - recording.start
    band = 2.0 * sigma.at(stamps)
    known = f'load_cell/{quantity}' in recording
    figure, axes = panels(*((2.6, 1.6, 2.2) if known else (2.6, 2.2)), share_x=True)
    top, low = axes[0], axes[-1]
    top.fill_between(time, value - band, value + band, color=BLUE, alpha=0.18, linewidth=0)
    top.plot(time, value, color=BLUE)
    top.set_title(f'Operating {quantity}')
    top.set_ylabel(f'{quantity} [{unit}]')
    ends = [(float(value[-1]), 'estimate', BLUE)]
    top.margins(x=0)
    if known:
        cell = recording[f'load_cell/{quantity}'].at(stamps)
        top.plot(time, cell, color=ORANGE, linewidth=1.2)
        ends.append((float(cell[-1]), 'load cell', ORANGE))
        axes[1].fill_between(time, -band, band, color=BLUE, alpha=0.18, linewidth=0)
        axes[1].plot(time, value - cell, color=BLUE, linewidth=0.8)
        axes[1].set_title('Error; shaded: two stated standard deviations')
        axes[1].set_ylabel(f'error [{unit}]')
    names = [n for n in recording.channels if n.startswith('estimate/pulley_')]
    angles = []
    for colour, name in zip(_SOME, sorted(names), strict=False):
        angle = np.rad2deg(recording[name].at(stamps))
        low.plot(time, angle, color=colour)
        pulley = name.split('/')[1]
        angles.append((float(angle[-1]), pulley.replace('_', ' '), colour))
        true = name.replace('estimate/', 'pulley/')
        if true in recording:
            measured = np.rad2deg(recording[true].at(stamps))
            low.plot(time, measured, color='black', linewidth=0.8, linestyle=(0, (2, 2)))
    low.set_title('Inner pulleys; dashed: measured, where they are')
    low.set_ylabel('angle [deg]')
    low.set_xlabel('time [s]')
    figure.draw_without_rendering()
    label_ends(top, ends)
    label_ends(low, angles)
    return figure


@picture
def scores_figure(scores: Mapping[str, float], unit: str, what: Sequence[str]) -> Figure:
    """
    Draw one bar a run.

    :param scores: RMSE by run, in ``unit``.
    :param unit: of the scores.
    :param what: title and name of the runs' axis.
    :return: the figure.
    """
    figure, (axes,) = panels(2.6)
    place = np.arange(len(scores))
    axes.bar(place, list(scores.values()), color=BLUE, width=0.8)
    every = max(1, len(scores) // 10)
    axes.set_xticks(place[::every], list(scores)[::every])
    axes.set_title(what[0])
    axes.set_xlabel(what[1])
    axes.set_ylabel(f'RMSE [{unit}]')
    return figure
