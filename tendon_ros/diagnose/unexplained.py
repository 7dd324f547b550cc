"""How likely something of the gap has a cause that was not named, and whether to look again."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from tendon_ros.diagnose.enough import BLOCK
from tendon_ros.diagnose.evidence import ENDED
from tendon_ros.diagnose.form import form_power, own_power, own_profile
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import stays
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.signs import LEFT_NOISE
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]

#: structured power of noise that wanders: sensors of sound simulated belts left 0.12 to 0.14
WANDERS = 0.07
#: deviations of what laws may get wrong that they may be wrong by, within a time about it [s]
LAWS, NEARBY = 3.0, 0.3
#: misfit, in units of what is usual, that is as likely to have a cause as not, and how fast that
#: changes with its logarithm
EVEN, STEEP = 1.6, 2.5


def unexplained(ready: Prepared, found: Found, state: Fit) -> float:
    """
    Return the probability that something of the gap has a cause that was not named.

    What the laws of the file's own effects get wrong is no gap, and moves its numbers a little. It
    takes none to the end of its tolerance, and is nowhere far more than those effects do there:
    what does, and what is, stays unexplained.

    :param ready: the problem.
    :param found: what the search has found.
    :param state: the fit of what is believed.
    :return: 0 to 1.
    """
    problem, start = ready.problem, found.start
    by_file = own_power(problem, start)
    by_causes = form_power(problem, start, state, resting=False) - by_file
    ended = any(abs(z) >= ENDED and not t.guessed for t, z in problem.moved(state.model))
    form = by_causes if ended else by_causes + by_file
    beyond = beyond_laws_of_file(problem, start, state)
    return max(left_over(stays(ready, state).whole, form), left_over(beyond, by_causes))


def beyond_laws_of_file(problem: Problem, start: Fit, state: Fit) -> float:
    """
    Return what stays where the laws of the file's own effects could not be wrong by as much.

    :param problem: the data.
    :param start: without any cause.
    :param state: the fit of what is believed.
    :return: structured misfit, in noise power per sample.
    """
    laws = own_profile(problem, start)
    left = state.left.copy()
    for n, _, span in problem.spans():
        near = max(1, round(NEARBY / problem.rollouts.segments[n].period))
        power, by_law = (uniform_filter1d(x[span], near) for x in (left**2, laws))
        part = 1.0 - LAWS**2 * by_law / np.maximum(power, 1e-12)
        left[span] *= np.sqrt(np.maximum(part, 0.0))
    return problem.structured(left)


def left_over(left: float, form: float) -> float:
    """
    Return the probability that something of the gap has a cause that was not named.

    :param left: structured misfit that stays, in noise power per sample.
    :param form: what the laws of the causes may leave although they are right.
    :return: 0 to 1.
    """
    ratio = max(left, 1e-9) / (WANDERS + form)
    return 1.0 / (1.0 + math.exp(-STEEP * math.log(ratio / EVEN)))


#: times the misfit of what was fitted that may stay in what was held out; and the part of a block
#: that has to be there for it to say anything
SURPRISE, TOLD = 4.0, 0.5


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


def stands_out_in_a_block(ready: Prepared, found: Found) -> bool:
    """
    Return whether one block that was held out leaves far more than any that was fitted.

    What laws get wrong they get wrong in blocks that were fitted as well.

    :param ready: the problem.
    :param found: what the search has found.
    :return: whether to hold out others, and to keep to them if none stands out any more.
    """
    usual = _worst(ready.problem, found.final.left)
    there = _worst(ready.held, ready.held.left(found.final.model))
    return any(power > SURPRISE * (1.0 + usual.get(name, 0.0)) for name, power in there.items())


def _worst(problem: Problem, left: FloatArray) -> dict[str, float]:
    """Return by channel the noise power of the block in which most is left."""
    block = problem.clusters(BLOCK)
    least = TOLD * BLOCK / problem.rollouts.segments[0].period
    found = {}
    for name, own in problem.channels().items():
        count = np.bincount(block[own])
        power = np.bincount(block[own], weights=left[own] ** 2)
        whole = count >= least
        found[name] = float(np.max(power[whole] / count[whole], initial=0.0))
    return found
