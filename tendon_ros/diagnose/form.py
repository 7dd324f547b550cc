"""
The form of laws: no effect of the catalogue is quite what a machine does.

What the right cause may leave, when two explanations are equal, and when a fit has bent one effect
into another, all follow from how far laws may be from machines.
"""

from __future__ import annotations

from collections.abc import Mapping

from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import BRISTLE
from tendon_ros.identify.fit import Fit, Problem

#: misfit beyond the best, in noise power per sample, within which two explanations are equal;
#: and the same as a part of the structure that the best leaves
TIE, TIE_FORM = 0.015, 0.3
#: and the most that the form of their laws excuses: creep may leave much, and yet be no friction
TIE_LAW = 0.06
#: form of dry friction on a driven pulley, whose motion is known to a count: it turns within less
COUNTED = 0.22
#: part of a recording from which on what lasts is no event
LASTS = 0.3


def form_power(problem: Problem, start: Fit, state: Fit) -> float:
    """
    Return what the laws of the causes may leave although they are the right ones.

    :param problem: the data.
    :param start: without any cause.
    :param state: with them.
    :return: in noise power per sample.
    """
    if not state.model.causes:
        return 0.0
    driven = {f'pulley_{name}' for name in problem.rollouts.instrument.driven}
    forms = [
        COUNTED if find(c.effect).hook == 'budget' and c.place in driven else find(c.effect).form
        for c in state.model.causes
    ]
    explained = max(0.0, start.cost - state.cost) / len(state.left)
    return max(forms) ** 2 * explained


def tie(problem: Problem, start: Fit, final: Fit) -> float:
    """
    Return the misfit beyond the best within which two explanations are equal.

    :param problem: the data.
    :param start: without any cause.
    :param final: the best.
    :return: in noise power per sample.
    """
    explained = max(0.0, start.cost - final.cost) / len(final.left)
    form = min(form_power(problem, start, final), TIE_LAW**2 * explained)
    return TIE + form + TIE_FORM * problem.structured(final.left)


def degenerate(candidate: Candidate, values: Mapping[str, float], longest: float) -> bool:
    """
    Return whether a fit has bent an effect into another that has a name of its own.

    :param candidate: the effect.
    :param values: of its parameters.
    :param longest: duration of the longest recording [s].
    :return: whether: an event that always lasts, a ripple without a period, bristles as short as
        those of any dry friction.
    """
    for p in candidate.parameters:
        if p.search == 'duration' and values[p.name] > LASTS * longest:
            return True
        if p.search == 'cycles' and values[p.name] < 1.0:
            return True
        if p.search == 'shape' and values[p.name] < BRISTLE.high:
            return True
    return False
