"""Figures for light and for dark pages: drawn twice, the same but for the colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from io import BytesIO
from typing import Any, Concatenate

from matplotlib import rc_context
from matplotlib.figure import Figure

from tendon_ros.report.style import BLUE, INK, ORANGE, PAPER, RC, SKY

# as sharp as a phone shows it, at half the bytes of a figure for print: they come in pairs
_RESOLUTION = 140


@dataclass(frozen=True)
class Theme:
    """Colours of a figure: of text and ground, and of what is compared in it."""

    ink: str
    faint: str
    grid: str
    paper: str
    before: str
    after: str
    shade: str


LIGHT = Theme(INK, '#8a9099', '#e3e6ea', PAPER, ORANGE, BLUE, '#eef1f5')
DARK = Theme('#e6e9ed', '#8f98a3', '#2c323a', '#15181c', ORANGE, SKY, '#20262d')


def themed[**P](
    draw: Callable[Concatenate[Theme, P], Figure],
) -> Callable[P, tuple[bytes, bytes]]:
    """
    Make a function that draws a figure in a theme return it as PNG, for light and dark pages.

    :param draw: gets the theme, returns the figure.
    :return: the same without the theme, returning the bytes of two PNG files.
    """

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> tuple[bytes, bytes]:
        light, dark = (_png(theme, draw, *args, **kwargs) for theme in (LIGHT, DARK))
        return light, dark

    return drawn


def _png[**P](
    theme: Theme,
    draw: Callable[Concatenate[Theme, P], Figure],
    *args: P.args,
    **kwargs: P.kwargs,
) -> bytes:
    colours: Any = {
        'axes.edgecolor': theme.faint,
        'axes.facecolor': theme.paper,
        'grid.color': theme.grid,
        'figure.facecolor': theme.paper,
        'savefig.facecolor': theme.paper,
    } | dict.fromkeys(
        ('axes.labelcolor', 'axes.titlecolor', 'xtick.color', 'ytick.color', 'text.color'),
        theme.ink,
    )
    with rc_context({**RC, **colours}):
        buffer = BytesIO()
        draw(theme, *args, **kwargs).savefig(
            buffer, format='png', dpi=_RESOLUTION, metadata={'Software': None}
        )
    return buffer.getvalue()
