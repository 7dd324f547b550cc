"""Pictures of a blind score: what was taken for what, how probabilities came true, the rest."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter
import numpy as np

from tendon_ros.blind.judge import KNOWN
from tendon_ros.blind.score import Score
from tendon_ros.blind.statistics import Bin
from tendon_ros.report.style import BLUE, FAINT, GREEN, INK, level, ORANGE, panels, picture, WIDTH

#: what stands last in the matrix, after the effects
_LAST = ('elsewhere', 'nothing', 'refused')
#: the median of the gap's rest by the floor that is aimed at
AIM = 1.15


@picture
def confusion_figure(confusion: Sequence[tuple[str, str, int]]) -> Figure:
    """
    Draw true effects against named ones, as parts of each row.

    :param confusion: true effect, named one, how often.
    :return: the figure.
    """
    counts = {(a, b): n for a, b, n in confusion}
    rows = _ordered({a for a, _, _ in confusion})
    columns = _ordered({b for _, b, _ in confusion})
    table = np.array([[counts.get((a, b), 0) for b in columns] for a in rows])
    shares = table / table.sum(axis=1, keepdims=True)
    figure = Figure(figsize=(WIDTH, 2.2 + 0.17 * len(rows)), layout='constrained')
    axes = figure.subplots()
    axes.imshow(shares, cmap='Blues', vmin=0.0, vmax=1.0, aspect='auto')
    axes.set_xticks(range(len(columns)), _plain(columns), rotation=90, fontsize=6.5)
    axes.set_yticks(range(len(rows)), _plain(rows), fontsize=6.5)
    axes.grid(visible=False)
    axes.set_xlabel('named')
    axes.set_ylabel('true')
    for i, j in np.argwhere(table):
        colour = 'white' if shares[i, j] > 0.55 else INK
        axes.text(j, i, str(table[i, j]), ha='center', va='center', fontsize=6, color=colour)
    return figure


def _ordered(names: set[str]) -> list[str]:
    """Return effects by name, then what no catalogue has, then what is no effect."""
    return sorted(names, key=lambda n: (n in _LAST, n.startswith('unknown_'), n))


def _plain(names: Sequence[str]) -> list[str]:
    return [name.replace('_', ' ') for name in names]


@picture
def calibration_figure(bins: Sequence[Bin], error: float) -> Figure:
    """
    Draw stated probabilities against what came true, with intervals, and how many there were.

    :param bins: of the reliability.
    :param error: expected calibration error.
    :return: the figure.
    """
    figure, (top, low) = panels(3.6, 1.4, share_x=True)
    stated = np.array([b.stated for b in bins])
    true = np.array([b.true.value for b in bins])
    ends = np.array([b.true.interval for b in bins]).reshape(-1, 2)
    top.plot([0.0, 1.0], [0.0, 1.0], color=FAINT, linewidth=1.0)
    around = np.abs(ends.T - true)
    top.errorbar(stated, true, yerr=around, fmt='o', color=BLUE, capsize=3, linewidth=1.4)
    top.set_title(f'Calibration error {error:.3f}')
    top.set_ylabel('part that is true')
    top.set_xlim(0.0, 1.0)
    top.set_ylim(-0.02, 1.02)
    low.bar(stated, [b.true.of for b in bins], width=0.06, color=BLUE)
    low.set_ylabel('causes')
    low.set_xlabel('stated probability')
    return figure


@picture
def shrink_figure(score: Score) -> Figure:
    """
    Draw what is left of the gap where its cause is in the catalogue, as a distribution.

    :param score: the score.
    :return: the figure.
    """
    figure, (axes,) = panels(3.2)
    colours = dict(zip(KNOWN, (BLUE, ORANGE, FAINT, GREEN), strict=True))
    for stratum in KNOWN:
        some = [j.left for j in score.judgements if j.stratum == stratum]
        left = np.sort([value for value in some if np.isfinite(value)])
        if left.size:
            part = np.arange(1, left.size + 1) / left.size
            label = stratum.replace('_', ' or ')
            axes.step(left, part, where='post', color=colours[stratum], label=label)
    axes.axvline(AIM, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)))
    level(axes, 0.5, 'median')
    axes.set_xscale('log')
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FormatStrFormatter('%g'))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel('gap after the causes, in noise floors')
    axes.set_ylabel('part of the cases')
    axes.set_ylim(0.0, 1.02)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc='lower right', frameon=False)
    return figure
