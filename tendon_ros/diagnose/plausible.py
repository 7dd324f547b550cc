"""
Sizes that no machine has, unless what they explain leaves no other choice.

A stop takes the torque that an inertia needs, and a motor that lags seems to turn a heavier body;
a wrong unit, though, is behind most of a gap, and an inner pulley, a small part of what its cables
move, may carry many times what its file says.
"""

from __future__ import annotations

from tendon_ros.diagnose.bent import at_bound, far_fetched, overweight
from tendon_ros.diagnose.found import Found
from tendon_ros.identify.fit import Problem

#: part of the gap that an encoder or a body explains at least which is further off than any is
MOST = 0.5
#: part of the structure without a body's inertia that stays with it at most, where it is ten times
#: what the file says: what only stands in for something else does not take all of it
CLEARED = 0.05


def is_far_off(problem: Problem, found: Found, k: int) -> bool:
    """
    Return whether a cause is further off than any is and explains less than most of the gap.

    :param problem: the data.
    :param found: what the search has found.
    :param k: which of its causes.
    :return: whether.
    """
    model = found.final.model
    if not far_fetched(model.causes[k], model.values(k)):
        return False
    without, start = (problem.structured(f.left) for f in (found.without[k], found.start))
    return without <= MOST * start


def is_at_end(problem: Problem, found: Found, k: int) -> bool:
    """
    Return whether a cause is at its bound, or an inertia of ten times the file's leaves a rest.

    :param problem: the data.
    :param found: what the search has found.
    :param k: which of its causes.
    :return: whether.
    """
    cause, values = found.final.model.causes[k], found.final.model.values(k)
    if at_bound(cause, values):
        return True
    if not overweight(cause, values):
        return False
    final, without = (problem.structured(f.left) for f in (found.final, found.without[k]))
    return values['scale'] < 1.0 or final > CLEARED * without
