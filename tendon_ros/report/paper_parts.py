"""What each of the paper's experiments has to show: its section, its figures, its statements."""

from __future__ import annotations

from dataclasses import dataclass

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.adjusted_rig import adjusted_rig, COEFFICIENT
from tendon_ros.model.paper.blocked_step import blocked_step
from tendon_ros.model.paper.cable_test import cable_test
from tendon_ros.model.paper.equation_six import equation_six, EquationSix, STIFFNESS
from tendon_ros.model.paper.force_profile import force_profile
from tendon_ros.model.paper.free_step import free_step
from tendon_ros.model.paper.statement import Statement
from tendon_ros.report import paper_figures as draw
from tendon_ros.report.page import Picture, Prose, Section, Table


@dataclass(frozen=True)
class Part:
    """One experiment's share: section, pictures by file name, statements."""

    section: Section
    pictures: dict[str, bytes]
    statements: tuple[Statement, ...] = ()


def cable_part(rig: Instrument) -> Part:
    """Fig. 7: the cable."""
    result = cable_test(rig)
    png = draw.cable_test_figure(result)
    return Part(
        Section(
            'Fig. 7: the cable',
            (
                Prose(
                    'The paper prints no table of its tension test. The curve here is identified '
                    'from its three forces at the blocked tip (dots), each cable preloaded to '
                    f'{result.pretension:g} N; 5 N is a choice, the paper gives no pretension.'
                ),
                Picture(
                    png,
                    'Tension of one cable rises ever more steeply to 196 N at 2.2 mm; the net '
                    'force of a loop goes through the three points of the paper.',
                ),
            ),
        ),
        {'fig07.png': png},
        result.statements,
    )


def free_part(rig: Instrument) -> Part:
    """Fig. 10: a step with the tip free."""
    result = free_step(rig)
    png = draw.free_step_figure(result)
    return Part(
        Section(
            'Fig. 10: 1° on M, tip free',
            (
                Prose(
                    'Motion travels from M over 1 to 2, and the link (3) swings out though L is '
                    'held. In the end no loop pulls and all stand where rigid cables would have '
                    'put them.'
                ),
                Picture(
                    png,
                    'Above: pulleys 1 and 2 follow M with delay, 3 swings out and returns. '
                    'Below: with less damping 2 and 3 vibrate at 3 Hz.',
                    'M overshoots because its controller does; the paper says nothing of gains.',
                ),
                Prose(
                    'The paper shows vibration at "B = 0.9", without a unit. Read as N m s/rad on '
                    'every pulley it leaves none. Read as N mm s/° (0.052 N m s/rad) link and '
                    'end-effector vibrate at 3 Hz. Forces at rest do not depend on it.'
                ),
            ),
        ),
        {'fig10.png': png},
        result.statements,
    )


def blocked_part(rig: Instrument) -> Part:
    """Fig. 11: a step against a stop."""
    result = blocked_step(rig)
    png = draw.blocked_step_figure(result)
    return Part(
        Section(
            'Fig. 11: 6° on M, tip blocked at 5°',
            (
                Prose(
                    'The degree that is left over stretches three equal loops in series, a third '
                    'each. The reaction turns the link and pushes motor L off its place until its '
                    'controller has it back. With the sampled controllers of the file.'
                ),
                Picture(
                    png,
                    'Pulley 2 stops at 5 degrees; the force jumps to 3 N and settles at 1.83 N '
                    'within half a second.',
                ),
            ),
        ),
        {'fig11.png': png},
        result.statements,
    )


def profile_part(rig: Instrument) -> Part:
    """Figs. 12 and 13: the operating force over the profile."""
    result = force_profile(rig)
    path, force = draw.trajectory_figure(result), draw.force_profile_figure(result)
    return Part(
        Section(
            'Figs. 12 and 13: the operating force',
            (
                Prose(
                    'The angles are the paper\'s; the times are such that "until 5 s" falls on '
                    'the beginning of the second rise.'
                ),
                Picture(path, 'Set-point of M: 0, 5, 7, 5 and 4 degrees.'),
                Picture(
                    force,
                    'Force: 18 N, 50 N, 18 N again, 11 N. The two arrivals at 5 degrees end at '
                    'the same force.',
                ),
                Prose(
                    'The paper finds less force on the return to 5° than at first. At rest this '
                    'model cannot: without friction one angle has one force, whatever the '
                    'controllers do. Their lag even does the opposite on the way. Only a first '
                    'peak that shoots over, as with ideal motors round sharp corners, is above '
                    'what the return reaches (by 0.2 N). Friction on the link does it at rest: '
                    'see Fig. 15.'
                ),
            ),
        ),
        {'fig12.png': path, 'fig13.png': force},
        result.statements,
    )


def adjusted_part(rig: Instrument) -> Part:
    """Fig. 15: less pretension in L3, and friction."""
    result = adjusted_rig(rig)
    runs, survey = draw.adjusted_rig_figure(result), draw.friction_survey_figure(result)
    return Part(
        Section(
            'Fig. 15: L3 10 % looser, and friction',
            (
                Prose(
                    'Friction is opposite to velocity and proportional to tension, as in the '
                    f'paper, which gives no coefficient and no place. Here {COEFFICIENT:g} on '
                    'pulley 3: dry steel (0.17) on a face of 18 mm, by the radius of 30 mm.'
                ),
                Picture(
                    runs,
                    'With L3 looser the force is lower and the link turns further; with '
                    'friction the link lags behind, and the second 5 degrees have less force.',
                ),
                Prose(
                    'A looser L3 takes 6 % from the force at 7° and lets the link turn 0.08° '
                    'further. It does not turn suddenly, as it did on the rig: 10 % are too '
                    'little for that with this curve. How much they take depends on the '
                    'pretension, which the paper does not give:'
                ),
                Table(
                    ('pretension of all loops', 'less force at 7° with L3 10 % looser'),
                    tuple((f'{p:g} N', f'{100 * loss:.0f} %') for p, loss in result.loss.items()),
                ),
                Picture(
                    survey,
                    'Friction on pulley 3 lowers the force on the return, friction on 1 or 2 '
                    'raises it, in proportion to the coefficient.',
                    'Corners rounded by 0.2 s. Where it rubs decides: friction on the link holds '
                    'the force up at first and down on the return.',
                ),
            ),
        ),
        {'fig15.png': runs, 'fig15_where.png': survey},
        result.statements,
    )


def equation_part(rig: Instrument) -> Part:
    """Compare equation (6) as printed with the energy-consistent one."""
    result = equation_six()
    png = draw.equation_six_figure(result)
    return Part(
        Section(
            'Equation (6): printed against consistent',
            (
                Prose(
                    'The paper prints R₁T₁₂ on the left of equation (6); virtual work puts it on '
                    'the right. As printed the cables are no spring: the stiffness is not '
                    'symmetric. Linear loops of '
                    f'{1e-3 * STIFFNESS:g} kN/m, the stiffness that belongs to 1.83 N:'
                ),
                _forms(result),
                Picture(
                    png,
                    'The printed form grows by itself at low damping, turns the link backwards '
                    'and gives three times the force.',
                ),
            ),
        ),
        {'equation6.png': png},
    )


def _forms(result: EquationSix) -> Table:
    pair = (result.consistent, result.printed)

    def row(what: str, *texts: str) -> tuple[str, ...]:
        return (what, *(text.replace('-', '−') for text in texts))

    return Table(
        ('1° on M', 'consistent', 'printed'),
        (
            row('force at the blocked tip', *(f'{form.force:.2f} N' for form in pair)),
            row('turn of the link, tip blocked', *(f'{form.link:.2f}°' for form in pair)),
            row('asymmetry of the stiffness', *(f'{form.asymmetry:.0%}' for form in pair)),
            row('grows by itself, tip free', 'never', f'B up to {result.bound:.3f} N m s/rad'),
        ),
    )


#: in the order of the paper
PARTS = (cable_part, free_part, blocked_part, profile_part, adjusted_part, equation_part)
