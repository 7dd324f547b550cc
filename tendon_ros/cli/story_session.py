"""The paper's story from recordings to report: made, diagnosed by ``tendon diagnose``, told."""

from __future__ import annotations

import argparse
from pathlib import Path


def tell(folder: Path) -> Path:
    """
    Record the withheld rig into bags, diagnose them, and compare with what was withheld.

    :param folder: for bags, report and story; an earlier story in it is replaced.
    :return: the page of the story.
    """
    from tendon_ros.bags.reader import read_recording
    from tendon_ros.bags.writer import write_recording
    from tendon_ros.cli import verb_diagnose
    from tendon_ros.cli.progress import shown
    from tendon_ros.diagnose.result import Diagnosis
    from tendon_ros.model.instrument_file import load_instrument, save_instrument
    from tendon_ros.model.paper.withheld_rig import PLANS, recorded, STAND, withheld_rig
    from tendon_ros.report.page import write
    from tendon_ros.report.paper_story import paper_story, told
    from tendon_ros.report.paper_story_page import story_figure, story_page, summary

    stand = load_instrument(STAND)
    rig = withheld_rig(stand)
    bags = []
    for seed, plan in enumerate(PLANS):
        with shown(f'recording {plan.name}') as progress:
            run = recorded(rig, plan, seed, progress)
            bags.append(write_recording(run, folder / plan.name, overwrite=True))
    # by the command's own parser: whatever options it has, this is what a user would get
    parser = argparse.ArgumentParser()
    verb_diagnose.add_arguments(parser)
    words = [*map(str, bags), '--instrument', STAND, '--out', str(folder)]
    verb_diagnose.run(parser.parse_args(words))
    # from here on the answer is known; what was withheld may be looked at
    save_instrument(rig, folder / 'withheld.yaml')
    diagnosis = Diagnosis.model_validate_json((folder / 'diagnosis.json').read_text())
    found = load_instrument(folder / 'instrument.yaml')
    story = paper_story(stand, found, diagnosis, read_recording(bags[0]))
    write(folder / 'force.png', story_figure(story))
    page = folder / 'story.html'
    write(page, story_page(story))
    print(told(story))
    print(summary(story))
    return page
