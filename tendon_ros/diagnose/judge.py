"""
From fits to probabilities: how far to believe what was found.

A likelihood that took thousands of correlated samples for independent would be certain of
anything. What speaks for a cause is measured instead by numbers that do not grow with the length
of a recording, and calibrated on the development seeds of the blind benchmark by logistic
regression (``python -m bench.calibrate``).
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.bodies import turned
from tendon_ros.diagnose.form import form_parts, form_power, own_power, tie
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.intervals import CLUSTER
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.worth import gains, TAKES_EVENT, TIMES_EVENT
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Signs:
    """
    What speaks for a cause, all in noise power per sample.

    ``worth``: by how much the misfit grows when it alone is left out; ``in_one``: the same in the
    channel where it shows most; ``left``: structured misfit that stays; ``explained``: what all
    causes explain; ``form``: what their laws may leave of that; ``beside``: the same of the others
    at its place. ``event``: it happened once.
    """

    worth: float
    in_one: float
    left: float
    explained: float
    form: float
    event: bool = False
    beside: float = 0.0

    @property
    def most(self) -> float:
        """What it is worth, over all samples or in the channel where it shows."""
        return max(self.worth, self.in_one / 4.0, 1e-6)

    @property
    def features(self) -> FloatArray:
        """Inputs of the logistic regression."""
        left = self.left / (LEFT_NOISE + self.form)
        worth = self.most / (LEFT_NOISE + self.left)
        return np.array(
            [
                1.0,
                math.log10(min(max(left, LITTLE), MUCH)),
                math.log10(min(max(worth, LEAST_WORTH), MOST_WORTH)),
                float(self.event),
            ]
        )


#: misfit in units of what is usual below and beyond which it says nothing more
LITTLE, MUCH = 0.3, 30.0
#: times what stays that a cause is worth below and beyond which it says nothing more
LEAST_WORTH, MOST_WORTH = 0.1, 100.0
#: structured power that recordings without any effect may leave
LEFT_NOISE = 0.05
#: weights of the features, from 178 causes of 99 cases that are used up for anything else, by 1.44
#: and less 0.62: what 246 probabilities of 145 later ones, used up by now, fell short of
WEIGHTS = np.array([-0.92, -2.45, 2.13, -2.13])


def probability(signs: Signs) -> float:
    """
    Return the probability that a cause is true, or one that it cannot be told from.

    :param signs: what speaks for it.
    :return: 0 to 1.
    """
    return 1.0 / (1.0 + math.exp(-float(np.clip(WEIGHTS @ signs.features, -30.0, 30.0))))


#: part of what laws may leave by which two places of a strong effect may differ by chance
LAW = 0.02


def equals(problem: Problem, found: Found, k: int) -> list[Rival]:
    """
    Return the rivals that these data cannot tell from a cause.

    A rival whose parameters make it the cause by another name was left out before.

    :param problem: the fitted bins.
    :param found: what the search has found.
    :param k: which cause.
    :return: those whose misfit is as good.
    """
    final = found.final
    samples = len(final.left)
    allowed = tie(problem, final) + LAW * form_power(problem, found.start, final)
    return [r for r in found.rivals[k] if (r.fit.cost - final.cost) / samples <= allowed]


def signs_beside(problem: Problem, found: Found, without: Fit, left: float | None = None) -> Signs:
    """
    Return what speaks for what a fit does without.

    :param problem: the fitted bins.
    :param found: what the search has found.
    :param without: the fit without one cause, or without several that make up for one another.
    :param left: structured misfit of all that may be believed; of the last state where None.
    :return: the signs.
    """
    final = found.final
    samples = len(final.left)
    left = problem.structured(final.left) if left is None else left
    worth, in_one = gains(problem, without, final)
    explained = (found.start.cost - final.cost) / samples
    parts = form_parts(problem, found.start, final)
    wrong = [float(np.mean(part)) for part in parts]
    form = own_power(problem, found.start) + sum(wrong)
    causes = final.model.causes
    gone = set(causes) - set(without.model.causes)
    event = any(cause.instants for cause in gone)
    # a motor and the pulley that it turns are one place
    body = turned(problem.rollouts.instrument)
    places = {body.get(cause.place, cause.place) for cause in gone}
    kept = [
        power
        for cause, power in zip(causes, wrong, strict=True)
        if cause not in gone and body.get(cause.place, cause.place) in places
    ]
    return Signs(max(worth, 1e-9), in_one, left, explained, form, event, sum(kept))


#: probability that a cause has at most which spoils what no fit saw, which others undo, or which
#: may be what laws get wrong once
IDLE = 0.3


def spoils(ready: Prepared, found: Found, without: Fit) -> bool:
    """
    Return whether what a fit does without makes worse what no fit has seen, by more than chance.

    A weak cause that is there may lose there what it gains: seconds differ by more than it does.

    :param ready: the problem.
    :param found: what the search has found.
    :param without: the fit without one cause, or without several.
    :return: whether it loses more than seconds of no meaning would on average.
    """
    gain = _foretold(ready, found, without)
    # what cannot be computed there is no help either
    return not float(gain.sum()) >= -float(np.sqrt(gain @ gain))


def _foretold(ready: Prepared, found: Found, without: Fit) -> FloatArray:
    """Return what a cause saves of squares in noise deviations that no fit saw, by the second."""
    poorer = ready.held.left(without.model)
    left = ready.held.left(found.final.model)
    return np.bincount(ready.held.clusters(CLUSTER), weights=poorer**2 - left**2)


def chance(ready: Prepared, found: Found, k: int, signs: Signs) -> float:
    """
    Return the probability that one cause is true, on all that is known.

    :param ready: the problem.
    :param found: what the search has found.
    :param k: which cause.
    :param signs: what speaks for it.
    :return: 0 to 1.
    """
    likely = probability(signs)
    # of all times, one fits what a law gets wrong; but then the law is wrong at other times, too
    alone = signs.worth > TAKES_EVENT * (signs.worth + signs.left)
    luck = signs.event and signs.most < TIMES_EVENT * signs.form and not alone
    # and what a law gets wrong may be told by something else at its place
    drowned = signs.most < signs.beside
    happened = bool(found.final.model.causes[k].instants)
    spoilt = not happened and spoils(ready, found, found.without[k])
    believed = not (spoilt or luck or drowned)
    return likely if believed else min(IDLE, likely)


#: misfit, in units of what is usual, that is as likely to have a cause as not, and how fast that
#: changes with its logarithm
EVEN, STEEP = 1.6, 2.5


def left_over(left: float, form: float) -> float:
    """
    Return the probability that something of the gap has a cause that was not named.

    :param left: structured misfit that stays, in noise power per sample.
    :param form: what the laws of the causes may leave although they are right.
    :return: 0 to 1.
    """
    ratio = max(left, 1e-9) / (LEFT_NOISE + form)
    return 1.0 / (1.0 + math.exp(-STEEP * math.log(ratio / EVEN)))


#: times the misfit of what was fitted that may stay in what was held out
SURPRISE = 4.0


def surprising(ready: Prepared, found: Found) -> bool:
    """
    Return whether what was held out holds something that no fit could know of, such as a push.

    :param ready: the problem.
    :param found: what the search has found.
    :return: whether to fit the blocks that were held out, and hold out others.
    """
    left = ready.problem.structures(found.final.left)[1]
    unseen = ready.held.structures(ready.held.left(found.final.model))[1]
    form = form_power(ready.problem, found.start, found.final)
    return unseen > SURPRISE * (LEFT_NOISE + form + left)
