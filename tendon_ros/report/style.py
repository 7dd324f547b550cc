"""
How figures look: one size, colours that colour-blind eyes tell apart, lines labelled directly.

Figures are as wide as a phone's screen, so that their text is readable there without zooming; a
page may show them half as large again. Colours are those of Okabe and Ito.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from io import BytesIO
from types import MappingProxyType
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
import numpy as np

INK, FAINT, PAPER = '#22262b', '#8a9099', '#ffffff'
BLUE, SKY, ORANGE, RED, GREEN, PURPLE = (
    '#0072B2', '#56B4E9', '#E69F00', '#D55E00', '#009E73', '#CC79A7',
)  # fmt: skip

#: the paper rig's pulleys, the same in every figure
PULLEYS: Mapping[str, str] = MappingProxyType(
    {'M': BLUE, 'L': SKY, '1': ORANGE, '2': RED, '3': GREEN}
)

WIDTH = 5.2  # [in], 374 points: a phone's screen
RESOLUTION = 180  # dots per inch

#: what matplotlib draws with, for paper
RC: Any = MappingProxyType(
    {
        'font.size': 11.0,
        'axes.titlesize': 11.0,
        'axes.titlelocation': 'left',
        'axes.titleweight': 'bold',
        'axes.labelsize': 10.5,
        'axes.edgecolor': FAINT,
        'axes.labelcolor': INK,
        'axes.titlecolor': INK,
        'axes.spines.top': False,
        'axes.spines.right': False,
        'axes.grid': True,
        'grid.color': '#e3e6ea',
        'grid.linewidth': 0.8,
        'axes.axisbelow': True,
        'xtick.color': INK,
        'ytick.color': INK,
        'xtick.labelsize': 10.0,
        'ytick.labelsize': 10.0,
        'text.color': INK,
        'lines.linewidth': 2.0,
        'lines.solid_capstyle': 'round',
        'figure.facecolor': PAPER,
        'savefig.facecolor': PAPER,
    }
)


def picture[**P](draw: Callable[P, Figure]) -> Callable[P, bytes]:
    """
    Make a function that draws a figure return it as PNG, in the house's style.

    :param draw: returns the figure.
    :return: the same, returning the bytes of a PNG file that depend on nothing but the figure.
    """

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> bytes:
        with rc_context(RC):
            buffer = BytesIO()
            draw(*args, **kwargs).savefig(
                buffer, format='png', dpi=RESOLUTION, metadata={'Software': None}
            )
        return buffer.getvalue()

    return drawn


def panels(*heights: float, share_x: bool = False) -> tuple[Figure, tuple[Axes, ...]]:
    """
    Return a figure with panels below each other.

    :param heights: of the panels [in].
    :param share_x: whether they have one axis of abscissas, labelled at the lowest.
    :return: the figure and its panels.
    """
    figure = Figure(figsize=(WIDTH, sum(heights)), layout='constrained')
    axes = figure.subplots(
        len(heights), 1, squeeze=False, sharex=share_x, height_ratios=list(heights)
    )
    return figure, tuple(axes[:, 0])


def dark(colour: str) -> str:
    """
    Return a colour dark enough for text on a light ground.

    :param colour: any colour.
    :return: the same hue as ``#rrggbb``.
    """
    red, green, blue = (round(255 * 0.68 * part) for part in to_rgb(colour))
    return f'#{red:02x}{green:02x}{blue:02x}'


def label_ends(axes: Axes, labels: Sequence[tuple[float, str, str]]) -> None:
    """
    Write labels beside the right end of lines, moved apart where they would overlap.

    :param axes: limits are final.
    :param labels: ordinate where the line ends, text, colour.
    """
    size = 10.0
    figure = axes.get_figure(root=True)
    assert figure is not None
    height = axes.get_position().height * figure.get_size_inches()[1] * 72.0
    gap = 1.25 * size / height
    order = sorted(labels)
    x = axes.get_xlim()[1]
    ends = axes.transData.transform([(x, y) for y, _, _ in order])
    place = axes.transAxes.inverted().transform(ends)[:, 1].tolist()
    # those that overlap are spread evenly about their middle, again until none does
    groups = [[k] for k in range(len(order))]
    while True:
        middles = [float(np.mean([place[k] for k in group])) for group in groups]
        for a in range(len(groups) - 1):
            reach = 0.5 * gap * (len(groups[a]) + len(groups[a + 1]))
            if middles[a + 1] - middles[a] < reach - 1e-9:
                groups[a : a + 2] = [groups[a] + groups[a + 1]]
                break
        else:
            break
    for group, middle in zip(groups, middles, strict=True):
        for n, k in enumerate(group):
            _, text, colour = order[k]
            axes.annotate(
                text,
                (1.02, middle + gap * (n - 0.5 * (len(group) - 1))),
                xycoords='axes fraction',
                va='center',
                color=dark(colour),
                fontsize=size,
                annotation_clip=False,
            )


def level(axes: Axes, value: float, text: str, *, at: float = 0.99, below: bool = False) -> None:
    """
    Draw a level that something is compared with, and say what it is.

    :param axes: where.
    :param value: the level.
    :param text: what it is.
    :param at: where the text ends, as a part of the width.
    :param below: whether the text stands below the line.
    """
    axes.axhline(value, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    axes.annotate(
        text,
        (at, value),
        xycoords=('axes fraction', 'data'),
        xytext=(0, -3 if below else 2),
        textcoords='offset points',
        ha='right',
        va='top' if below else 'bottom',
        fontsize=9.5,
        color='#5a616b',
    )
