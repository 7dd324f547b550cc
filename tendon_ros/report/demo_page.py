"""The page of ``tendon demo``: the rig live, and a real tool."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tendon_ros import __version__
from tendon_ros.base.recording import Recording
from tendon_ros.estimate.score import Score
from tendon_ros.report.estimate_figures import estimate_figure, scores_figure
from tendon_ros.report.page import html, Page, Picture, Prose, Section, Table, write


@dataclass(frozen=True)
class LiveRig:
    """
    The live run: its recording with the live estimates, and how they compare.

    ``offline_difference`` [N]: largest difference between live and offline estimates; ``shared``:
    stamps that both have.
    """

    recording: Recording
    score: Score
    offline_difference: float
    shared: int
    measured: int


@dataclass(frozen=True)
class RealTool:
    """Estimates on a real tool: a score for each run, and one run to look at."""

    scores: Mapping[str, Score]
    shown: Recording
    ratio: float

    @property
    def overall(self) -> float:
        """RMSE over all runs, each sample counted once [N m]."""
        squares = sum(s.samples * s.rmse**2 for s in self.scores.values())
        return float(np.sqrt(squares / sum(s.samples for s in self.scores.values())))


def write_demo_page(path: Path, rig: LiveRig, tool: RealTool | None) -> None:
    """
    Write the page, and the picture of the live estimate as ``force.png`` beside it.

    :param path: the HTML file.
    :param rig: the live run.
    :param tool: the real tool, where a recording was given.
    """
    picture = estimate_figure(rig.recording)
    write(path.with_name('force.png'), picture)
    sections = [_rig(rig, picture)]
    if tool is not None:
        sections.append(_tool(tool))
    page = Page(
        'tendon_ros: the demonstration',
        (
            'The rig of the paper as live ROS 2 processes, recorded and analysed'
            + (', and the same estimate on a real da Vinci grasper.' if tool else '.'),
            "The paper's own figures stand in paper/index.html beside this page.",
        ),
        tuple(sections),
        f'Made by tendon demo, tendon_ros {__version__}.',
    )
    write(path, html(page))


def _rig(rig: LiveRig, picture: bytes) -> Section:
    score = rig.score
    rows = (
        ('force RMSE', f'{score.rmse:.3f} N of {score.span:.1f} N'),
        ('bias', f'{score.bias:+.3f} N'),
        ('within two stated standard deviations', f'{score.coverage:.1%} of {score.samples}'),
        ('measurements that got an estimate', f'{rig.shared} of {rig.measured}'),
        ('live against offline, largest difference', f'{rig.offline_difference:.2g} N'),
    )
    return Section(
        'The rig, live (simulated)',
        (
            Prose(
                'Simulator, trajectory, estimator and recorder ran as four processes that spoke '
                'over DDS. Motor M went through 0, 5, 7, 5 and 4 degrees with the tip against the '
                'load cell. The estimator saw the motors alone: their encoders and torques.'
            ),
            Picture(
                picture,
                'Estimated force over the load cell, the error, and the angles of inner pulleys',
                'The estimates are those that the live node published.',
            ),
            Table(('what', 'found'), rows),
        ),
    )


def _tool(tool: RealTool) -> Section:
    rmse = {name: 1e3 * s.rmse for name, s in tool.scores.items()}
    worst = max(rmse, key=lambda name: rmse[name])
    best = min(rmse, key=lambda name: rmse[name])
    return Section(
        'A real da Vinci grasper',
        (
            Prose(
                f'{len(rmse)} recorded runs. The jaw torque is estimated from spindle torque and '
                'spindle angle with the frictionless elastic model. Over all runs it is wrong by '
                f'{1e3 * tool.overall:.1f} mN m RMSE at the jaw, '
                f'{1e3 * tool.ratio * tool.overall:.1f} mN m in terms of spindle torque: bad, '
                'because nothing in this model rubs. That gap is what a diagnosis has to explain.'
            ),
            Picture(
                scores_figure(
                    rmse, 'mN m', ('Error of the jaw torque, run by run', 'run (speed, load)')
                ),
                'A bar a run; the error grows with the load',
                f'Best: run {best}, {rmse[best]:.1f} mN m. Worst: run {worst}, '
                f'{rmse[worst]:.1f} mN m. Runs XY: speed X, load Y.',
            ),
            Picture(
                estimate_figure(tool.shown),
                'Estimated and measured jaw torque of one run',
                f'Run {tool.shown.name}. The estimate swings with the friction of spindle and '
                'cable, which the jaw never feels. Its stated uncertainty covers sensors alone.',
            ),
            Prose(
                "Data: J. J. O'Neill, T. K. Stephens, T. M. Kowalewski, IEEE RA-L 3(4), 2018; "
                'MRDLab/mis-tool-characterization, Open Database License 1.0.'
            ),
        ),
    )
