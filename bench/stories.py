"""
Diagnose the paper's story on several rigs and with other noise: ``python -m bench.stories``.

One story says little of how sure its answer is: rigs whose numbers are off otherwise, and sensors
with other noise, tell whether chance decides between causes. Prints a line a story.
"""

from __future__ import annotations

import argparse
import os
import time

from tendon_ros.diagnose.result import Cause
from tendon_ros.diagnose.session import diagnose
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.paper.withheld_rig import PLANS, recorded, STAND, WITHHELD, withheld_rig

#: the rig and the noise of the demonstration first
STORIES = ('1:0', '1:10', '2:0', '3:0', '4:0', '5:0')
TRUE = {(effect, place): values for effect, place, values in WITHHELD}


def row(rig: int, noise: int, jobs: int) -> str:
    """
    Record and diagnose one story.

    :param rig: seed of the percent by which the numbers of the file are off.
    :param noise: what is added to the seeds of the sensors' noise.
    :param jobs: threads.
    :return: a line of the table, Markdown.
    """
    stand = load_instrument(STAND)
    real = withheld_rig(stand, rig)
    runs = [recorded(real, plan, noise + seed) for seed, plan in enumerate(PLANS)]
    began = time.monotonic()
    said = diagnose(runs, stand, jobs=jobs, plan=False).diagnosis
    spent = time.monotonic() - began
    right = [c for c in said.causes if (c.effect, c.place) in TRUE]
    wrong = [f'{c.effect}@{c.place} {c.probability:.2f}' for c in said.causes if c not in right]
    cells = (
        f'{rig}:{noise}',
        f'{len(right)} of {len(TRUE)}',
        f'{min((c.probability for c in right), default=0.0):.2f}',
        f'{max(map(_off, right), default=0.0):.0f} %',
        '; '.join(wrong) or '-',
        f'{said.verdict} ({said.unexplained.probability:.2f})',
        f'{spent:.0f}',
    )
    return '| ' + ' | '.join(cells) + ' |'


def _off(cause: Cause) -> float:
    """Return by how many percent the first parameter of a cause is off."""
    name, truth = next(iter(TRUE[cause.effect, cause.place].items()))
    return 100.0 * abs(cause.parameters[name].value / truth - 1.0)


def main() -> None:
    """Diagnose and print."""
    parser = argparse.ArgumentParser(prog='python -m bench.stories', description=__doc__)
    parser.add_argument('story', nargs='*', default=STORIES, help='RIG:NOISE, two seeds')
    parser.add_argument('--jobs', type=int, default=os.cpu_count() or 1, help='threads')
    given = parser.parse_args()
    try:
        stories = [(int(rig), int(noise)) for rig, noise in (s.split(':') for s in given.story)]
    except ValueError:
        parser.error('a story is two whole numbers, such as 1:0')
    print('| story | named | least sure | farthest off | named, not true | verdict (a rest) | s |')
    print('| --- | --- | --- | --- | --- | --- | --- |')
    for rig, noise in stories:
        print(row(rig, noise, given.jobs), flush=True)


if __name__ == '__main__':
    main()
