"""How likely something of the gap has a cause that was not named, and whether to look again."""

from __future__ import annotations

import math

from tendon_ros.diagnose.evidence import ENDED
from tendon_ros.diagnose.form import form_power, own_power
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.judge import stays
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.signs import LEFT_NOISE
from tendon_ros.identify.fit import Fit

#: structured power of noise that wanders: sensors of sound simulated belts left 0.12 to 0.14
WANDERS = 0.07
#: misfit, in units of what is usual, that is as likely to have a cause as not, and how fast that
#: changes with its logarithm
EVEN, STEEP = 1.6, 2.5


def unexplained(ready: Prepared, found: Found, state: Fit) -> float:
    """
    Return the probability that something of the gap has a cause that was not named.

    What the laws of the file's own effects get wrong is no gap, and moves its numbers a little. It
    takes none to the end of its tolerance: what does stays unexplained.

    :param ready: the problem.
    :param found: what the search has found.
    :param state: the fit of what is believed.
    :return: 0 to 1.
    """
    problem = ready.problem
    form = form_power(problem, found.start, state, resting=False)
    if any(abs(z) >= ENDED and not t.guessed for t, z in problem.moved(state.model)):
        form -= own_power(problem, found.start)
    return left_over(stays(ready, state).whole, form)


def left_over(left: float, form: float) -> float:
    """
    Return the probability that something of the gap has a cause that was not named.

    :param left: structured misfit that stays, in noise power per sample.
    :param form: what the laws of the causes may leave although they are right.
    :return: 0 to 1.
    """
    ratio = max(left, 1e-9) / (WANDERS + form)
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
