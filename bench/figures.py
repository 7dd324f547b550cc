"""The figure of the friction measurements of the bench."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure


def friction_figure(
    smoothed: Sequence[Mapping[str, float]],
    presliding: Sequence[Mapping[str, float]],
    path: Path,
) -> None:
    """
    Draw the error of smoothed and of pre-sliding friction against rigid sticking.

    :param smoothed: rows with ``eps`` [rad/s], ``error`` and ``drift`` [rad].
    :param presliding: rows with ``angle`` [rad], ``error`` and ``drift`` [rad].
    :param path: of the PNG to write.
    """
    figure = Figure(figsize=(8.0, 3.4), layout='constrained')
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, rows, key, label in (
        (left, smoothed, 'eps', 'speed over which it is smoothed [rad/s]'),
        (right, presliding, 'angle', 'angle over which it builds up [rad]'),
    ):
        shown = [row for row in rows if row[key] > 0.0]
        x = [row[key] for row in shown]
        axes.loglog(x, [row['error'] for row in shown], 'o-', label='largest error')
        axes.loglog(x, [row['drift'] for row in shown], 's--', label='drift while stuck')
        axes.set_xlabel(label)
        axes.grid(visible=True, which='both', alpha=0.3)
    left.set_ylabel('angle [rad]')
    left.set_title('smoothed friction')
    right.set_title('pre-sliding friction')
    left.legend()
    figure.savefig(path, dpi=130)
