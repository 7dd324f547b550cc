"""The paper's figures as PNG, drawn from what its experiments gave: one function a figure."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
import numpy as np

from tendon_ros.model.paper.adjusted_rig import AdjustedRig, COEFFICIENTS
from tendon_ros.model.paper.blocked_step import BlockedStep
from tendon_ros.model.paper.cable_test import CableTest, TABLE_END, WORKING_END
from tendon_ros.model.paper.equation_six import EquationSix
from tendon_ros.model.paper.force_profile import ForceProfile, rest_forces, RESTS
from tendon_ros.model.paper.free_step import FreeStep
from tendon_ros.model.paper.rig import degrees
from tendon_ros.model.rows import Rows
from tendon_ros.report.style import (
    BLUE,
    FAINT,
    INK,
    label_ends,
    level,
    panels,
    picture,
    PULLEYS,
    PURPLE,
    RED,
)

_TIME = 'time (s)'


@picture
def cable_test_figure(test: CableTest) -> Figure:
    """Fig. 7: one cable, and a loop of two preloaded ones."""
    figure, (one, loop) = panels(2.9, 2.9)
    one.plot(1e3 * test.elongation, test.tension, color=BLUE)
    one.plot(1e3 * test.preload, test.pretension, 'o', color=RED)
    one.annotate(
        f'preload {test.pretension:g} N',
        (1e3 * test.preload, test.pretension),
        xytext=(-2, 8),
        textcoords='offset points',
        ha='center',
        fontsize=10,
    )
    level(one, TABLE_END, '20 kgf: end of the table', at=0.62, below=True)
    level(one, WORKING_END, '15 kgf: working range', at=0.62, below=True)
    one.set(title='One cable', xlabel='elongation (mm)', ylabel='tension (N)', xlim=(0, None))
    one.set_ylim(0, 1.08 * TABLE_END)
    loop.plot(1e3 * test.loop_elongation, test.loop_force, color=BLUE)
    sides = (('1.83 N', (-2, 8), 'center'), ('18 N', (-8, 3), 'right'), ('50 N', (-8, 3), 'right'))
    for (x, y), (text, offset, side) in zip(test.stated, sides, strict=True):
        loop.plot(1e3 * x, y, 'o', color=RED)
        loop.annotate(
            text,
            (1e3 * x, y),
            xytext=offset,
            textcoords='offset points',
            ha=side,
            fontsize=10,
        )
    loop.axvline(1e3 * test.preload, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)))
    loop.annotate(
        'one cable slack',
        (1e3 * test.preload, 0.02),
        xycoords=('data', 'axes fraction'),
        xytext=(5, 2),
        textcoords='offset points',
        fontsize=9.5,
        color='#5a616b',
    )
    loop.set(
        title='A loop of two, and forces at the tip',
        xlabel='elongation of the loop (mm)',
        ylabel='net force (N)',
    )
    loop.set(xlim=(0, None), ylim=(0, None))
    return figure


@picture
def free_step_figure(result: FreeStep) -> Figure:
    """Fig. 10: what moves after a step, with the file's damping and with less."""
    figure, (file, less) = panels(3.2, 3.2)
    shown = 1.5
    _angles(file, result.rows, 'ML123', shown)
    file.set(title='B = 0.9 N m s/rad, sampled controllers', ylabel='angle (°)')
    _angles(less, result.swinging, 'M123', shown)
    less.set(title='B = 0.9 N mm s/°, ideal motors', ylabel='angle (°)', xlabel=_TIME)
    return figure


@picture
def blocked_step_figure(result: BlockedStep) -> Figure:
    """Fig. 11: angles and tip force after a step against a stop."""
    figure, (angle, force) = panels(3.2, 2.4, share_x=True)
    _angles(angle, result.rows, 'ML123', 1.5)
    angle.set(title='Angles', ylabel='angle (°)')
    force.plot(result.rows.time, result.rows.contact_force[:, 0], color=INK)
    force.set(title='Force at the tip', ylabel='force (N)', xlabel=_TIME, ylim=(0, None))
    level(force, 1.83, 'paper: 1.83 N', below=True)
    return figure


@picture
def trajectory_figure(result: ForceProfile) -> Figure:
    """Fig. 12: where M is told to be."""
    figure, (angle,) = panels(2.4)
    path = result.trajectory
    angle.plot(path.time, np.rad2deg(path.position['M']), color=BLUE)
    for (start, end), text in zip(RESTS.values(), ('5°', '7°', '5°', '4°'), strict=True):
        middle = 0.5 * (start + end)
        angle.annotate(
            text,
            (middle, float(np.rad2deg(path.at(middle)[0]))),
            xytext=(0, 4),
            textcoords='offset points',
            ha='center',
        )
    angle.set(xlabel=_TIME, ylabel='set-point of M (°)', xlim=(0, path.duration), ylim=(0, 8))
    return figure


@picture
def force_profile_figure(result: ForceProfile) -> Figure:
    """Fig. 13: the force over the profile, and both arrivals at 5 degrees on top of each other."""
    figure, (whole, arrivals) = panels(2.9, 2.9)
    rows, ideal = result.rows, result.ideal
    whole.plot(rows.time, rows.contact_force[:, 0], color=BLUE)
    for (name, found), part in zip(rest_forces(rows).items(), RESTS.values(), strict=True):
        over = (0, 5) if name != 'second 5 deg' else (8, 5)
        whole.annotate(
            f'{found:.1f} N',
            (0.5 * sum(part), found),
            xytext=over,
            textcoords='offset points',
            ha='center',
        )
    whole.set(title='Force at the tip', xlabel=_TIME, ylabel='force (N)', xlim=(0, 18))
    whole.set_ylim(0, 58)
    kinds = ((rows, 'solid', 'controllers'), (ideal, 'dashed', 'ideal motors'))
    for some, dashes, kind in kinds:
        for arrival, colour, which in ((2.0, BLUE, 'first'), (10.0, RED, 'second')):
            near = (some.time >= arrival - 0.1) & (some.time <= arrival + 1.2)
            arrivals.plot(
                some.time[near] - arrival,
                some.contact_force[near, 0],
                color=colour,
                linestyle=dashes,
                label=f'{which}, {kind}',
            )
    arrivals.legend(loc='upper right', fontsize=9.5, frameon=False)
    arrivals.set(title='Arriving at 5°: the first and the second time', ylabel='force (N)')
    arrivals.set(xlabel='time after the set-point is there (s)', xlim=(-0.1, 1.2), ylim=(13, 25))
    return figure


@picture
def adjusted_rig_figure(result: AdjustedRig) -> Figure:
    """Fig. 15: force and link angle with even cables, with L3 looser, and with friction."""
    figure, (force, link) = panels(3.3, 2.8, share_x=True)
    runs = (
        (result.even, FAINT, 'as in Fig. 13'),
        (result.looser, BLUE, 'L3 10 % looser'),
        (result.rubbing, RED, 'L3 looser, friction on 3'),
    )
    for rows, colour, text in runs:
        force.plot(rows.time, rows.contact_force[:, 0], color=colour, label=text)
        link.plot(rows.time, degrees(rows, '3'), color=colour)
    force.axvline(5.0, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)))
    force.annotate(
        'until 5 s\nas on the rig',
        (5.0, 1.0),
        xycoords=('data', 'axes fraction'),
        xytext=(-4, -2),
        textcoords='offset points',
        ha='right',
        va='top',
        fontsize=9.5,
        color='#5a616b',
    )
    force.legend(loc='upper right', fontsize=9.5, frameon=False)
    force.set(title='Force at the tip', ylabel='force (N)', ylim=(0, 62))
    link.set(
        title='Link (pulley 3)', ylabel='angle (°)', xlabel=_TIME, xlim=(0, 18), ylim=(0, 2.8)
    )
    return figure


@picture
def friction_survey_figure(result: AdjustedRig) -> Figure:
    """Fig. 15, on from there: friction on each joint and the force on the return to 5 degrees."""
    figure, (change,) = panels(3.2)
    colours = {'1': PULLEYS['1'], '2': PULLEYS['2'], '3': PULLEYS['3'], '1, 2, 3': PURPLE}
    for place, values in result.survey.items():
        change.plot(COEFFICIENTS, values, 'o-', color=colours[place], clip_on=False)
    change.axhline(0.0, color=INK, linewidth=1.0)
    change.set(xlabel='friction coefficient', ylabel='second − first force at 5° (N)')
    change.set_xlim(0, COEFFICIENTS[-1])
    label_ends(
        change,
        [(values[-1], f'on {place}', colours[place]) for place, values in result.survey.items()],
    )
    return figure


@picture
def equation_six_figure(result: EquationSix) -> Figure:
    """Equation (6): stability, link and force, printed against consistent."""
    figure, (growth, link, force) = panels(2.7, 2.3, 2.3)
    forms = ((result.consistent, BLUE, 'consistent'), (result.printed, RED, 'printed'))
    for form, colour, _ in forms:
        growth.semilogx(result.damping, form.growth, color=colour)
        link.plot(form.blocked.time, degrees(form.blocked, '3'), color=colour)
        force.plot(form.blocked.time, form.blocked.contact_force[:, 0], color=colour)
    growth.set_yscale('symlog', linthresh=1e-3, linscale=0.6)
    growth.set(ylim=(-10, 0.03), xlim=(result.damping[0], result.damping[-1]))
    growth.yaxis.set_major_locator(FixedLocator([-10, -1, -0.1, -0.01, 0, 0.01]))
    growth.yaxis.set_major_formatter(
        FuncFormatter(lambda value, _: f'{value:g}'.replace('-', '−'))
    )
    growth.yaxis.set_minor_locator(NullLocator())
    growth.axhspan(0, 0.03, color=RED, alpha=0.12, linewidth=0)
    growth.annotate(
        f'grows by itself\nup to B = {result.bound:.3f}',
        (0.98, 0.96),
        xycoords='axes fraction',
        ha='right',
        va='top',
        fontsize=9.5,
    )
    growth.set(title='Motors held, tip free', xlabel='damping B (N m s/rad)')
    growth.set_ylabel('growth (1/s)')
    link.set(title='1° on M, tip blocked: link', ylabel='angle (°)', xlabel=_TIME)
    force.set(title='1° on M, tip blocked: force', ylabel='force (N)', xlabel=_TIME)
    for axes in (link, force):
        axes.set_xlim(0, result.consistent.blocked.time[-1])
    force.set_ylim(0, None)
    label_ends(growth, [(form.growth[-1], text, colour) for form, colour, text in forms])
    label_ends(link, [(f.link, _signed(f'{f.link:.2f}°'), c) for f, c, _ in forms])
    label_ends(force, [(f.force, f'{f.force:.2f} N', c) for f, c, _ in forms])
    return figure


def _signed(number: str) -> str:
    """Return a number with a minus as long as a plus."""
    return number.replace('-', '−')


def _angles(axes: Axes, rows: Rows, names: Sequence[str], until: float) -> None:
    shown = rows.time <= until
    ends = []
    for name in names:
        angle = degrees(rows, name)[shown]
        axes.plot(rows.time[shown], angle, color=PULLEYS[name])
        ends.append((float(angle[-1]), name, PULLEYS[name]))
    axes.set_xlim(0, until)
    label_ends(axes, ends)
