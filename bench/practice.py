"""
Diagnose the ten practice cases with one fixed set of settings: ``python -m bench.practice``.

Prints a line a case: what is true, what was named, with which probability, how far the gap shrank
on data that no fit has seen, and how long it took.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
import json
import os
from pathlib import Path
import time

from tendon_ros.bags.reader import read_recording
from tendon_ros.diagnose.result import Cause, Diagnosis
from tendon_ros.diagnose.session import diagnose
from tendon_ros.model.instrument_file import load_instrument

FOLDER = Path(__file__).resolve().parents[2] / 'shared' / 'practice'
BAGS = ('contact', 'free', 'mixed')
Pair = tuple[str, str]


@dataclass(frozen=True)
class Answer:
    """What was said of a case whose truth is known."""

    case: str
    truth: tuple[Pair, ...]
    diagnosis: Diagnosis
    seconds: float

    @property
    def right(self) -> bool:
        """
        Whether every effect was named at its place, nothing else, and nothing said to be left.

        An effect counts as named where it is among what these data cannot tell from a cause.
        """
        open_ = list(self.truth)
        for cause in self.diagnosis.causes:
            hit = next((pair for pair in named(cause) if pair in open_), None)
            if hit is None:
                return False
            open_.remove(hit)
        return not open_ and self.diagnosis.verdict == ('explained' if self.truth else 'no_gap')

    @property
    def shrink(self) -> tuple[float, float, float]:
        """Return gaps before and after, in noise floors, of the channel that was worst."""
        worst = max(self.diagnosis.gap, key=lambda g: g.before / g.noise_floor)
        return worst.before / worst.noise_floor, worst.after / worst.noise_floor, worst.noise_floor


def named(cause: Cause) -> list[Pair]:
    """
    Return a cause and all that it cannot be told from.

    :param cause: of a diagnosis.
    :return: effects and places, the cause first.
    """
    return [(cause.effect, cause.place), *((c.effect, c.place) for c in cause.indistinguishable)]


def answers(folder: Path, cases: Mapping[str, object], jobs: int) -> Iterator[Answer]:
    """
    Diagnose cases one after the other.

    :param folder: with the cases' folders.
    :param cases: labels by case.
    :param jobs: threads.
    :return: the answers.
    """
    bench = load_instrument('bench_rig')
    for case, label in cases.items():
        assert isinstance(label, dict)
        recordings = [read_recording(folder / case / bag) for bag in BAGS]
        began = time.monotonic()
        diagnosis = diagnose(recordings, bench, jobs=jobs).diagnosis
        truth = tuple((e['effect'], e['place']) for e in label['effects'])
        yield Answer(case, truth, diagnosis, time.monotonic() - began)


def row(answer: Answer) -> str:
    """
    Return a line of the table.

    :param answer: to one case.
    :return: Markdown.
    """
    causes = answer.diagnosis.causes
    before, after, _ = answer.shrink
    cells = (
        answer.case,
        '; '.join(map('@'.join, answer.truth)) or '-',
        '; '.join('@'.join(named(c)[0]) + _others(c) for c in causes) or '-',
        '; '.join(f'{c.probability:.2f}' for c in causes) or '-',
        answer.diagnosis.verdict,
        f'{before:.2f} → {after:.2f}',
        f'{answer.seconds:.0f}',
        'right' if answer.right else 'WRONG',
    )
    return '| ' + ' | '.join(cells) + ' |'


def _others(cause: Cause) -> str:
    return f' (or {len(cause.indistinguishable)} more)' if cause.indistinguishable else ''


def main() -> None:
    """Diagnose and print."""
    parser = argparse.ArgumentParser(prog='python -m bench.practice', description=__doc__)
    parser.add_argument('case', nargs='*', help='such as case_03; default: all')
    parser.add_argument('--folder', type=Path, default=FOLDER, help='with the cases')
    parser.add_argument('--jobs', type=int, default=os.cpu_count() or 1, help='threads')
    given = parser.parse_args()
    file = given.folder / 'labels.json'
    if not file.exists():
        parser.error(f'{file} is not there; name the folder of the cases with --folder')
    labels = json.loads(file.read_text(encoding='utf-8'))
    unknown = sorted(set(given.case) - set(labels))
    if unknown:
        parser.error(f'no case {unknown[0]}; there are {", ".join(labels)}')
    cases = {case: labels[case] for case in (given.case or labels)}
    print('| case | truth | named | probability | verdict | worst gap, floors | s | |')
    print('| --- | --- | --- | --- | --- | --- | --- | --- |')
    right = 0
    for answer in answers(given.folder, cases, given.jobs):
        right += answer.right
        print(row(answer), flush=True)
    print(f'\n{right} of {len(cases)} right')


if __name__ == '__main__':
    main()
