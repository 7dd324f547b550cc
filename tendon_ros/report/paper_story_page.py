"""The page of the paper's story: what was withheld, what was found, the force step by step."""

from __future__ import annotations

from matplotlib.figure import Figure

from tendon_ros import __version__
from tendon_ros.model.paper.force_profile import RESTS
from tendon_ros.report.diagnosis_words import effect_words, inside, joined, percent
from tendon_ros.report.page import html, Page, Picture, Prose, Section, Table
from tendon_ros.report.paper_story import AGREES, finding_rows, rung_rows, Story
from tendon_ros.report.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    panels,
    picture,
    PURPLE,
    RED,
    SKY,
)

_RUNGS = (ORANGE, SKY, PURPLE, RED, GREEN, BLUE)


@picture
def story_figure(story: Story) -> Figure:
    """
    Draw the load cell and the rungs of the ladder, and what each leaves.

    :param story: of a diagnosis.
    :return: the figure.
    """
    figure, (force, left) = panels(2.6, 2.4, share_x=True)
    force.plot(story.time, story.measured, color=INK, linewidth=1.2, label='load cell')
    for rung, colour in zip(story.rungs, _RUNGS, strict=False):
        force.plot(story.time, rung.force, color=colour, linewidth=1.4, label=rung.label)
        left.plot(story.time, story.measured - rung.force, color=colour, linewidth=1.2)
    for axes in (force, left):
        axes.margins(x=0)
        axes.axvline(AGREES, color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)))
    force.set_title('Operating force; dashed: 5 s')
    force.set_ylabel('force [N]')
    left.set_title('Load cell minus model')
    left.set_ylabel('[N]')
    left.set_xlabel('time [s]')
    figure.legend(
        *force.get_legend_handles_labels(),
        loc='outside lower left',
        frameon=False,
        fontsize=9.5,
        handlelength=1.2,
    )
    return figure


def story_page(story: Story) -> str:
    """
    Return the page.

    :param story: of a diagnosis.
    :return: the HTML of a self-contained file.
    """
    header = ('joined', *RESTS, 'RMSE until 5 s', 'RMSE after 5 s')
    page = Page(
        "The paper's story, by machine",
        (
            summary(story),
            'The recordings are simulated. The rig that made them has the withheld effects; the '
            'diagnosis was given three bags and the instrument file of the stand, which knows '
            'nothing of them.',
        ),
        (
            Section(
                'What the authors found by hand, and what the diagnosis says',
                (Table(('the paper', 'withheld', 'the diagnosis'), finding_rows(story)),),
            ),
            Section(
                'The force, step by step',
                (
                    Prose(
                        "The paper's experiment in closed loop, with what the diagnosis found "
                        "joined in the paper's order. Forces at rest and RMSE in N."
                    ),
                    Picture(story_figure(story), 'Force over the profile, step by step'),
                    Table(header, rung_rows(story)),
                ),
            ),
            Section(
                'Where the evidence is',
                (
                    Prose(
                        'report.html beside this page is the diagnosis itself; withheld.yaml is '
                        'the rig as it was, which nobody read before.'
                    ),
                ),
            ),
        ),
        f'Made by tendon demo, tendon_ros {__version__}.',
    )
    return html(page)


def summary(story: Story) -> str:
    """
    Return the story in two sentences.

    :param story: of a diagnosis.
    :return: how many withheld effects were named, what else was, and what it does to the force.
    """
    named = sum(f.exactly for f in story.findings)
    same = sum(f.cause is not None for f in story.findings) - named
    text = f'{named} of {len(story.findings)} withheld effects are named'
    if same:
        text += f', {same} more said to look the same as one that is'
    if story.wrong:
        wrong = [
            f'{inside(effect_words(c.effect, c.place))} ({percent(c.probability)})'
            for c in story.wrong
        ]
        text += f'; wrongly named: {joined(wrong)}'
    else:
        text += '; nothing is named that is not true'
    first, last = story.rungs[0], story.rungs[-1]
    return (
        f"{text}. The force of the paper's experiment was off by {first.until:.2f} N until 5 s "
        f'and {first.after:.2f} N after, and is off by {last.until:.2f} N and {last.after:.2f} N '
        'with what was found.'
    )
