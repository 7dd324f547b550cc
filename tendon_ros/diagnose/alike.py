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
from tendon_ros.effects.sensor_delay import LONGEST
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.multistart import kinds_of, swings
from tendon_ros.identify.tied import RUBS, tied

#: [s] by which a filter may make a speed late
FILTERED = (2e-3, LONGEST)
SMOOTHED = 0.5  # part of the cost without it that a filter leaves if there is one


def leaning(
    ready: Prepared, candidates: Sequence[Candidate], report: Report = lambda _what, _done: None
) -> Prepared:
    """
    Return a problem whose guesses lean towards one factor for all of a kind.

    :param ready: the problem.
    :param candidates: all that may be named: all that usually rubs is there, a sensor that may
        have lost its sign may have, and a speed may be filtered.
    :param report: called with what is being done and the part that is done.
    :return: the same where motion drives the model, or nothing is guessed.
    """
    problem = ready.problem
    if not (swings(problem) and kinds_of(problem)):
        return ready
    report('looking over what is guessed', 0.0)
    known = [problem.empty, *(lost(problem.empty, c) for c in signless(problem, candidates))]
    filters = [c for c in candidates if c.opened]
    plain: list[Model] = []
    smooth: list[Model] = []
    for model in known:
        plain += tied(problem, partial(_usual, candidates, model))
        for late in filters:
            smooth += tied(problem, partial(_filtered, candidates, model, late), (RUBS, FILTERED))
    best = min(plain, key=problem.cost, default=None)
    # one size more always leaves less, and leads all guesses elsewhere
    other = min(smooth, key=problem.cost, default=None)
    if other and (best is None or problem.cost(other) < SMOOTHED * problem.cost(best)):
        best = other
    return ready if best is None else ready.leaning(best.moved.tolist())


def _usual(candidates: Sequence[Candidate], model: Model, sizes: Sequence[float]) -> Model:
    """Return a model with a part of all that usually rubs."""
    [part] = sizes
    return everywhere(candidates, model, part)


def _filtered(
    candidates: Sequence[Candidate], model: Model, late: Candidate, sizes: Sequence[float]
) -> Model:
    """Return the same with a speed that is filtered by a time [s]."""
    part, time = sizes
    return _usual(candidates, model.joined(late, {'time': time, 'filtered': 1.0}), [part])
