"""
Where guesses are likely to be where torque drives a body of which hardly anything is known.

Two motors of which the file guesses the same are alike, and wrong by the same factor. What of one
sensor alone was seen leaves them free to be as different as they like, as long as one makes up for
the other; so guesses count as wrong by as much as they differ from what one factor for all of a
kind has found, not from the file.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from tendon_ros.diagnose.asking import lost, signless
from tendon_ros.diagnose.everywhere import everywhere
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.steps import Report
from tendon_ros.identify.afar import kinds_of, swings
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.tied import tied


def leaning(
    ready: Prepared, candidates: Sequence[Candidate], report: Report = lambda _what, _done: None
) -> Prepared:
    """
    Return a problem whose guesses lean towards one factor for all of a kind.

    :param ready: the problem.
    :param candidates: all that may be named: all that usually rubs is there, and a sensor that may
        have lost its sign may have.
    :param report: called with what is being done and the part that is done.
    :return: the same where motion drives the model, or nothing is guessed.
    """
    problem = ready.problem
    if not (swings(problem) and kinds_of(problem)):
        return ready
    report('looking over what is guessed', 0.0)
    known = [problem.empty, *(lost(problem.empty, c) for c in signless(problem, candidates))]
    begun = [m for model in known for m in tied(problem, partial(everywhere, candidates, model))]
    best = min(begun, key=problem.cost, default=None)
    return ready if best is None else ready.leaning(best.moved.tolist())
